#include "remarks.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "nuvo/geometry/predicates.h"
#include "nuvo/render/shading.h"
#include "nuvo/scene/x3d.h"
#include "text.h"

namespace nuvo::app {
namespace {

std::uint32_t packed(const Rgb8& color) {
    return std::uint32_t{color.r} << 16 | std::uint32_t{color.g} << 8 | color.b;
}

// Pixels all over the picture, the middle first, so that what shows somewhere is met soon: a prime
// beyond any side visits each pixel once.
class Pixels {
  public:
    explicit Pixels(const Image& picture)
        : width_(static_cast<std::uint64_t>(picture.width())),
          count_(width_ * static_cast<std::uint64_t>(picture.height())),
          middle_(static_cast<std::uint64_t>(picture.height() / 2) * width_ + width_ / 2) {}
    std::uint64_t count() const { return count_; }
    int x(std::uint64_t i) const { return static_cast<int>(place(i) % width_); }
    int y(std::uint64_t i) const { return static_cast<int>(place(i) / width_); }

  private:
    static constexpr std::uint64_t kStride = 1'000'003;
    std::uint64_t place(std::uint64_t i) const { return (middle_ + i * kStride) % count_; }
    std::uint64_t width_;
    std::uint64_t count_;
    std::uint64_t middle_;
};

/// What the picture shows may be nothing but background, or nothing but what needs no light.
struct Suspicion {
    bool empty = true;
    bool dark = true;
};

Suspicion suspicion(const Scene& scene, const Image& picture) {
    std::unordered_set<std::uint32_t> glowing;
    Suspicion may;
    may.dark = false;
    for (const Material& material : scene.materials) {
        glowing.insert(packed(quantized(material.emissive_color)));
        may.dark = may.dark || material.lit;
    }
    const RayGenerator rays(scene.camera, {picture.width(), picture.height()});
    const Pixels pixels(picture);
    for (std::uint64_t i = 0; i < pixels.count() && (may.empty || may.dark); ++i) {
        const int x = pixels.x(i);
        const int y = pixels.y(i);
        const std::uint32_t color = packed(picture.at(x, y));
        const bool background =
            color == packed(quantized(scene.background.color(rays.ray(x, y).direction)));
        may.empty = may.empty && background;
        may.dark = may.dark && (background || glowing.contains(color));
    }
    return may;
}

/// What rays of a picture met.
struct Met {
    std::size_t asked = 0;
    std::size_t any = 0;
    std::size_t lit = 0;     ///< that reflects light
    std::size_t alight = 0;  ///< where some light adds to what is emitted
};

Met met_by(const Scene& scene, const Image& picture, const Suspicion& may, const Answers& answers) {
    std::unordered_map<std::int64_t, const Material*> materials;
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[object.material];
        const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        const bool reflects = material.diffuse_color != Color{} ||
                              material.specular_color != Color{} ||
                              (mesh != nullptr && !mesh->colors.empty());
        if (material.lit && reflects) materials[object.shape_index] = &material;
    }
    const RayGenerator generator(scene.camera, {picture.width(), picture.height()});
    const Pixels pixels(picture);
    const auto ask = [&](std::uint64_t end, Met& met) {
        std::vector<Ray> rays;
        for (std::uint64_t i = met.asked; i < end; ++i)
            rays.push_back(generator.ray(pixels.x(i), pixels.y(i)));
        const std::vector<RayAnswer> found = answers(rays);
        for (const RayAnswer& answer : found) {
            const std::uint64_t i = met.asked++;
            if (!answer.hit) continue;
            ++met.any;
            const auto material = materials.find(answer.shape);
            if (material == materials.end()) continue;
            ++met.lit;
            if (packed(picture.at(pixels.x(i), pixels.y(i))) !=
                packed(quantized(material->second->emissive_color)))
                ++met.alight;
        }
    };
    // Few tell, unless nothing is met. The others in one call: what a tracer learns from ray to ray
    // it forgets from call to call.
    constexpr std::uint64_t kFew = 1 << 10;
    constexpr std::uint64_t kMost = 1 << 16;
    Met met;
    ask(std::min(pixels.count(), kFew), met);
    if (met.any == 0 && may.empty) ask(std::min(pixels.count(), kMost), met);
    return met;
}

Bounds3 bounds_of(const Scene& scene) {
    Bounds3 box;
    for (const Object& object : scene.objects) box = box.extended(bounds(object.shape));
    return box;
}

/// Whether the ray meets the back of a triangle of the mesh before any front.
bool sees_back(const TriangleMesh& mesh, const Ray& ray) {
    const ExactRay exact(ray);
    StageCounts counts;
    double nearest = std::numeric_limits<double>::infinity();
    bool back = false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle triangle = mesh.triangle(i);
        const std::optional<Root> root = hit(exact, triangle, counts);
        if (!root || root->t >= nearest) continue;
        nearest = root->t;
        back = !hit(exact, triangle, counts, Sides::kFront);
    }
    return back;
}

