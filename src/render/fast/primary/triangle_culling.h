// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_TRIANGLE_CULLING_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_TRIANGLE_CULLING_H_
#undef NUVO_RENDER_FAST_TRIANGLE_CULLING_H_
#else
#define NUVO_RENDER_FAST_TRIANGLE_CULLING_H_
#endif

#include <algorithm>
#include <cmath>
#include <utility>

#include "fast/primary/frustum.h"
#include "fast/scene/fast_scene.h"
#include "fast/scene/local_corners.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Most triangles of the leaves that a macro tile may show lie beside it or between the middles of
// its pixels, or turn a back to the eye that nobody sees. Floats of the local frame, which lie by
// slot, tell so of 16 at a time; so only the others' corners are fetched, through object, mesh and
// indices.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class TriangleCulling {
  public:
    static constexpr std::size_t kBatch = 16;

    TriangleCulling(const FastScene& scene, const CameraRays& camera, const Frustum& frustum)
        : scene_(scene), frustum_(frustum), weight_(camera.parallel ? 0.0F : 1.0F), eye_far_(0) {
        const Vector3 eye = camera.parallel ? -camera.forward : camera.origin;
        for (int axis = 0; axis < 3; ++axis) {
            eye_[axis] = static_cast<float>(eye[axis]);
            eye_far_ = std::max(eye_far_, std::fabs(eye_[axis]));
        }
    }

    /// Which of these triangles may show.
    HWY_INLINE RayMask keeps(const Slot* slots) const {
        const BigVector<LocalTriangle>& triangles = scene_.triangles();
        Floats at[3][3];
        load_corners([&](std::size_t i) -> const LocalTriangle& { return triangles[slots[i]]; },
                     at);
        Floats size[3];
        for (int axis = 0; axis < 3; ++axis)
            size[axis] = max(abs(at[0][axis]), max(abs(at[1][axis]), abs(at[2][axis])));
        const RayMask kept = frustum_.may_cover(at, size);
        const std::uint32_t front_only = scene_.front_only(slots);
        if (front_only == 0) return kept;
        return without(kept, RayMask::from_bits(front_only) & back_facing(at, size));
    }

  private:
    // [numerics: backs of triangles]
    static constexpr float kBackError = roundings(64);
    static constexpr float kCoordinateError = roundings(8);

    // Those that surely turn their backs to the eye: (b - a) x (c - a) . (a - eye) > 0.
    HWY_INLINE RayMask back_facing(const Floats (&at)[3][3], const Floats (&size)[3]) const {
        Floats ab[3];
        Floats ac[3];
        Floats from_eye[3];
        Floats edge(0.0F);
        Floats distance(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            ab[axis] = at[1][axis] - at[0][axis];
            ac[axis] = at[2][axis] - at[0][axis];
            from_eye[axis] = mul_add(at[0][axis], Floats(weight_), Floats(-eye_[axis]));
            edge = max(edge, max(abs(ab[axis]), abs(ac[axis])));
            distance = max(distance, abs(from_eye[axis]));
        }
        const auto component = [&](int i, int j)
                                   HWY_ATTR { return mul_add(ab[i], ac[j], -(ab[j] * ac[i])); };
        const Floats side =
            mul_add(component(1, 2), from_eye[0],
                    mul_add(component(2, 0), from_eye[1], component(0, 1) * from_eye[2]));
        const Floats far = max(size[0], max(size[1], size[2]));
        const Floats more = mul_add(far, Floats(kCoordinateError), edge);
        const Floats error =
            Floats(kBackError) * more *
            mul_add(more + far, distance, more * mul_add(far, Floats(weight_), Floats(eye_far_)));
        return side > error + Floats(static_cast<float>(kFloatUnderflow));
    }

    const FastScene& scene_;
    const Frustum& frustum_;
    // Homogeneous: eye_ / weight_; in a parallel projection infinitely far.
    float eye_[3];
    float weight_;
    float eye_far_;  // its largest coordinate
};

/// Triangles on their way through that test, 16 at a time; each waits for a batch more, until its
/// floats have arrived.
class TriangleQueue {
  public:
    static constexpr std::size_t kBatch = TriangleCulling::kBatch;

    TriangleQueue(const FastScene& scene, const CameraRays& camera, const Frustum& frustum)
        : triangles_(scene.triangles()), culling_(scene, camera, frustum) {}

    /// Adds one. Calls use(slots, kBatch) for those that may show.
    template <typename Use>
    HWY_INLINE void add(Slot slot, Use&& use) {
        prefetch_corners(triangles_[slot]);
        Batch& newest = met_[newest_];
        newest.slots[newest.count++] = slot;
        if (newest.count == kBatch) advance(use);
    }
    /// Calls use(slots, count) for all that are left.
    template <typename Use>
    HWY_INLINE void finish(Use&& use) {
        advance(use);
        advance(use);
        use(kept_, kept_count_);
    }

  private:
    struct Batch {
        std::size_t count = 0;
        Slot slots[kBatch] = {};
    };

    template <typename Use>
    HWY_NOINLINE void advance(Use&& use) {
        newest_ = 1 - newest_;
        Batch& oldest = met_[newest_];
        const std::size_t count = std::exchange(oldest.count, std::size_t{0});
        if (count == 0) return;
        const RayMask kept = culling_.keeps(oldest.slots) & RayMask::from_bits((1U << count) - 1);
        kept_count_ += Ints::load(oldest.slots)
                           .compress_store(kept_ + kept_count_, mask_for<std::int32_t>(kept));
        if (kept_count_ < kBatch) return;
        use(kept_, kBatch);
        kept_count_ -= kBatch;
        Ints::load(kept_ + kBatch).store(kept_);
    }

    const BigVector<LocalTriangle>& triangles_;
    TriangleCulling culling_;
    Batch met_[2];
    std::size_t newest_ = 0;
    Slot kept_[2 * kBatch] = {};
    std::size_t kept_count_ = 0;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_TRIANGLE_CULLING_H_
