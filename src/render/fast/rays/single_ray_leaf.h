// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SINGLE_RAY_LEAF_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SINGLE_RAY_LEAF_H_
#undef NUVO_RENDER_FAST_SINGLE_RAY_LEAF_H_
#else
#define NUVO_RENDER_FAST_SINGLE_RAY_LEAF_H_
#endif

#include <limits>

#include "fast/rays/ray_state.h"
#include "fast/rays/wide_bvh.h"
#include "fast/simd/vector_lanes.h"
#include "nuvo/math/error_bounds.h"

// One ray against 8 or 16 primitives of a leaf. The ray is seen from the point where it enters the
// leaf's box, in units of the leaf's grid on each axis, so that all numbers are small whatever the
// distance, and flat leaves keep their digits.
//
// Bounds, with u = 2^-24 and M = kReach the largest difference of two coordinates there: the box is
// at most 2^16 units wide and the point within 2^14 of it (RayLanes: least_unit). A corner seen
// from the point is off by at most e = kCorner on each axis: its copy kCornerRounding, the point
// 2^-6 for its error and 2 u M for two roundings of it, the difference u M: less than 0.53.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

inline constexpr float kReach = 0x1p16F + 0x1p14F;
inline constexpr float kCorner = 0.5625F;
static_assert(kCornerRounding + 0x1p-6 + roundings(4) * kReach < kCorner);

/// What is known of N primitives: [low, high] bounds the hit's parameter where it is met.
template <std::size_t N>
struct LeafHits {
    LaneMask<float, N> sure;
    LaneMask<float, N> open;  ///< neither surely met nor surely missed
    Lanes<float, N> low;
    Lanes<float, N> high;
};

template <std::size_t N>
using LeafVector = VectorLanes<float, N>;

/// The first `count` of N lanes, or all.
template <std::size_t N>
HWY_INLINE std::uint32_t first_lanes(std::uint32_t count) {
    return (1U << (count < N ? count : N)) - 1;
}

/// A ray at one leaf.
struct RayAtLeaf {
    HWY_INLINE RayAtLeaf(const RayLanes& rays, std::size_t lane, const WideLeafHead& head,
                         float entry_at)
        : behind(rays.behind(lane)),
          square(rays.square(lane)),
          point_error(rays.error(lane)),
          entry(entry_at) {
        using Four = Lanes<float, 4>;
        using FourDoubles = Lanes<double, 4>;
        const Four inverse_unit = powers_of_two(-Lanes<std::int32_t, 4>::from_bytes(head.exponent));
        const FourDoubles p =
            FourDoubles::load(rays.origin[lane]) +
            FourDoubles(static_cast<double>(entry)) * FourDoubles::load(rays.step[lane]);
        floats_from(p).store(from);
        floats_from((p - doubles_from(Four::load(head.base))) * doubles_from(inverse_unit))
            .store(at);
        const Four d = Four::load(rays.direction[lane]);
        d.store(direction);
        (d * inverse_unit).store(step);
        step_sum = (std::fabs(step[0]) + std::fabs(step[1]) + std::fabs(step[2])) * (1 + 0x1p-20F);
    }
    /// Bounds on s from `along`, known within `error`.
    template <std::size_t N>
    HWY_INLINE void set_interval(LeafHits<N>& hits, const Lanes<float, N>& along,
                                 const Lanes<float, N>& error) const {
        using LeafFloats = Lanes<float, N>;
        // A sum, and the sums here: less than 4 roundings.
        const LeafFloats s = along + LeafFloats(entry);
        const LeafFloats slack =
            mul_add(abs(s) + LeafFloats(entry), LeafFloats(roundings(4)), error);
        hits.low = s - slack;
        hits.high = s + slack;
    }

    alignas(16) float direction[4];  ///< here and below the fourth is unused
    float step[4];                   ///< the direction in units of the leaf's grid
    float from[4];                   ///< the point of entry, local
    float at[4];                     ///< the same on the leaf's grid
    float step_sum;                  ///< bounds |step.x| + |step.y| + |step.z|
    float behind;                    ///< these three: as in LocalRay
    float square;
    float point_error;
    float entry;
};

