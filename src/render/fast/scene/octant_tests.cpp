#include "fast/scene/octant_tests.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/scene/octant_tests.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Which of a voxel's eight octants 16 items touch. The point where the three planes meet is taken
// for the origin; then an octant reaches on each axis from 0 to one of the voxel's faces, a linear
// function has its extremes over the octants from two products an axis, and what one axis
// contributes serves four octants.
//
// All bounds hold for u = 2^-24. W is the largest coordinate of an item's points, H the largest of
// the voxel's faces, both seen from the new origin, which itself has coordinates up to O; T = H +
// W. A point carries its own rounding, u (O + W), and that of one subtraction, u W: e = u (O + 2 W)
// in all, so that what lies near the frame's origin is told apart as finely as floats are dense
// there. The faces are widened instead (see `Octants`). Counts below are of first order;
// kSecondOrder covers the rest and the bounds' own roundings, and the smallest normal number covers
// underflow.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

constexpr float kSecondOrder = 1.125F;
constexpr float kSmallest = 0x1p-126F;

// The voxel's faces as seen from the cut, widened by more than their rounding.
struct Octants {
    explicit Octants(const CutVoxel& voxel) {
        for (int axis = 0; axis < 3; ++axis) {
            const double cut = voxel.cut[axis];
            // Differences of floats in double: 2^-53; the conversion: u; the factor: 2 u or more.
            low[axis] = static_cast<float>((voxel.bounds.min[axis] - cut) * (1 + 0x1p-22));
            high[axis] = static_cast<float>((voxel.bounds.max[axis] - cut) * (1 + 0x1p-22));
            origin[axis] = voxel.cut[axis];
            reach = std::max(reach, std::max(-low[axis], high[axis]));
            farthest = std::max(farthest, std::fabs(origin[axis]));
        }
        reach += kSmallest;
        farthest += kSmallest;
    }
    float low[3];
    float high[3];
    float origin[3];
    float reach = 0;     // H
    float farthest = 0;  // O
};

// For each octant the lanes that do not touch it.
struct Cleared {
    RayMask octant[8];

    HWY_INLINE Cleared() {
        for (RayMask& mask : octant) mask = RayMask::from_bits(0);
    }
    // Keeps of masks[i] what is not cleared, for the first `count` lanes.
    HWY_INLINE void apply(std::uint8_t* masks, std::size_t count) const {
        Ints kept(0);
        for (int o = 0; o < 8; ++o)
            kept = kept + select(mask_for<std::int32_t>(octant[o]), Ints(0), Ints(1 << o));
        if (count == 16) {
            for (std::size_t i = 0; i < Ints::Shape::kParts; ++i) {
                std::uint8_t* const at = masks + i * Ints::Shape::kPart;
                const hn::FixedTag<std::uint8_t, Ints::Shape::kPart> bytes;
                hn::StoreU(hn::And(hn::LoadU(bytes, at), hn::DemoteTo(bytes, kept.part[i])), bytes,
                           at);
            }
            return;
        }
        std::int32_t lanes[16];
        kept.store(lanes);
        for (std::size_t i = 0; i < count; ++i)
            masks[i] = static_cast<std::uint8_t>(masks[i] & lanes[i]);
    }
};

// 16 of the items; the last one over again where there are fewer.
HWY_INLINE Ints load_items(std::span<const std::uint32_t> items, std::size_t begin,
                           std::uint32_t first, std::int32_t stride) {
    if (items.size() - begin >= 16)
        return (Ints::load(items.data() + begin) - Ints(first)) * Ints(stride);
    std::int32_t index[16];
    const std::size_t last = items.size() - 1;
    for (std::size_t i = 0; i < 16; ++i)
        index[i] = static_cast<std::int32_t>(items[std::min(begin + i, last)] - first) * stride;
    return Ints::load(index);
}

struct Corners {
    Floats at[3][3];    // [corner][axis]
    Floats edge[3][3];  // [from corner i to the next][axis]
    Floats widest;      // W
    Floats longest;     // E, the largest coordinate of an edge
};

