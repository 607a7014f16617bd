#include "scene_files.h"

#include <cstdio>
#include <iostream>
#include <numbers>
#include <system_error>

#include "nuvo/app/clocks.h"
#include "nuvo/app/commands.h"
#include "nuvo/image/file_writer.h"
#include "nuvo/math/one_line.h"
#include "nuvo/scene/framing.h"
#include "text.h"

namespace nuvo::app {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    if (a == kStandardStream || b == kStandardStream) return a == b;
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error) return is_regular(a);
    return a.lexically_normal() == b.lexically_normal() && !fs::exists(a, error);
}

const char* fault_of(Framing framing) {
    switch (framing) {
        case Framing::kNothing:
            return "no ray of the standard's meets anything";
        case Framing::kCut:
            return "the standard's cuts the scene off";
        case Framing::kTiny:
            return "the standard's shows the scene tiny";
        case Framing::kGood:
            break;
    }
    return "the standard's shows the scene";
}

void turn_headlight(Scene& scene) {
    if (!scene.lights.empty() && !scene.lights.back().casts_shadow)
        scene.lights.back().direction = scene.camera.forward;
}

/// The camera as --from, --at and --fov want it.
void aim_camera(const Options& options, Scene& scene) {
    Camera& camera = scene.camera;
    if (options.fov_degrees) {
        camera.field_of_view_rad = *options.fov_degrees * std::numbers::pi / 180;
        camera.window.reset();
    }
    if (!options.from && !options.at) return;
    std::optional<Point3> at = options.at;
    if (!at) {
        Bounds3 box;
        for (const Object& object : scene.objects) box = box.extended(bounds(object.shape));
        if (!box.empty()) at = box.min * 0.5 + box.max * 0.5;
    }
    const Point3 from = options.from.value_or(camera.position);
    if (!at) at = from + camera.forward;
    const std::optional<Camera> aimed = aimed_camera(camera, from, *at);
    if (!aimed)
        throw UsageError(format("--at=%.9g,%.9g,%.9g: the camera stands there, or out of reach",
                                at->x, at->y, at->z));
    camera = *aimed;
    turn_headlight(scene);
}

/// Puts the camera of a file that has none where it shows the scene, if the standard's does not.
void place_camera(const Options& options, LoadedScene& loaded) {
    Scene& scene = loaded.scene;
    if (scene.camera_given || options.rays || options.from ||
        options.viewpoint == x3d::kStandardView)
        return;
    const bool asked = options.viewpoint == x3d::kFittedView;
    const Framing now = framing(scene, scene.camera, options.resolution);
    if (now == Framing::kGood && !asked) return;
    const std::optional<Camera> fitted = fitted_camera(scene);
    if (!fitted) return;
    scene.camera = *fitted;
    turn_headlight(scene);
    if (asked) return;
    Bounds3 box;
    for (const Object& object : scene.objects) box = box.extended(bounds(object.shape));
    const Point3& p = fitted->position;
    std::cerr << "nuvo: note: " << loaded.name << ": has no Viewpoint, and " << fault_of(now)
              << format(
                     ": the shapes lie between %.6g %.6g %.6g and %.6g %.6g %.6g, the camera is "
                     "fitted to them, at %.6g %.6g %.6g (--viewpoint=standard leaves it)",
                     box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z, p.x, p.y,
                     p.z)
              << '\n';
}

}  // namespace

LoadedScene load(const Options& options, Meter& meter) {
    LoadedScene loaded;
    const bool piped = options.file == kStandardStream;
    loaded.path = piped ? fs::path(kStandardStream) : find_scene(options.file);
    loaded.name = piped ? "standard input" : loaded.path.string();
    const x3d::ReadOptions how{options.limits,
                               options.headlight,
                               options.viewpoint,
                               options.strict,
                               options.defaults(),
                               meter.begin("reading"),
                               options.answer_parts.def ? &loaded.shape_names : nullptr,
                               options.thread_count()};
    loaded.memory.peak_start = peak_memory_bytes();
    const StageStopwatch watch;
    loaded.scene =
        piped ? x3d::read_text(read_standard_input(options.limits.file_bytes, how.progress),
                               loaded.name, how)
              : x3d::read_file(loaded.path, how);
    loaded.parse_seconds = watch.seconds();
    loaded.parse_wall_seconds = watch.wall_seconds();
    loaded.memory.peak_reading = peak_memory_bytes();
    loaded.memory.scene = memory_bytes(loaded.scene);
    meter.end();
    for (const std::string& warning : loaded.scene.warnings)
        std::cerr << "nuvo: warning: " + one_line(loaded.name + ": " + warning) + '\n';
    place_camera(options, loaded);
    aim_camera(options, loaded.scene);
    return loaded;
}

std::string read_standard_input(std::size_t most, Progress* progress) {
    begin(progress, "bytes", 0);
    std::string text;
    std::vector<char> block(1 << 18);
    while (std::cin.read(block.data(), static_cast<std::streamsize>(block.size())),
           std::cin.gcount() > 0) {
        text.append(block.data(), static_cast<std::size_t>(std::cin.gcount()));
        add(progress, static_cast<std::uint64_t>(std::cin.gcount()));
        if (text.size() > most)
            throw x3d::Error("standard input: file: is too large (limit " + std::to_string(most) +
                             ")");
    }
    // std::cin takes an error of reading for the end.
    if (std::cin.bad() || std::ferror(stdin) != 0)
        throw x3d::Error("standard input: cannot be read");
    return text;
}

bool is_regular(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

void check_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        for (const fs::path& input : inputs)
            if (input != kStandardStream && is_same_file(input, outputs[i]))
                throw UsageError(outputs[i].string() + ": would be overwritten, but it is read");
        for (std::size_t j = 0; j < i; ++j)
            if (is_same_file(outputs[j], outputs[i]))
                throw UsageError(outputs[i].string() + ": would be written twice");
        image::check_writable(outputs[i]);
    }
}

}  // namespace nuvo::app
