#include <array>
#include <limits>
#include <string>

#include "contest.h"

// Embree has many ways to be asked for the same picture, and which is the fastest depends on the
// scene. The survey tries one answer at a time, keeps the best and goes on to the next question.

namespace nuvo::bench {
namespace {

/// A frame that takes longer is tried once only.
constexpr double kLongFrameSeconds = 0.4;
constexpr int kTries = 4;

double least_seconds(const EmbreeFrame& frame, const EmbreeMode& mode, Depth depth) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kTries; ++i) {
        best = std::min(best, timed([&] { frame.render(mode, depth); }));
        if (best > kLongFrameSeconds) break;
    }
    return best;
}

std::string mode_name(int width, bool coherent) {
    const std::string rays = std::to_string(width) + (width == 1 ? " ray" : " rays");
    return rays + (coherent ? ", coherent" : "");
}

const char* quality_name(RTCBuildQuality quality) {
    return quality == RTC_BUILD_QUALITY_LOW    ? "low"
           : quality == RTC_BUILD_QUALITY_HIGH ? "high"
                                               : "medium";
}

/// Which packets are the fastest over this scene, and their frame's seconds.
double choose_packets(const EmbreeFrame& frame, EmbreeMode& best, std::vector<SurveyRow>& rows) {
    constexpr std::array kWidths{16, 8, 4, 1};
    double least = std::numeric_limits<double>::infinity();
    EmbreeMode chosen;
    for (const int width : kWidths)
        for (const bool coherent : {true, false}) {
            if (width == 1 && coherent) continue;
            const EmbreeMode mode{width, coherent, 16, true};
            const double seconds = least_seconds(frame, mode, Depth::kPrimary);
            rows.push_back({"primary: " + mode_name(width, coherent), seconds});
            if (seconds < least) chosen = mode;
            least = std::min(least, seconds);
        }
    least = std::numeric_limits<double>::infinity();
    for (const int width : kWidths)
        for (const bool coherent : {true, false}) {
            if (width == 1 && coherent) continue;
            EmbreeMode mode = chosen;
            mode.shadow_width = width;
            mode.shadow_coherent = coherent;
            const double seconds = least_seconds(frame, mode, Depth::kWhole);
            rows.push_back({"whole frame, shadows: " + mode_name(width, coherent), seconds});
            if (seconds < least) best = mode;
            least = std::min(least, seconds);
        }
    return least;
}

}  // namespace

Survey survey_embree(const FloatScene& scene, const ContestOptions& options) {
    Survey survey;
    survey.options.isa = options.isa;
    double least = std::numeric_limits<double>::infinity();
    for (const SphereKind kind : {SphereKind::kUser, SphereKind::kPoint}) {
        if (kind == SphereKind::kPoint && scene.spheres.empty()) continue;
        EmbreeOptions tried = survey.options;
        tried.spheres = kind;
        const EmbreeScene built(scene, tried);
        survey.version = built.version();
        const EmbreeFrame frame(built, options.resolution);
        EmbreeMode mode;
        std::vector<SurveyRow> rows;
        const double seconds = choose_packets(frame, mode, rows);
        for (SurveyRow& row : rows) {
            if (kind == SphereKind::kPoint) row.what = "built-in spheres, " + row.what;
            survey.rows.push_back(row);
        }
        if (seconds < least) {
            survey.options.spheres = kind;
            survey.mode = mode;
        }
        least = std::min(least, seconds);
    }
    for (const RTCBuildQuality quality :
         {RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH}) {
        EmbreeOptions tried = survey.options;
        tried.quality = quality;
        std::optional<EmbreeScene> built;
        const double build = timed([&] { built.emplace(scene, tried); });
        const EmbreeFrame frame(*built, options.resolution);
        const std::string name = quality_name(quality);
        survey.rows.push_back({"build, quality " + name, build});
        survey.rows.push_back(
            {"whole frame, quality " + name, least_seconds(frame, survey.mode, Depth::kWhole)});
    }
    return survey;
}

}  // namespace nuvo::bench
