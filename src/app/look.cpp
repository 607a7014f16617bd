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

/// "", or "-NAME" of a pass.
std::string suffix(const std::string& pass) {
    std::string text = pass.empty() ? "" : "-" + pass;
    std::replace(text.begin(), text.end(), ' ', '-');
    return text;
}

fs::path plane_file(const Options& options, const std::string& pass, const char* plane) {
    return *options.planes + suffix(pass) + "-" + plane + ".npy";
}

/// Beside the picture; a picture that is no regular file (a device) takes it, too.
fs::path heatmap_file(const Options& options, const fs::path& picture, const std::string& pass) {
    std::error_code ignored;
    if (fs::exists(picture, ignored) && !is_regular(picture)) return picture;
    fs::path name = picture.stem();
    name += suffix(pass) + "-" + std::string(name_of(kHeatmaps, *options.heatmap)) + ".png";
    return picture.parent_path() / name;
}

fs::path octree_file(const Options& options, const std::string& pass) {
    const fs::path given = *options.octree;
    if (pass.empty()) return given;
    fs::path name = given.stem();
    name += suffix(pass);
    name += given.extension();
    return given.parent_path() / name;
}

std::vector<double> plane_of(const PixelPlanes& planes, HeatmapOf of) {
    if (of == HeatmapOf::kTests) return {planes.tests.begin(), planes.tests.end()};
    if (of == HeatmapOf::kSearches) return {planes.searches.begin(), planes.searches.end()};
    std::vector<double> stages;
    for (const Stage stage : planes.stage) stages.push_back(static_cast<double>(stage));
    return stages;
}

double largest(const PixelPlanes& planes, HeatmapOf of) {
    const std::vector<double> values = plane_of(planes, of);
    return *std::max_element(values.begin(), values.end());
}

image::HeatScale scale_for(const Options& options, const std::vector<Pass>& passes) {
    const HeatmapOf of = *options.heatmap;
    image::HeatScale scale;
    scale.title = name_of(kHeatmaps, of);
    if (of == HeatmapOf::kStage) {
        scale.title += " of arithmetic";
        for (const Stage stage : {Stage::kCheap, Stage::kWider, Stage::kExact})
            scale.names.emplace_back(stage_word(Precision::kExact, stage));
        scale.max = static_cast<double>(Stage::kExact);
        return scale;
    }
    scale.title += " a pixel";
    scale.max = 1;  // a picture without any cost has a scale, too
    for (const Pass& pass : passes) scale.max = std::max(scale.max, largest(*pass.planes, of));
    scale.max = options.heatmap_max.value_or(scale.max);
    return scale;
}

void write_planes(const Options& options, const std::string& name, Pass& pass) {
    const std::array shape{static_cast<std::size_t>(options.resolution.height),
                           static_cast<std::size_t>(options.resolution.width)};
    for_each_plane(*pass.planes, [&](const char* plane, const auto& values) {
        using Value = std::remove_cv_t<typename std::decay_t<decltype(values)>::value_type>;
        const fs::path file = plane_file(options, name, plane);
        image::write_npy<Value>(file, values, shape);
        pass.files.planes.push_back(file.string());
    });
}

}  // namespace

std::vector<fs::path> look_files(const Options& options, const fs::path& picture,
                                 const std::string& pass) {
    std::vector<fs::path> files;
    if (options.heatmap) files.push_back(heatmap_file(options, picture, pass));
    if (options.planes)
        for_each_plane({}, [&](const char* plane, const auto&) {
            files.push_back(plane_file(options, pass, plane));
        });
    if (options.octree) files.push_back(octree_file(options, pass));
    return files;
}

void write_looks(const Options& options, const fs::path& picture, const std::string& scene,
                 std::vector<Pass>& passes) {
    image::HeatScale scale;
    if (options.heatmap) scale = scale_for(options, passes);
    for (Pass& pass : passes) {
        const std::string name = passes.size() == 1 ? "" : pass.name;
        if (options.heatmap) {
            const fs::path file = heatmap_file(options, picture, name);
            image::write_png(file, image::heat_map(plane_of(*pass.planes, *options.heatmap),
                                                   options.resolution.width, scale));
            pass.files.heatmap = {file.string(), *options.heatmap,
                                  largest(*pass.planes, *options.heatmap), scale.max};
        }
        if (options.planes) write_planes(options, name, pass);
        if (pass.octree) {  // brute force has none
            const fs::path file = octree_file(options, name);
            write_octree(file, *octree_format(file), *pass.octree, scene);
            pass.files.octree = file.string();
        }
    }
}

ExitCode pixel_command(const Options& options) {
    Meter meter(options.shows_progress());
    const LoadedScene loaded = load(options, meter);
    std::vector<fs::path> outputs;
    if (options.json) outputs.emplace_back(*options.json);
    if (options.octree) outputs.emplace_back(*options.octree);
    check_outputs({loaded.path}, outputs);

    const Profile profile = walked_profile(loaded.scene, options, meter);
    const Primitives primitives = flatten(loaded.scene, profile.leaves);
    const Octree octree = build_tree(loaded.scene, primitives, profile, meter.begin("building"));
    const Pixel pixel = *options.pixel;
    const PixelReport report{loaded.name, pixel.x, pixel.y, profile,
                             explain_pixel(loaded.scene, primitives, octree, profile,
                                           options.resolution, pixel.x, pixel.y)};
    meter.begin("writing");
    if (options.octree)
        write_octree(*options.octree, *octree_format(*options.octree), octree, report.file);
    if (options.json)
        image::write_file_atomically(*options.json,
                                     pixel_json(options, loaded.scene, primitives, report));
    meter.end();
    if (!options.quiet)
        (options.standard_output_taken() ? std::cerr : std::cout)
            << pixel_text(options, loaded.scene, primitives, report);
    return kDone;
}

}  // namespace nuvo::app