/// N corners of the leaf's triangles, seen from the ray's point.
template <std::size_t N>
HWY_INLINE LeafVector<N> load_corner(const std::uint16_t* corners, std::size_t stride, int corner,
                                     const RayAtLeaf& ray) {
    using LeafFloats = Lanes<float, N>;
    const std::uint16_t* const x = corners + static_cast<std::size_t>(3 * corner) * stride;
    return {LeafFloats::from_shorts(x) - LeafFloats(ray.at[0]),
            LeafFloats::from_shorts(x + stride) - LeafFloats(ray.at[1]),
            LeafFloats::from_shorts(x + 2 * stride) - LeafFloats(ray.at[2])};
}

/// Which of N slots of a leaf have a back that is invisible.
template <std::size_t N>
HWY_INLINE LaneMask<float, N> front_only(const Slot* slots) {
    using LeafInts = Lanes<std::int32_t, N>;
    return mask_for<float>(LeafInts::load(slots) < LeafInts(0));
}

/// Triangles whose nine coordinates stand `stride` apart from `corners` on. The sum of the edge
/// functions is -n.d: of a front all are positive.
///
/// Edge functions d . (q x p) of two corners: p and q off by e move it by |d|_1 (2 e (|p| + |q|) +
/// 2 e^2), and 8 roundings of six terms |d|_1 M^2 / 3 and one of d add less than 18 u |d|_1 M^2.
/// The plane: an edge vector is off by 2 e + 2 u M < 2.125 e, a component of the normal n by less
/// than k = 2 * 2.125 e (|e1| + |e2|) + 2 (2.125 e)^2 + 4 u |e1| |e2| < 9 e (L + e) for L =
/// max(|e1|, |e2|), L <= M; d . n by k |d|_1 and n . a by k |a|_1 + e |n|_1, with three roundings
/// more of the terms, which the ninth e covers (9 instead of 8.5; 4 u M^2 < 0.02 e M).
template <std::size_t N>
HWY_INLINE LeafHits<N> test_triangles(const RayAtLeaf& ray, const std::uint16_t* corners,
                                      std::size_t stride, const LaneMask<float, N>& front) {
    using LeafFloats = Lanes<float, N>;
    using LeafMask = LaneMask<float, N>;
    const LeafVector<N> a = load_corner<N>(corners, stride, 0, ray);
    const LeafVector<N> b = load_corner<N>(corners, stride, 1, ray);
    const LeafVector<N> c = load_corner<N>(corners, stride, 2, ray);
    const auto d = LeafVector<N>::all({ray.step[0], ray.step[1], ray.step[2]});
    const LeafVector<N> dc = fused_cross(d, c);
    const LeafFloats u = fused_dot(b, dc);
    const LeafFloats v = -fused_dot(a, dc);
    const LeafFloats w = fused_dot(a, fused_cross(d, b));
    constexpr float kEdge =
        4 * kCorner * kReach + 2 * kCorner * kCorner + roundings(18) * kReach * kReach;
    const LeafFloats edge_error(kEdge * (1 + roundings(8)) * ray.step_sum);
    const LeafFloats least = min(u, min(v, w));
    const LeafFloats most = max(u, max(v, w));
    const LeafMask inside = (least > edge_error) | without(most < -edge_error, front);
    const LeafMask outside = (least < -edge_error) & ((most > edge_error) | front);
    const LeafVector<N> e1 = b - a;
    const LeafVector<N> e2 = c - a;
    const LeafVector<N> n = fused_cross(e1, e2);
    const LeafFloats height = fused_dot(n, a);
    const LeafFloats slope = fused_dot(n, d);
    const LeafFloats k =
        (max(max_norm(e1), max_norm(e2)) + LeafFloats(kCorner)) * LeafFloats(9 * kCorner);
    const LeafFloats height_error = mul_add(k, norm1(a), norm1(n) * LeafFloats(kCorner));
    const LeafFloats slope_error = k * LeafFloats(ray.step_sum);
    const LeafFloats inverse = LeafFloats(1.0F) / slope;
    const LeafFloats along = height * inverse;
    // 1 / (1 - share) <= 1 + 2 share for a share of at most 1/2.
    const LeafFloats share = slope_error * abs(inverse);
    const LeafMask crossing = share < LeafFloats(0.5F);
    // Room for the roundings of the bound itself, and of the product above.
    const LeafFloats error = mul_add(abs(along), slope_error, height_error) * abs(inverse) *
                                 mul_add(share, LeafFloats(2.0F), LeafFloats(1 + roundings(16))) +
                             abs(along) * LeafFloats(roundings(4));
    LeafHits<N> hits;
    ray.set_interval(hits, along, error);
    hits.low = select(crossing, hits.low, LeafFloats(-kFloatInfinity));
    hits.high = select(crossing, hits.high, LeafFloats(kFloatInfinity));
    hits.sure = inside & crossing;
    hits.open = without(~outside, hits.sure);
    return hits;
}

