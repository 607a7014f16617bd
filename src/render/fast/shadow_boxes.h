// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_BOXES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_BOXES_H_
#undef NUVO_RENDER_FAST_SHADOW_BOXES_H_
#else
#define NUVO_RENDER_FAST_SHADOW_BOXES_H_
#endif

#include "lanes.h"
#include "shadow_lanes.h"

// Boxes around groups of points, one group a lane: what holds for the middle by more than the box'
// half holds for all of its points.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The boxes of up to 16 groups of points.
struct GroupBoxes {
    /// Of each packet, or, of up to four packets, of each four points.
    HWY_INLINE GroupBoxes(const Points* packets, int count, bool by_fours) {
        alignas(64) float low[3][kRoom];
        alignas(64) float high[3][kRoom];
        for (int p = 0; p < count; ++p) {
            put(packets[p].x, low[0] + 4 * p, high[0] + 4 * p);
            put(packets[p].y, low[1] + 4 * p, high[1] + 4 * p);
            put(packets[p].z, low[2] + 4 * p, high[2] + 4 * p);
        }
        if (!by_fours)
            for (int axis = 0; axis < 3; ++axis) gather(low[axis], high[axis], count);
        Floats* const middle[3] = {&center.x, &center.y, &center.z};
        Floats square(0.0F);
        half = Floats(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats lower = Floats::load(low[axis]);
            const Floats upper = Floats::load(high[axis]);
            *middle[axis] = (lower + upper) * Floats(0.5F);
            // The middle has one rounding, the difference another.
            const Floats h = mul_add(upper - lower, Floats(0.5F * (1 + 4 * kRoundoff)),
                                     max(abs(lower), abs(upper)) * Floats(2 * kRoundoff));
            half = max(half, h);
            square = mul_add(h, h, square);
        }
        radius = sqrt(square) * Floats(1 + 8 * kRoundoff);
    }

    Points center;
    Floats half;    ///< the largest distance from the center on one axis
    Floats radius;  ///< the largest distance

  private:
    static constexpr float kRoundoff = 0x1p-24F;
    static constexpr int kRoom = 4 * 16 + 16;  // compressing writes whole registers

    static HWY_INLINE void put(const Floats& v, float* low, float* high) {
        const RayMask fours = RayMask::from_bits(0x1111);
        lowest_of_fours(v).compress_store(low, fours);
        highest_of_fours(v).compress_store(high, fours);
    }
    // From fours to packets.
    static HWY_INLINE void gather(float* low, float* high, int packets) {
        const RayMask fours = RayMask::from_bits(0x1111);
        for (int p = 0; p < packets; p += 4) {
            const Floats lower = lowest_of_fours(Floats::load(low + 4 * p));
            const Floats upper = highest_of_fours(Floats::load(high + 4 * p));
            lower.compress_store(low + p, fours);
            upper.compress_store(high + p, fours);
        }
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_BOXES_H_
