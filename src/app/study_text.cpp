#include <algorithm>
#include <cmath>

#include "nuvo/app/choices.h"
#include "nuvo/app/study.h"
#include "text.h"

namespace nuvo::app {
namespace {

std::string known(const std::optional<std::size_t>& n) { return n ? std::to_string(*n) : "-"; }

std::string row_text(const StudyRow& row, int name_width) {
    const image::Difference& d = row.difference;
    const std::string psnr = std::isfinite(d.psnr_db) ? format("%.2f", d.psnr_db) : "inf";
    return format("%-7s %-*s %10.6f  %10.6f .. %10.6f %10.6f %9s %7s %4d %9.5f %7s  %s\n",
                  row.what.profile.c_str(), name_width, row.what.change.c_str(), row.trace.median,
                  row.trace.low, row.trace.high, row.build_median,
                  known(row.wrong_primitives).c_str(), known(row.wrong_shadows).c_str(),
                  d.max_difference, d.rms, psnr.c_str(), row.on_frontier ? "*" : "");
}

}  // namespace

std::string study_text(const Options& options, const std::string& file,
                       const std::vector<StudyRow>& rows) {
    std::size_t width = 0;
    for (const StudyRow& row : rows) width = std::max(width, row.what.change.size());
    const int name_width = static_cast<int>(width);
    std::string text =
        format("study      %s, %d x %d, %s octree unless changed, %s\n", file.c_str(),
               options.resolution.width, options.resolution.height,
               std::string(name_of(kOctreeTypes, options.profile.type)).c_str(),
               counted(static_cast<std::size_t>(options.repetitions), "round").c_str());
    text +=
        "trace and build: processor seconds, medians, with a 95 % interval for trace; wrong: "
        "pixels "
        "with another primitive, or with other lights on the right one; max, RMS (of 255) and "
        "PSNR: "
        "against the picture of the first row; *: no row beats it in speed and RMS\n\n";
    text +=
        format("%-7s %-*s %10s  %24s %10s %9s %7s %4s %9s %7s  frontier\n", "profile", name_width,
               "change", "trace", "interval", "build", "primitive", "shadow", "max", "RMS", "PSNR");
    for (const StudyRow& row : rows) {
        std::string line = row_text(row, name_width);
        line.erase(line.find_last_not_of(" \n") + 1);
        text += line + "\n";
    }
    return text;
}

}  // namespace nuvo::app