/// Spheres whose centers and radii stand `stride` apart, in the local frame, off by u on each
/// axis and by u r.
///
/// f = p - c is off by e = 3 u (p and c, at most 1.01 each, and the difference) + 2 u |f|. What is
/// left of it across d, l = f - (f.d / d.d) d, is off by e and 16 roundings of |f| <= 16 u |f|; l.l
/// by 2 |l| that + that^2.
template <std::size_t N>
HWY_INLINE LeafHits<N> test_spheres(const RayAtLeaf& ray, const float* values, std::size_t stride,
                                    std::uint32_t count, const LaneMask<float, N>& front) {
    using LeafFloats = Lanes<float, N>;
    using LeafMask = LaneMask<float, N>;
    // What stands behind a leaf is not to be taken for a float: it may be a slow, subnormal one.
    const LeafMask present = LeafMask::from_bits(first_lanes<N>(count));
    const LeafVector<N> f = {
        LeafFloats(ray.from[0]) - LeafFloats::load(values, present),
        LeafFloats(ray.from[1]) - LeafFloats::load(values + stride, present),
        LeafFloats(ray.from[2]) - LeafFloats::load(values + 2 * stride, present)};
    const LeafFloats r = LeafFloats::load(values + 3 * stride, present);
    const auto d = LeafVector<N>::all({ray.direction[0], ray.direction[1], ray.direction[2]});
    const LeafFloats inverse(1 / ray.square);
    const LeafFloats middle = -fused_dot(f, d) * inverse;
    const LeafVector<N> l = mul_add(d, middle, f);
    const LeafFloats across = fused_dot(l, l);
    const LeafFloats depth = mul_add(r, r, -across);
    const LeafFloats error =
        mul_add(norm1(f), LeafFloats(roundings(32)), LeafFloats(roundings(8) + ray.point_error));
    const LeafFloats depth_error =
        mul_add(mul_add(norm1(l), LeafFloats(2.0F), error * LeafFloats(3.0F)), error,
                mul_add(r, r, across) * LeafFloats(roundings(16)));
    const LeafMask meets = depth > depth_error;
    const LeafMask misses = depth < -depth_error;
    const LeafFloats half = sqrt(max(depth, LeafFloats(0.0F)) * inverse);
    // sqrt(depth +- error) differs by less than error / sqrt(depth), and where it may not be met by
    // less than sqrt(2 error); |d| >= 1.
    const LeafFloats least(std::numeric_limits<float>::min());
    const LeafFloats most_error = depth_error + depth_error;
    const LeafFloats half_error =
        select(meets, depth_error * inverse, most_error) *
            above_inverse_sqrt(max(select(meets, depth * inverse, most_error), least)) +
        half * LeafFloats(roundings(8));
    const LeafFloats slack =
        half_error + error +
        (abs(middle) + LeafFloats(ray.entry) + half) * LeafFloats(roundings(8));
    const LeafFloats near = LeafFloats(ray.entry) + (middle - half);
    const LeafFloats far = LeafFloats(ray.entry) + (middle + half);
    const LeafFloats behind(ray.behind);
    const LeafMask near_ahead = near - slack > behind;
    const LeafMask near_behind = near + slack < behind;
    const LeafMask far_ahead = far - slack > behind;
    LeafHits<N> hits;
    hits.low = select(near_behind, far - slack, near - slack);
    hits.high = select(near_ahead, near + slack, far + slack);
    hits.sure = meets & (near_ahead | without(near_behind & far_ahead, front));
    hits.open = without(without(~misses, hits.sure), near_behind & front);
    return hits;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SINGLE_RAY_LEAF_H_
