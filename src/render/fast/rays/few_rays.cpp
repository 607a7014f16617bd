#include "fast/rays/few_rays.h"

#include "fast/shadow/segment_walk.h"
#include "fast/tile/local_ray.h"
#include "fast/tile/nearest_hit.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

// Measured on meshes of 10^3 to 10^6 triangles.
constexpr std::uint64_t kBoxesOfItem = 6;  // of the structure
constexpr std::uint64_t kBoxesOfRay = 64;
constexpr std::uint64_t kBoxesOfTest = 8;

}  // namespace

FewRays::FewRays(const FastScene& scene)
    : scene_(scene), kernel_(scene.scene(), scene.primitives(), std::nullopt, scene.back_faces()) {}

std::size_t FewRays::closest_hits(std::span<const Ray> rays, RayAnswer* answers) {
    const std::uint64_t allowed = kBoxesOfRay + kBoxesOfItem * scene_.slot_end();
    std::size_t answered = 0;
    for (; answered < rays.size() && spent_ + kBoxesOfRay <= allowed; ++answered)
        answers[answered] = closest_hit(rays[answered]);
    return answered;
}

RayAnswer FewRays::closest_hit(const Ray& ray) {
    NearestHit nearest(scene_, kernel_, ray);
    const auto test = [&](Slot slot) { spent_ += 1 + (nearest.test(slot) ? kBoxesOfTest : 0); };
    spent_ += kBoxesOfRay;
    const LocalRay local(ray, scene_.frame(), static_cast<float>(scene_.reach()));
    if (!nearest.may_meet_any()) {
        // Nothing is met.
    } else if (!local.valid) {
        for (Slot slot = 0; slot < scene_.slot_end(); ++slot) test(slot);
    } else {
        SegmentWalk walk({local.origin[0], local.origin[1], local.origin[2]},
                         {local.step[0], local.step[1], local.step[2]}, kInfinity, local.error);
        walk.any(scene_.octree(), [&](const Slot* slots, std::uint32_t count) {
            for (std::uint32_t i = 0; i < count; ++i) test(slots[i]);
            // Rounded up: a product, a difference, and the origin's own error.
            if (nearest.best()) {
                const double beyond = nearest.best()->root.high * local.scale;
                walk.end_at(beyond - local.advance + gamma(4) * (beyond + local.advance) +
                            2 * local.error);
            }
            return false;
        });
    }
    if (!nearest.best()) return {.t = kInfinity};
    const PrimitiveSource& source = scene_.source(nearest.slot());
    return {true, scene_.scene().objects[source.object].shape_index, source.triangle,
            nearest.best()->root.t};
}

}  // namespace nuvo
