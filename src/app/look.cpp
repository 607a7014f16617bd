#include "look.h"

#include <algorithm>
#include <array>
#include <iostream>

#include "nuvo/app/choices.h"
#include "nuvo/app/commands.h"
#include "nuvo/app/pixel.h"
#include "nuvo/image/heat_map.h"
#include "nuvo/image/npy.h"
#include "nuvo/image/png.h"
#include "octree_file.h"
#include "passes.h"
#include "pixel_words.h"
#include "scene_files.h"

namespace nuvo::app {
namespace {

namespace fs = std::filesystem;

static_assert(sizeof(Stage) == sizeof(std::uint8_t));

/// Calls `use(name, values)` for each plane.
template <typename Use>
void for_each_plane(const PixelPlanes& planes, Use&& use) {
    use("tests", std::span(planes.tests));
    use("searches", std::span(planes.searches));
    use("t", std::span(planes.t));
    use("shape", std::span(planes.shape));
    use("triangle", std::span(planes.triangle));
    use("stage",
        std::span(reinterpret_cast<const std::uint8_t*>(planes.stage.data()), planes.stage.size()));
}

fs::path plane_file(const std::string& prefix, const char* name) {
    return prefix + "-" + name + ".npy";
}

std::vector<double> plane_of(const PixelPlanes& planes, HeatmapOf of) {
    if (of == HeatmapOf::kTests) return {planes.tests.begin(), planes.tests.end()};
    if (of == HeatmapOf::kSearches) return {planes.searches.begin(), planes.searches.end()};
    std::vector<double> stages;
    for (const Stage stage : planes.stage) stages.push_back(static_cast<double>(stage));
    return stages;
}

HeatmapFigures write_heatmap(const Options& options, const fs::path& file,
                             const PixelPlanes& planes) {
    const HeatmapOf of = *options.heatmap;
    const std::vector<double> values = plane_of(planes, of);
    HeatmapFigures figures;
    figures.file = file.string();
    figures.of = of;
    figures.largest = *std::max_element(values.begin(), values.end());
    image::HeatScale scale;
    if (of == HeatmapOf::kStage) {
        for (const Stage stage : {Stage::kCheap, Stage::kWider, Stage::kExact})
            scale.names.emplace_back(stage_word(Precision::kExact, stage));
        scale.max = static_cast<double>(Stage::kExact);
    } else {
        // A picture without any cost has a scale, too.
        scale.max = options.heatmap_max.value_or(std::max(1.0, figures.largest));
    }
    scale.title = std::string(name_of(kHeatmaps, of)) +
                  (of == HeatmapOf::kStage ? " of arithmetic" : " a pixel");
    figures.scale_max = scale.max;
    image::write_png(file, image::heat_map(values, options.resolution.width, scale));
    return figures;
}

}  // namespace

fs::path heatmap_beside(const fs::path& picture, HeatmapOf of) {
    std::error_code ignored;
    if (fs::exists(picture, ignored) && !is_regular(picture)) return picture;
    fs::path name = picture.stem();
    name += "-" + std::string(name_of(kHeatmaps, of)) + ".png";
    return picture.parent_path() / name;
}

std::vector<fs::path> look_files(const Options& options, const fs::path& picture) {
    std::vector<fs::path> files;
    if (options.heatmap) files.push_back(heatmap_beside(picture, *options.heatmap));
    if (options.planes)
        for_each_plane({}, [&](const char* name, const auto&) {
            files.push_back(plane_file(*options.planes, name));
        });
    if (options.octree) files.emplace_back(*options.octree);
    return files;
}

void write_looks(const Options& options, const fs::path& picture, const Pass& pass,
                 Report& report) {
    if (options.heatmap)
        report.heatmap =
            write_heatmap(options, heatmap_beside(picture, *options.heatmap), *pass.planes);
    if (options.planes) {
        const std::array shape{static_cast<std::size_t>(options.resolution.height),
                               static_cast<std::size_t>(options.resolution.width)};
        for_each_plane(*pass.planes, [&](const char* name, const auto& values) {
            const fs::path file = plane_file(*options.planes, name);
            image::write_npy<std::remove_cv_t<typename std::decay_t<decltype(values)>::value_type>>(
                file, values, shape);
            report.planes.push_back(file.string());
        });
    }
    if (options.octree) {
        write_octree(*options.octree, *octree_format(*options.octree), *pass.octree, report.file);
        report.octree = *options.octree;
    }
}

ExitCode pixel_command(const Options& options) {
    const LoadedScene loaded = load(options);
    std::vector<fs::path> outputs;
    if (options.json) outputs.emplace_back(*options.json);
    if (options.octree) outputs.emplace_back(*options.octree);
    check_outputs({loaded.path}, outputs);

    const Profile profile = walked_profile(loaded.scene, options);
    const Primitives primitives = flatten(loaded.scene, profile.leaves);
    const Octree octree = build_tree(loaded.scene, primitives, profile);
    const Pixel pixel = *options.pixel;
    const PixelReport report{loaded.path.string(), pixel.x, pixel.y, profile,
                             explain_pixel(loaded.scene, primitives, octree, profile,
                                           options.resolution, pixel.x, pixel.y)};
    if (options.octree)
        write_octree(*options.octree, *octree_format(*options.octree), octree, report.file);
    if (options.json)
        image::write_file_atomically(*options.json,
                                     pixel_json(options, loaded.scene, primitives, report));
    if (!options.quiet) std::cout << pixel_text(options, loaded.scene, primitives, report);
    return kDone;
}

}  // namespace nuvo::app