/// Whether rays of the picture, as many as there is time for, meet backs of solid meshes. (Those of
/// round shapes are seen from within alone.)
bool meets_backs(const Scene& scene, const Image& picture) {
    constexpr std::uint64_t kMostRays = 1 << 10;
    constexpr std::uint64_t kMostTests = 1 << 22;
    std::uint64_t items = scene.objects.size() + 1;
    for (const Object& object : scene.objects)
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
            items += mesh->triangles.size();
    const RayGenerator generator(scene.camera, {picture.width(), picture.height()});
    const Pixels pixels(picture);
    const std::uint64_t rays =
        std::min({pixels.count(), kMostRays, std::max<std::uint64_t>(kMostTests / items, 1)});
    for (std::uint64_t i = 0; i < rays; ++i)
        for (const Object& object : scene.objects)
            if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
                mesh != nullptr && object.solid &&
                sees_back(*mesh, generator.ray(pixels.x(i), pixels.y(i))))
                return true;
    return false;
}

std::string nothing_met(const Scene& scene, const Options& options, const Profile& profile,
                        const Met& met, const Image& picture) {
    const Bounds3 box = bounds_of(scene);
    if (box.empty()) return "no ray met anything: there is no shape to draw";
    const std::string none =
        met.asked == picture.pixels().size()
            ? "no ray met anything"
            : format("none of %zu rays, spread over the picture, met anything", met.asked);
    if (profile.back_faces == BackFaces::kSolid && meets_backs(scene, picture))
        return none +
               ": of the shapes in sight all that faces the camera are backs of solid ones, which "
               "are invisible (--back-faces=draw draws them, solid='false' in the file lights "
               "them, too)";
    return none +
           format(
               ": the shapes lie between %.6g %.6g %.6g and %.6g %.6g %.6g, the camera is at "
               "%.6g %.6g %.6g",
               box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z,
               scene.camera.position.x, scene.camera.position.y, scene.camera.position.z) +
           (options.viewpoint == x3d::kFittedView ? "" : " (--viewpoint=fit looks at them)");
}

std::string all_dark(const Scene& scene) {
    const bool has_headlight = !scene.lights.empty() && !scene.lights.back().casts_shadow;
    return "no light adds anything to what is seen, of " + counted(scene.lights.size(), "light") +
           (has_headlight ? "" : " (--headlight=on adds one at the camera)");
}

/// Whether the point is surrounded by the shape's inner side.
bool is_inside(const Shape& shape, const Point3& point) {
    if (!bounds(shape).contains(point)) return false;
    const auto sees_back_along = [&](const Vector3& direction) {
        const Ray ray{point, direction};
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) return sees_back(*mesh, ray);
        StageCounts counts;
        const auto found = [&](const auto& round) {
            const std::optional<SphereHit> hit = nuvo::hit(ExactRay(ray), round, counts);
            return hit && hit->which == SphereRoot::kFar;
        };
        if (const auto* sphere = std::get_if<Sphere>(&shape)) return found(*sphere);
        return found(std::get<Ellipsoid>(shape));
    };
    const Vector3 directions[] = {{0, 1, 0},  {0, -1, 0}, {1, 0, 0},
                                  {-1, 0, 0}, {0, 0, 1},  {0, 0, -1}};
    return std::all_of(std::begin(directions), std::end(directions), sees_back_along);
}

std::optional<std::string> inside_solid(const Scene& scene) {
    for (const Object& object : scene.objects)
        if (object.solid && is_inside(object.shape, scene.camera.position))
            return "the camera stands inside Shape " + std::to_string(object.shape_index) +
                   " (from 0), which is solid: from within it is invisible (--back-faces=draw "
                   "shows it)";
    return std::nullopt;
}

}  // namespace

std::vector<std::string> remarks(const Scene& scene, const Options& options, const Profile& profile,
                                 const Image& picture, const Answers& answers) {
    std::vector<std::string> lines;
    const Suspicion may = suspicion(scene, picture);
    if (may.empty || may.dark) {
        const Met met = met_by(scene, picture, may, answers);
        if (met.any == 0 && may.empty)
            lines.push_back(nothing_met(scene, options, profile, met, picture));
        else if (may.dark && met.lit > 0 && met.alight == 0)
            lines.push_back(all_dark(scene));
    }
    if (profile.back_faces == BackFaces::kSolid)
        if (const auto line = inside_solid(scene)) lines.push_back(*line);
    return lines;
}

}  // namespace nuvo::app