HWY_INLINE Corners load_corners(const LocalTriangle* triangles, const Ints& offset,
                                const Octants& octants) {
    Corners c;
    c.widest = Floats(0.0F);
    c.longest = Floats(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 3; ++i) {
            c.at[i][axis] =
                Floats::gather(triangles->corner + 3 * i + axis, offset) - octants.origin[axis];
            c.widest = max(c.widest, abs(c.at[i][axis]));
        }
        for (int i = 0; i < 3; ++i) {
            c.edge[i][axis] = c.at[(i + 1) % 3][axis] - c.at[i][axis];
            c.longest = max(c.longest, abs(c.edge[i][axis]));
        }
    }
    return c;
}

// The triangle's plane: m . (p - w0), m = e0 x e1. An edge's error is 2 e + u E <= 2 e', with
// e' = u (O + 2 W + E); that of m 8 E e' + 4 u E^2; of the value 3 T (8 E e' + 4 u E^2), plus
// |m|_1 e <= 6 E^2 e, plus 6 roundings of terms of |m|_1 T in all <= 36 u E^2 T.
HWY_INLINE void clear_by_plane(const Corners& c, const Octants& octants, Cleared& cleared) {
    const Floats t = c.widest + octants.reach;
    const Floats e = c.widest + c.widest + c.longest + octants.farthest;
    const Floats bound =
        mul_add(c.longest * Floats(kSecondOrder * kFloatRoundoff),
                mul_add(Floats(24.0F) * t, e, Floats(6.0F) * c.longest * (e + Floats(8.0F) * t)),
                Floats(kSmallest));
    Floats least[3][2];
    Floats most[3][2];
    Floats offset(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        const int j = (axis + 1) % 3;
        const int k = (axis + 2) % 3;
        const Floats m = neg_mul_add(c.edge[0][k], c.edge[1][j], c.edge[0][j] * c.edge[1][k]);
        const Floats face[2] = {m * octants.low[axis], m * octants.high[axis]};
        for (int side = 0; side < 2; ++side) {
            least[axis][side] = min(face[side], Floats(0.0F));
            most[axis][side] = max(face[side], Floats(0.0F));
        }
        offset = neg_mul_add(m, c.at[0][axis], offset);
    }
    for (unsigned o = 0; o < 8; ++o) {
        const unsigned x = o & 1;
        const unsigned y = o >> 1 & 1;
        const unsigned z = o >> 2;
        const Floats low = least[0][x] + least[1][y] + least[2][z];
        const Floats high = most[0][x] + most[1][y] + most[2][z];
        cleared.octant[o] = cleared.octant[o] | (low + offset > bound) | (high + offset < -bound);
    }
}

// The projection along one axis onto axes a and b: an octant is cleared if it lies beyond an edge,
// on the side where the third corner is not. With n the edge's normal the value at p is
// n . (p - w): its error is 2 T (2 e + u E), plus 2 E e, plus 5 roundings of terms of 2 E T in all;
// and as the side of the third corner is found with an error of 8 E e + 10 u E^2, this is added.
HWY_INLINE void clear_by_projection(const Corners& c, const Octants& octants, int a, int b,
                                    Cleared& cleared) {
    const Floats t = c.widest + octants.reach;
    const Floats e = c.widest + c.widest + octants.farthest;
    const Floats size = c.longest;
    const Floats bound = mul_add(
        Floats(kSecondOrder * kFloatRoundoff),
        mul_add(Floats(4.0F) * t, e, Floats(12.0F) * size * (e + size + t)), Floats(kSmallest));
    const Floats turn = neg_mul_add(c.edge[0][b], c.edge[1][a], c.edge[0][a] * c.edge[1][b]);
    const Floats sign = select(turn < Floats(0.0F), Floats(-1.0F), Floats(1.0F));
    const Floats zero(0.0F);
    RayMask beyond[4];
    for (int i = 0; i < 3; ++i) {
        const Floats na = -(c.edge[i][b] * sign);
        const Floats nb = c.edge[i][a] * sign;
        const Floats offset = neg_mul_add(na, c.at[i][a], neg_mul_add(nb, c.at[i][b], bound));
        const Floats reach_a[2] = {max(na * octants.low[a], zero) + offset,
                                   max(na * octants.high[a], zero) + offset};
        const Floats reach_b[2] = {max(nb * octants.low[b], zero), max(nb * octants.high[b], zero)};
        for (int q = 0; q < 4; ++q) {
            const RayMask outside = reach_a[q & 1] + reach_b[q >> 1] < zero;
            beyond[q] = i == 0 ? outside : beyond[q] | outside;
        }
    }
    for (int o = 0; o < 8; ++o)
        cleared.octant[o] = cleared.octant[o] | beyond[(o >> a & 1) | (o >> b & 1) << 1];
}

