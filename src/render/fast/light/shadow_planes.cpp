#include "fast/light/shadow_planes.h"

#include <algorithm>
#include <bit>

#include "exact_kernel.h"
#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light/shadow_planes.cpp"
#include <hwy/foreach_target.h>

#include "fast/simd/wide_vectors.h"

// Eight triangles at a time in double. With the light at l / h, v = h a - l and edges e1 = b - a,
// e2 = c - a: the plane through light and edge e is e x v, the triangle's own e1 x e2, and
// K = -(e1 x e2).v tells by its sign on which side the light stands.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class PlanesMaker {
  public:
    explicit PlanesMaker(const ShadowPlanesJob& job)
        : job_(job),
          center_(Wide3::all(job.scene.frame().center)),
          toward_(Wide3::all(job.light.toward)),
          scale_(job.scene.frame().scale),
          weight_(job.light.weight),
          size_(job.light.weight * job.scene.reach() + max_norm(job.light.toward)),
          dense_(job.scene.frame().dense) {}

    HWY_INLINE void make(const TriangleBatch& batch, Slot first, std::size_t count) {
        const Wide3 a = Wide3::load(batch.corner);
        const Wide3 b = Wide3::load(batch.corner + 3);
        const Wide3 c = Wide3::load(batch.corner + 6);
        const Wide3 e1 = (b - a) * scale_;
        const Wide3 e2 = (c - a) * scale_;
        const Wide3 e3 = (c - b) * scale_;
        const Wide3 local_a = (a - center_) * scale_;
        const Wide3 local_b = (b - center_) * scale_;
        const Wide3 from_a = local_a * weight_ - toward_;
        const Wide3 from_b = local_b * weight_ - toward_;
        const Wide3 normal = cross(e1, e2);
        const Wide farthest = max(max_norm(local_a), max_norm(local_b));
        const Wide norm1_of_e1 = norm1(e1);
        const Wide norm1_of_e2 = norm1(e2);
        const Wide edges = norm1_of_e1 * norm1_of_e2;
        const Wide side = signs(batch, count, dot(normal, from_a), edges);
        const std::uint32_t there = (1U << count) - 1;
        const std::uint32_t hides =
            ((side > Wide(0.0)).bits() | ((side < Wide(0.0)).bits() & ~batch.front_only)) &
            ~batch.shadowless & there;
        job_.hides[first / kBatch] = static_cast<std::uint8_t>(hides);
        if (hides == 0) return;
        put(0, cross(e1, from_a), side, local_a, norm1_of_e1 * size_, farthest);
        put(1, cross(from_a, e2), side, local_a, norm1_of_e2 * size_, farthest);
        put(2, cross(e3, from_b), side, local_b, norm1(e3) * size_, farthest);
        put(3, normal, Wide(0.0) - side, local_a, edges, farthest);
        // Where the light lies in the plane nothing is hidden from it.
        if (any_in_plane_)
            for (std::size_t i = 0; i < count; ++i)
                if (sides_[i] == 0) columns_.at[3][3][i] = -1;
        static_assert(sizeof(ShadowPlanes) == 16 * sizeof(float));
        columns_.write(job_.out[first].plane[0], count);
    }

  private:
    // A plane is kept where its normal's relative error is at most this, a quarter of a float's
    // roundoff, and where it moves the plane by at most so much of its distance from 0, or of
    // LocalFrame::dense. [numerics: shadow planes]
    static constexpr double kShare = 0x1p-26;
    // Edges have one rounding, v at most four of size_; a component of their product two products
    // of these, and a difference: 2 (1 + 4 + 1) + 2 roundings; three components; a few to spare.
    static constexpr double kNormalError = 48 * kUnitRoundoff;
    // K sums three such components against v, which has four roundings and three more of the sum.
    static constexpr double kSideError = 2 * kNormalError;
    static constexpr double kSmallest = 0x1p-900;  // nothing above has lost to underflow

    // 1 where the light is on the side that the normal points to, -1 or 0: of -n.v.
    HWY_INLINE Wide signs(const TriangleBatch& batch, std::size_t count, const Wide& nv,
                          const Wide& edges) {
        const Wide bound = edges * (size_ * Wide(kSideError)) + Wide(kSmallest);
        const Wide rounded = select(nv > Wide(0.0), Wide(-1.0), Wide(1.0));
        const std::uint32_t open = ~(abs(nv) > bound).bits() & ((1U << count) - 1);
        any_in_plane_ = false;
        if (open == 0) return rounded;
        rounded.store(sides_);
        decide(batch, open);
        return Wide::load(sides_);
    }
    HWY_NOINLINE void decide(const TriangleBatch& batch, std::uint32_t open) {
        const LightPlace light = place_of(job_.exact_light);
        for (; open != 0; open &= open - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(open));
            sides_[i] = -exact_side(batch.triangle(i), light.at, light.endless);
            any_in_plane_ |= sides_[i] == 0;
        }
    }

    HWY_INLINE void put(std::size_t p, const Wide3& normal, const Wide& sign, const Wide3& on_it,
                        const Wide& magnitude, const Wide& farthest) {
        const Wide norm = norm1(normal);
        const Wide error = magnitude * Wide(kNormalError / kShare);
        const Wide away = dot(normal, on_it);
        const auto known = (norm > error) &
                           (max(abs(away), norm * Wide(dense_)) > error * farthest) &
                           (norm > Wide(kSmallest)) & (norm < Wide(1 / kSmallest));
        const Wide zero(0.0);
        const Wide factor = select(known, sign / norm, zero);
        const Wide3 n = select(known, normal, Wide3{zero, zero, zero}) * factor;
        store_rounded(n, columns_.at[p]);
        store_rounded(-dot(n, on_it), columns_.at[p][3]);
    }

    const ShadowPlanesJob& job_;
    Wide3 center_;
    Wide3 toward_;
    Wide scale_;
    Wide weight_;
    Wide size_;  // bounds |v|
    double dense_;
    bool any_in_plane_ = false;
    alignas(64) double sides_[kBatch];
    RecordColumns columns_;  // by plane and component
};

void make_planes(const ShadowPlanesJob& job, const TriangleChunk& chunk) {
    PlanesMaker maker(job);
    chunk.for_each_batch([&](const TriangleBatch& batch, Slot first, std::size_t count)
                             HWY_ATTR { maker.make(batch, first, count); });
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void make_shadow_planes(const ShadowPlanesJob& job, const TriangleChunk& chunk,
                        InstructionSet isa) {
    if (!job.light.finite) {
        std::fill(job.out + chunk.first, job.out + chunk.last, ShadowPlanes{});
        std::fill(job.hides + chunk.first / 8, job.hides + (chunk.last + 7) / 8,
                  std::uint8_t{0xff});
        return;
    }
    (NUVO_FOR_ISA(isa, make_planes))(job, chunk);
}

}  // namespace nuvo
#endif
