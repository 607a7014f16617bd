#include "fast/tile/exact_fallback.h"

#include <cmath>
#include <limits>

namespace nuvo {
namespace {

// A float nearest to x is within this much of it, relatively; one more for the operations before.
constexpr float kRounded = 2 * std::numeric_limits<float>::epsilon();

}  // namespace

std::optional<ExactFallback::Nearest> ExactFallback::nearer(int x, int y, Slot slot,
                                                            Slot other) const {
    if (!may_test(kTestsOfPixel * tests_of(slot))) return std::nullopt;
    const Ray ray = camera_.rays.ray(x, y);
    const ExactRay prepared = kernel_.prepare(ray);
    const auto hit = kernel_.hit_of(prepared, scene_.id(slot));
    if (!hit) return std::nullopt;
    if (other != kNoSlot) {
        const auto best = kernel_.hit_of(prepared, scene_.id(other));
        if (best && !kernel_.precedes(prepared, *hit, *best)) return std::nullopt;
    }
    const CameraRays::Near q = camera_.near(x, y, hit->root.t);
    const auto value = static_cast<float>(q.value);
    const float error = rounded_up(q.error);
    const float share = std::copysign(kRounded, value);  // of infinities products only
    Nearest nearest{value * (1 - share) - error, value * (1 + share) + error, {}};
    if (slot >= scene_.triangle_end()) {
        const Object& object = scene_.object(scene_.id(slot));
        // As of a solid, so that the normal stays turned outwards. [Tile::ellipsoid_normal]
        const Object solid{{}, object.material, object.shape_index, true};
        nearest.normal = kernel_.surface(prepared, *hit, solid).normal;
    }
    return nearest;
}

ExactFallback::Kernel::Shadow ExactFallback::shadow_ray(int x, int y, Slot lit,
                                                        std::size_t light) const {
    return kernel_.shadow(surface(x, y, lit), scene_.scene().lights[light]);
}

const ExactFallback::Kernel::Surface& ExactFallback::surface(int x, int y, Slot lit) const {
    Surface& kept = surfaces_[static_cast<std::size_t>(y % kTileSide * kTileSide + x % kTileSide)];
    if (kept.x == x && kept.y == y && kept.slot == lit) return kept.surface;
    const ExactRay prepared = kernel_.prepare(camera_.rays.ray(x, y));
    const auto hit = kernel_.hit_of(prepared, scene_.id(lit));
    const Object& object = scene_.object(scene_.id(lit));
    kept = {x, y, lit, kernel_.surface(prepared, *hit, object)};
    return kept.surface;
}

bool ExactFallback::blocks_any(const Kernel::Shadow& ray, std::span<const Slot> leaf) const {
    LargeLeaf& large = large_leaves_.try_emplace(leaf.data(), scene_, kernel_, leaf).first->second;
    return large.crowd.blocked(ray, [&](PrimitiveId id) {
        const PrimitiveKind kind = kind_of(scene_.object(id).shape);
        if (!may_test(kind == PrimitiveKind::kEllipsoid ? kTestsOfEllipsoid : 1)) return true;
        const bool triangle = kind == PrimitiveKind::kTriangle;
        return (!triangle || box_comes_near(ray, id)) && kernel_.blocks(ray, {id, id + 1});
    });
}

}  // namespace nuvo
