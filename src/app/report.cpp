#include "nuvo/app/report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nuvo/app/choices.h"
#include "text.h"

namespace nuvo::app {
namespace {

double mean(const std::vector<double>& values) {
    if (values.empty()) return 0;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::string bytes_text(std::size_t bytes) {
    constexpr double kMegabyte = 1e6;
    return format("%.1f MB", static_cast<double>(bytes) / kMegabyte);
}

std::string time_line(const char* name, const std::vector<double>& seconds) {
    std::string line = format("%-10s %.6f s", name, mean(seconds));
    if (seconds.size() > 1) {
        const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
        line += format(" (mean of %zu, %.6f to %.6f)", seconds.size(), *least, *most);
    }
    return line + "\n";
}

std::string tree_line(const Pass& pass) {
    const TreeFigures& tree = *pass.tree;
    return format("%-10s %s: depth %d, %s, %s, %s, %s\n", "octree", pass.name.c_str(), tree.depth,
                  counted(tree.voxels, "voxel").c_str(), counted(tree.nodes, "node").c_str(),
                  counted(tree.references, "reference").c_str(),
                  bytes_text(tree.memory_bytes).c_str());
}

std::string tile_lines(const Pass& pass) {
    const TileFigures& tiles = *pass.tiles;
    std::string lines = format(
        "%-10s %s: depth %d, %s with items, %s, %s, %s\n", "octree", pass.name.c_str(), tiles.depth,
        counted(tiles.voxels, "voxel").c_str(), counted(tiles.nodes, "node").c_str(),
        counted(tiles.references, "reference").c_str(), bytes_text(tiles.memory.structure).c_str());
    lines += format("%-10s %s, %s, %s of tables for camera and lights\n", "tiles",
                    counted(static_cast<std::size_t>(tiles.threads), "thread").c_str(),
                    std::string(name_of(kInstructionSets, tiles.isa)).c_str(),
                    bytes_text(tiles.memory.tables).c_str());
    if (tiles.counts)
        lines += format("%-10s %llu primary and %llu shadow rays\n", "counts",
                        static_cast<unsigned long long>(tiles.counts->primary_rays),
                        static_cast<unsigned long long>(tiles.counts->shadow_rays));
    if (tiles.stage_seconds)
        lines +=
            format("%-10s tables %.6f s, primary rays %.6f s, shadow rays %.6f s, shading %.6f s\n",
                   "stages", tiles.stage_seconds->tables, tiles.stage_seconds->primary,
                   tiles.stage_seconds->shadow, tiles.stage_seconds->shading);
    return lines;
}

/// How long a user of several threads waits.
std::string wall_line(const Pass& pass) {
    return format("%-10s build %.6f s, trace %.6f s (means)\n", "wall",
                  mean(pass.build_wall_seconds), mean(pass.trace_wall_seconds));
}

std::string counts_line(const TraceCounts& counts) {
    const double rays = std::max(1.0, static_cast<double>(counts.primary_rays));
    const auto a_ray = [rays](std::uint64_t n) { return static_cast<double>(n) / rays; };
    return format(
        "%-10s %llu primary and %llu shadow rays; %llu intersection tests (%.2f a primary ray), "
        "%llu voxel searches (%.2f)\n",
        "counts", static_cast<unsigned long long>(counts.primary_rays),
        static_cast<unsigned long long>(counts.shadow_rays),
        static_cast<unsigned long long>(counts.intersection_tests),
        a_ray(counts.intersection_tests), static_cast<unsigned long long>(counts.voxel_searches),
        a_ray(counts.voxel_searches));
}

std::string predicates_line(const PredicateCounts& predicates) {
    return format(
        "%-10s %llu tests of a primitive, %llu times tighter bounds, %llu times exact arithmetic\n",
        "predicates", static_cast<unsigned long long>(predicates.tests),
        static_cast<unsigned long long>(predicates.wider),
        static_cast<unsigned long long>(predicates.exact));
}

std::string tree_lines(const Pass& pass) {
    std::string lines =
        pass.tree ? tree_line(pass) : format("%-10s none: %s\n", "octree", pass.name.c_str());
    if (pass.counts) lines += counts_line(*pass.counts);
    if (pass.counts && pass.counts->predicates) lines += predicates_line(*pass.counts->predicates);
    return lines;
}

std::string octree_lines(const Pass& pass) {
    std::string lines;
    if (pass.tiles) {
        lines = tile_lines(pass);
        if (pass.tree)
            lines += format("%-10s the serial exact profile's, for what looks at it:\n", "walk");
    }
    if (!pass.tiles || pass.tree) lines += tree_lines(pass);
    return lines;
}

std::string file_lines(const LookFiles& files) {
    std::string lines;
    if (files.heatmap)
        lines += format("%-10s %s: %s 0 to %g, the scale to %g\n", "heat map",
                        files.heatmap->file.c_str(),
                        std::string(name_of(kHeatmaps, files.heatmap->of)).c_str(),
                        files.heatmap->largest, files.heatmap->scale_max);
    for (const std::string& plane : files.planes)
        lines += format("%-10s %s\n", "plane", plane.c_str());
    if (!files.octree.empty()) lines += format("%-10s %s\n", "voxels", files.octree.c_str());
    return lines;
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// What the user waited for, on the clock of the wall.
std::string headline(const Options& options, const Report& report) {
    double build = 0, trace = 0;
    std::size_t pictures = 0;
    for (const Pass& pass : report.passes) {
        build += sum(pass.build_wall_seconds);
        trace += sum(pass.trace_wall_seconds);
        pictures += pass.trace_wall_seconds.size();
    }
    std::string line =
        format("%-10s %.3g s: read %.3g, build %.3g, trace %.3g, write %.3g s", "waited",
               report.parse_wall_seconds + build + trace + report.write_wall_seconds,
               report.parse_wall_seconds, build, trace, report.write_wall_seconds);
    if (pictures > 1) line += format(" (%zu times built and traced)", pictures);
    const Resolution traced = options.traced_resolution();
    const double rays = report.rays ? static_cast<double>(*report.rays)
                                    : static_cast<double>(traced.width) * traced.height *
                                          static_cast<double>(pictures);
    if (trace > 0 && rays > 0)
        line += format("; %.3g million %srays a second", rays / trace / 1e6,
                       report.rays ? "" : "primary ");
    return line + "\n";
}

std::string average_line(const Pass& pass) {
    const auto repetitions =
        static_cast<double>(std::max<std::size_t>(1, pass.trace_seconds.size()));
    const ProcessTimes& all = pass.process;
    // The thesis' clock tells nothing of short times.
    constexpr double kShortSeconds = 1;
    const bool is_short = all.user_seconds < kShortSeconds;
    double seconds = is_short ? mean(pass.build_seconds) + mean(pass.trace_seconds)
                              : all.user_seconds / repetitions;
    const bool is_untold = seconds == 0;  // a system whose finest clock steps, too
    if (is_untold) seconds = mean(pass.build_wall_seconds) + mean(pass.trace_wall_seconds);
    return format(
        "%-10s %.6f s to build and trace once (%s over %s; in all user "
        "%.2f, system %.2f, wall %.2f s%s)\n",
        "average", seconds,
        is_untold  ? "time on the wall"
        : is_short ? "processor time by a fine clock"
                   : "user processor time",
        counted(pass.trace_seconds.size(), "repetition").c_str(), all.user_seconds,
        all.system_seconds, all.wall_seconds,
        is_short ? format("; the user clock steps by %.0f ms", kUserClockStepSeconds * 1000).c_str()
                 : "");
}

std::string difference_text(const image::Difference& d) {
    if (d.equal()) return "0 differing pixels, maximum difference 0, RMS 0, PSNR inf dB\n";
    return format("%s, maximum difference %d at pixel %d,%d, RMS %.6g, PSNR %.2f dB\n",
                  counted(d.differing_pixels, "differing pixel").c_str(), d.max_difference, d.x,
                  d.y, d.rms, d.psnr_db);
}

std::string pair_line(const Pair& pair) {
    return format("%-25s ", (pair.first + " / " + pair.second).c_str()) +
           difference_text(pair.difference);
}

}  // namespace

bool type_is_measured(const Options& options) {
    return options.profile_name == "fast" && options.profile.tracer == TracerChoice::kTiles &&
           !options.type_given && !options.compare;
}

SceneCounts count(const Scene& scene) {
    SceneCounts counts;
    counts.shapes = scene.shape_count;
    counts.objects = scene.objects.size();
    counts.lights = scene.lights.size();
    counts.warnings = scene.warnings.size();
    for (const Object& object : scene.objects) {
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            counts.triangles += mesh->triangles.size();
        } else {
            ++counts.spheres;
        }
    }
    return counts;
}

std::string profile_flags_text(const Options& options) {
    const Profile& profile = options.profile;
    std::string text = "--profile=" + options.profile_name;
    text += " --tracer=" + std::string(name_of(kTracers, profile.tracer));
    if (!options.compare && !type_is_measured(options))
        text += " --type=" + std::string(name_of(kOctreeTypes, profile.type));
    const std::string back_faces =
        " --back-faces=" + std::string(name_of(kBackFaces, profile.back_faces));
    if (profile.tracer == TracerChoice::kTiles) return text + back_faces;  // the others are its own
    if (options.compare || profile.type == OctreeType::kNonuniform)
        text += " --midpoint=" + std::string(name_of(kMidpoints, profile.midpoint));
    if (profile.max_objects) {
        text += format(" --max-objects=%zu", *profile.max_objects);
    } else {
        text += " --costs=" + std::string(name_of(kCosts, profile.costs));
    }
    text += " --leaves=" + std::string(name_of(kLeafContents, profile.leaves));
    text += " --walk=" + std::string(name_of(kWalks, profile.walk));
    text += profile.step ? format(" --step=%g", *profile.step) : " --step=exact";
    text += " --precision=" + std::string(name_of(kPrecisions, profile.precision));
    text += profile.bias ? format(" --bias=%g", *profile.bias) : " --bias=exact";
    text += back_faces;
    if (options.defaults != &x3d::standard_defaults)
        text += " --defaults=" + std::string(name_of(kDefaults, options.defaults));
    return text;
}

std::string report_text(const Options& options, const Report& report) {
    const SceneCounts& scene = report.scene;
    std::string text = headline(options, report);
    text +=
        format("%-10s %s: %s, %s, %s, %s\n", "scene", report.file.c_str(),
               counted(scene.shapes, "shape").c_str(), counted(scene.triangles, "triangle").c_str(),
               counted(scene.spheres, "sphere").c_str(), counted(scene.lights, "light").c_str());
    text += format("%-10s %.6f s to read the scene\n", "read", report.parse_seconds);
    text += format("%-10s %s\n", "profile", profile_flags_text(options).c_str());
    if (type_is_measured(options))
        text += format("%-10s %s, as measured on the scene (--type chooses)\n", "type",
                       report.passes.front().name.c_str());
    if (!report.rays)
        text += format(
            "%-10s %d x %d%s\n", "pixels", options.resolution.width, options.resolution.height,
            options.samples == 1
                ? ""
                : format(", each the mean of %d x %d", options.samples, options.samples).c_str());
    for (const Pass& pass : report.passes) {
        text += octree_lines(pass);
        if (!pass.build_seconds.empty()) text += time_line("build", pass.build_seconds);
        text += time_line("trace", pass.trace_seconds);
        if (pass.tiles && pass.tiles->threads > 1) text += wall_line(pass);
        if (!options.compare && !report.rays) text += average_line(pass);
    }
    for (const Pair& pair : report.pairs) text += pair_line(pair);
    if (report.error)
        text += format("%-10s from the exact profile's picture: ", "error") +
                difference_text(*report.error);
    if (report.rays)
        text += format("%-10s %zu, %zu of them hit\n", "rays", *report.rays, *report.hits);
    if (!report.picture.empty())
        text +=
            format("%-10s %s\n", report.rays ? "answers" : "picture",
                   report.picture == kStandardStream ? "standard output" : report.picture.c_str());
    for (const Pass& pass : report.passes) text += file_lines(pass.files);
    if (!report.difference.empty())
        text += format("%-10s %s\n", "difference", report.difference.c_str());
    return text;
}

}  // namespace nuvo::app
