#include "scene_files.h"

#include <iostream>
#include <system_error>

#include "nuvo/app/clocks.h"
#include "nuvo/app/commands.h"
#include "nuvo/image/file_writer.h"
#include "nuvo/scene/framing.h"
#include "text.h"

namespace nuvo::app {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error) return is_regular(a);
    return a.lexically_normal() == b.lexically_normal() && !fs::exists(a, error);
}

std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = '?';
    return text;
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

/// Puts the camera of a file that has none where it shows the scene, if the standard's does not.
void place_camera(const Options& options, LoadedScene& loaded) {
    Scene& scene = loaded.scene;
    if (scene.camera_given || options.rays || options.viewpoint == x3d::kStandardView) return;
    const bool asked = options.viewpoint == x3d::kFittedView;
    const Framing now = framing(scene, scene.camera, options.resolution);
    if (now == Framing::kGood && !asked) return;
    const std::optional<Camera> fitted = fitted_camera(scene);
    if (!fitted) return;
    scene.camera = *fitted;
    if (!scene.lights.empty() && !scene.lights.back().casts_shadow)
        scene.lights.back().direction = fitted->forward;  // the headlight
    if (asked) return;
    Bounds3 box;
    for (const Object& object : scene.objects) box = box.extended(bounds(object.shape));
    const Point3& p = fitted->position;
    std::cerr << "nuvo: note: " << loaded.path.string() << ": has no Viewpoint, and "
              << fault_of(now)
              << format(
                     ": the shapes lie between %.6g %.6g %.6g and %.6g %.6g %.6g, the camera is "
                     "fitted to them, at %.6g %.6g %.6g (--viewpoint=standard leaves it)",
                     box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z, p.x, p.y,
                     p.z)
              << '\n';
}

}  // namespace

LoadedScene load(const Options& options) {
    LoadedScene loaded;
    loaded.path = find_scene(options.file);
    const StageStopwatch watch;
    loaded.scene = x3d::read_file(
        loaded.path,
        {options.limits, options.headlight, options.viewpoint, options.strict, options.defaults()});
    loaded.parse_seconds = watch.seconds();
    for (const std::string& warning : loaded.scene.warnings)
        std::cerr << "nuvo: warning: " + one_line(loaded.path.string() + ": " + warning) + '\n';
    place_camera(options, loaded);
    return loaded;
}

bool is_regular(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

void check_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        for (const fs::path& input : inputs)
            if (is_same_file(input, outputs[i]))
                throw UsageError(outputs[i].string() + ": would be overwritten, but it is read");
        for (std::size_t j = 0; j < i; ++j)
            if (is_same_file(outputs[j], outputs[i]))
                throw UsageError(outputs[i].string() + ": would be written twice");
        image::check_writable(outputs[i]);
    }
}

}  // namespace nuvo::app
