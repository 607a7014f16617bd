#include "fast/rays/few_rays.h"

#include <limits>

#include "fast/shadow/segment_walk.h"
#include "fast/tile/local_ray.h"
#include "leaf_boxes.h"

namespace nuvo {
namespace {

// Measured on meshes of 10^3 to 10^6 triangles.
constexpr std::uint64_t kBoxesOfItem = 16;  // of the structure
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
    const ExactRay prepared = kernel_.prepare(ray);
    const Slabs slabs(prepared);
    std::optional<Kernel::Hit> best;
    const auto test = [&](Slot slot) {
        const PrimitiveId id = scene_.id(slot);
        const double end = best ? best->root.high : std::numeric_limits<double>::infinity();
        ++spent_;
        if (slabs.surely_missed(scene_.primitives().item_boxes[id], end)) return;
        spent_ += kBoxesOfTest;
        const auto hit = kernel_.hit_of(prepared, id);
        if (hit && (!best || kernel_.precedes(prepared, *hit, *best))) best = hit;
    };
    spent_ += kBoxesOfRay;
    const auto reach = static_cast<float>(scene_.reach());
    const LocalRay local(ray, scene_.frame(), reach);
    Bounds3 all;
    for (const KindSummary& kind : scene_.primitives().kinds) all = all.extended(kind.box);
    if (slabs.surely_missed(all, std::numeric_limits<double>::infinity())) {
        // Nothing is met.
    } else if (!local.valid) {
        for (Slot slot = 0; slot < scene_.slot_end(); ++slot) test(slot);
    } else {
        SegmentWalk walk({local.origin[0], local.origin[1], local.origin[2]},
                         {local.step[0], local.step[1], local.step[2]},
                         std::numeric_limits<double>::infinity(), local.error);
        walk.any(scene_.octree(), [&](const Slot* slots, std::uint32_t count) {
            for (std::uint32_t i = 0; i < count; ++i) test(slots[i]);
            // Rounded up: a product, a difference, and the origin's own error.
            if (best) {
                const double beyond = best->root.high * local.scale;
                walk.end_at(beyond - local.advance + gamma(4) * (beyond + local.advance) +
                            2 * local.error);
            }
            return false;
        });
    }
    if (!best) return {.t = std::numeric_limits<double>::infinity()};
    const PrimitiveSource& source = scene_.primitives().sources[best->primitive];
    return {true, scene_.object(best->primitive).shape_index, source.triangle, best->root.t};
}

}  // namespace nuvo