void clear_triangles(const LocalTriangle* triangles, const CutVoxel& voxel,
                     std::span<const std::uint32_t> items, std::uint8_t* masks) {
    const Octants octants(voxel);
    for (std::size_t begin = 0; begin < items.size(); begin += 16) {
        const Corners c = load_corners(triangles, load_items(items, begin, 0, 9), octants);
        Cleared cleared;
        clear_by_plane(c, octants, cleared);
        clear_by_projection(c, octants, 0, 1, cleared);
        clear_by_projection(c, octants, 1, 2, cleared);
        clear_by_projection(c, octants, 2, 0, cleared);
        cleared.apply(masks + begin, std::min<std::size_t>(16, items.size() - begin));
    }
}

// Squared distances of an octant's nearest and farthest point from the centre against the squared
// radius. A distance on an axis has the error e + u (W + H) of its subtraction, added or taken off;
// the radius has its rounding, u; 16 u covers the roundings of squares and sums, and of the
// widened radius.
void clear_spheres(const LocalSphere* spheres, std::uint32_t first, const CutVoxel& voxel,
                   std::span<const std::uint32_t> items, std::uint8_t* masks) {
    const Octants octants(voxel);
    const Floats zero(0.0F);
    for (std::size_t begin = 0; begin < items.size(); begin += 16) {
        const Ints offset = load_items(items, begin, first, 4);
        Floats center[3];
        Floats widest(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            center[axis] = Floats::gather(&spheres->center.x + axis, offset) - octants.origin[axis];
            widest = max(widest, abs(center[axis]));
        }
        const Floats radius = Floats::gather(&spheres->radius, offset);
        const Floats error = mul_add(Floats(kSecondOrder * kFloatRoundoff),
                                     widest + widest + widest + (octants.farthest + octants.reach),
                                     Floats(kSmallest));
        Floats near[3][2];
        Floats far[3][2];
        for (int axis = 0; axis < 3; ++axis) {
            const Floats to_low = octants.low[axis] - center[axis];
            const Floats to_high = center[axis] - octants.high[axis];
            const Floats above = max(to_low, center[axis]) - error;
            const Floats below = max(to_high, -center[axis]) - error;
            near[axis][0] = max(above, zero);
            near[axis][1] = max(below, zero);
            far[axis][0] = max(abs(to_low), abs(center[axis])) + error;
            far[axis][1] = max(abs(to_high), abs(center[axis])) + error;
            for (int side = 0; side < 2; ++side) {
                near[axis][side] = near[axis][side] * near[axis][side];
                far[axis][side] = far[axis][side] * far[axis][side];
            }
        }
        const Floats outer = mul_add(radius, Floats(roundings(2)), radius) + kSmallest;
        const Floats inner =
            max(neg_mul_add(radius, Floats(roundings(2)), radius) - kSmallest, zero);
        const Floats most = mul_add(outer * outer, Floats(1 + roundings(16)), Floats(kSmallest));
        const Floats least = mul_add(inner * inner, Floats(1 - roundings(16)), Floats(-kSmallest));
        Cleared cleared;
        for (unsigned o = 0; o < 8; ++o) {
            const unsigned x = o & 1;
            const unsigned y = o >> 1 & 1;
            const unsigned z = o >> 2;
            cleared.octant[o] = (near[0][x] + near[1][y] + near[2][z] > most) |
                                (far[0][x] + far[1][y] + far[2][z] < least);
        }
        cleared.apply(masks + begin, std::min<std::size_t>(16, items.size() - begin));
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void clear_octants(std::span<const LocalTriangle> triangles, const CutVoxel& voxel,
                   std::span<const std::uint32_t> items, std::span<std::uint8_t> masks) {
    static const auto kernel = NUVO_FOR_ISA(resolved(InstructionSet::kBest), clear_triangles);
    kernel(triangles.data(), voxel, items, masks.data());
}

void clear_octants(std::span<const LocalSphere> spheres, std::uint32_t first, const CutVoxel& voxel,
                   std::span<const std::uint32_t> items, std::span<std::uint8_t> masks) {
    static const auto kernel = NUVO_FOR_ISA(resolved(InstructionSet::kBest), clear_spheres);
    kernel(spheres.data(), first, voxel, items, masks.data());
}

}  // namespace nuvo
#endif
