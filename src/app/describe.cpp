#include "nuvo/app/describe.h"

#include <array>
#include <cstdio>
#include <numbers>

#include "nuvo/math/one_line.h"

namespace nuvo::app {
namespace {

constexpr std::size_t kShownLights = 20;
constexpr std::size_t kShownViewpoints = 20;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
    std::array<char, 512> line;
    std::snprintf(line.data(), line.size(), pattern, values...);
    return line.data();
}

std::string triple(const Vector3& v) { return format("%.9g %.9g %.9g", v.x, v.y, v.z); }

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

struct Contents {
    std::size_t spheres = 0, ellipsoids = 0, meshes = 0;
    std::size_t triangles = 0, zero_area = 0, colored = 0, smooth = 0, unlit = 0;
    Bounds3 bounds;
};

void add_mesh(const TriangleMesh& mesh, Contents& contents) {
    ++contents.meshes;
    contents.triangles += mesh.triangles.size();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (has_zero_area(mesh.triangle(i))) ++contents.zero_area;
    if (!mesh.colors.empty()) ++contents.colored;
    if (!mesh.normals.empty()) ++contents.smooth;
}

Contents count_contents(const Scene& scene) {
    Contents contents;
    for (const Object& object : scene.objects) {
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
            add_mesh(*mesh, contents);
        else
            ++(std::holds_alternative<Sphere>(object.shape) ? contents.spheres
                                                            : contents.ellipsoids);
        if (!scene.materials[object.material].lit) ++contents.unlit;
        contents.bounds = contents.bounds.extended(bounds(object.shape));
    }
    return contents;
}

std::string light_line(const Light& light, std::size_t objects) {
    constexpr const char* kKinds[] = {"directional", "point", "spot"};
    std::string line = format("%-11s", light.casts_shadow ? "light" : "headlight") +
                       kKinds[static_cast<int>(light.kind)];
    if (light.kind != Light::Kind::kDirectional) line += ", at " + triple(light.location);
    if (light.kind != Light::Kind::kPoint) line += ", along " + triple(light.direction);
    line += ", color " + triple(light.color) + format(", intensity %.9g", light.intensity);
    if (light.kind != Light::Kind::kDirectional) line += format(", radius %.9g", light.radius);
    if (light.kind == Light::Kind::kSpot)
        line += format(", beam %.9g and cut-off %.9g degrees", degrees(light.beam_width),
                       degrees(light.cut_off_angle));
    if (light.scope.first > 0 || light.scope.last < objects) line += ", for its own group only";
    return line + "\n";
}

std::string lights_text(const Scene& scene) {
    std::string text = format("lights     %zu\n", scene.lights.size());
    for (std::size_t i = 0; i < scene.lights.size() && i < kShownLights; ++i)
        text += light_line(scene.lights[i], scene.objects.size());
    if (scene.lights.size() > kShownLights)
        text += format("           and %zu more\n", scene.lights.size() - kShownLights);
    return text;
}

std::string camera_text(const Scene& scene) {
    const Camera& camera = scene.camera;
    std::string text = "camera     at " + triple(camera.position) + ", along " +
                       triple(camera.forward) + ", up " + triple(camera.up) +
                       format(", field of view %.9g degrees\n", degrees(camera.field_of_view_rad));
    text += format("viewpoints %zu", scene.viewpoints.size());
    for (std::size_t i = 0; i < scene.viewpoints.size() && i < kShownViewpoints; ++i) {
        text += (i == 0 ? ": " : ", ") + one_line(scene.viewpoints[i]);
    }
    return text + (scene.viewpoints.size() > kShownViewpoints ? ", ...\n" : "\n");
}

std::string background_text(const Background& background) {
    std::string text = "background sky";
    for (const Color& color : background.sky_color) text += " (" + triple(color) + ")";
    if (!background.ground_color.empty()) text += ", ground";
    for (const Color& color : background.ground_color) text += " (" + triple(color) + ")";
    if (background.zenith != Vector3{0, 1, 0}) text += ", zenith " + triple(background.zenith);
    return text + "\n";
}

}  // namespace

std::string description(const std::string& file, const Scene& scene, double parse_seconds) {
    const Contents contents = count_contents(scene);
    std::string text = "scene      " + file + format(", read in %.3f s\n", parse_seconds);
    text += format("shapes     %zu, %zu drawn, %zu of them unlit\n", scene.shape_count,
                   scene.objects.size(), contents.unlit);
    text += format("spheres    %zu, and %zu ellipsoids\n", contents.spheres, contents.ellipsoids);
    text += format("meshes     %zu, %zu with normals and %zu with colors of their own\n",
                   contents.meshes, contents.smooth, contents.colored);
    text += format("triangles  %zu, %zu of them without area, which are never hit\n",
                   contents.triangles, contents.zero_area);
    text += lights_text(scene) + camera_text(scene) + background_text(scene.background);
    text += contents.bounds.empty() ? std::string("bounds     none\n")
                                    : "bounds     " + triple(contents.bounds.min) + " to " +
                                          triple(contents.bounds.max) + "\n";
    text += format("warnings   %zu\n", scene.warnings.size());
    return text;
}

}  // namespace nuvo::app
