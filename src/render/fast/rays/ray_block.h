// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_RAY_BLOCK_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_RAY_BLOCK_H_
#undef NUVO_RENDER_FAST_RAY_BLOCK_H_
#else
#define NUVO_RENDER_FAST_RAY_BLOCK_H_
#endif

#include <algorithm>
#include <span>

#include "fast/rays/local_ray.h"
#include "fast/rays/ray_state.h"
#include "fast/simd/lanes.h"

// 16 rays prepared at once: what LocalRay is, side by side.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class RayBlock {
  public:
    /// The first 16 of the rays, or all.
    HWY_NOINLINE void prepare(std::span<const Ray> rays, const LocalFrame& frame, float reach) {
        if (prepare_near(rays, frame, reach)) return;
        valid = 0;
        for (std::size_t i = 0; i < RayLanes::kRays; ++i)
            put(LocalRay(rays[std::min(i, rays.size() - 1)], frame, reach), i);
    }

    RayLanes lanes;
    std::uint32_t valid;  ///< one bit each

  private:
    // True if all rays are as usual: a direction of which float exponents are enough, an origin not
    // far from the box. The same as LocalRay does, but for roundings that its bounds allow.
    HWY_INLINE bool prepare_near(std::span<const Ray> rays, const LocalFrame& frame,
                                 float reach_of_boxes) {
        alignas(64) double origins[3][RayLanes::kRays];
        alignas(64) double steps[3][RayLanes::kRays];
        for (std::size_t i = 0; i < RayLanes::kRays; ++i) {
            const Ray& ray = rays[std::min(i, rays.size() - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                origins[axis][i] = ray.origin[axis];
                steps[axis][i] = ray.direction[axis];
            }
        }
        const Doubles scale(frame.scale);
        Doubles o[3];
        Doubles d[3];
        Doubles far(0.0);
        Doubles size(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            o[axis] = (Doubles::load(origins[axis]) - Doubles(frame.center[axis])) * scale;
            d[axis] = Doubles::load(steps[axis]);
            far = max(far, abs(o[axis]));
            size = max(size, abs(d[axis]));
        }
        constexpr float kUsual = 0x1p100F;
        const Floats float_size = floats_from(size);
        const RayMask usual = (float_size > Floats(1 / kUsual)) & (float_size < Floats(kUsual)) &
                              (floats_from(far) <= Floats(3.5F));
        if ((~usual).any()) return false;
        // 2^-e for 2^e <= size: |d| is in [1, 2), or rounded to float it is 2.
        const Ints exponent = shift_right<23>(bits_of(float_size));
        const Doubles unit = doubles_from(floats_of(shift_left<23>(Ints(254) - exponent)));
        const Floats error = floats_from((far + Doubles(4.0)) * Doubles(0x1p-49));
        Floats direction[3];
        Floats inverse[3];
        Floats near_add[3];
        Floats far_add[3];
        Floats square(0.0F);
        Floats margin(0.0F);
        Ints signs(0);
        for (int axis = 0; axis < 3; ++axis) {
            d[axis] = d[axis] * unit;
            direction[axis] = floats_from(d[axis]);
            const Floats away = floats_from(abs(o[axis]));
            const Ints sign = shift_right<31>(bits_of(direction[axis]));
            const Floats size_on_axis =
                max(abs(direction[axis]), Floats(LocalRay::kLeastDirection));
            const Floats i = Floats(1.0F) / size_on_axis;
            inverse[axis] = floats_of(bits_of(i) | (sign & Ints(kSignBit)));
            const Floats slack = mul_add(away + Floats(reach_of_boxes), Floats(kSlack), error);
            const Floats slack_of_s = slack * i;
            const Floats add = floats_from(-(o[axis] * doubles_from(inverse[axis])));
            near_add[axis] = add - slack_of_s;
            far_add[axis] = add + slack_of_s;
            signs = signs | (sign & Ints(1 << axis));
            square = mul_add(direction[axis], direction[axis], square);
            margin = max(margin, slack);
        }
        const Floats least_unit = max(margin * Floats(0x1p-13F), error * Floats(0x1p6F));
        const auto store = [](const auto(&v)[3], const auto& fourth, auto(&to)[RayLanes::kRays][4])
                               HWY_ATTR { store_by_fours(v[0], v[1], v[2], fourth, to[0]); };
        store(inverse, Floats(0.0F), lanes.inverse);
        store(near_add, square, lanes.near_add);
        store(far_add, error, lanes.far_add);
        store(direction, least_unit, lanes.direction);
        store(o, Doubles(0.0), lanes.origin);
        store(d, Doubles(0.0), lanes.step);
        signs.store(lanes.signs);
        valid = 0xffff;
        return true;
    }
    // Two roundings of the sum and one of the product more than LocalRay has: u |o i| + 2 u slack.
    static constexpr float kSlack = static_cast<float>(kSlabRoundings + 2) * kFloatRoundoff;
    static constexpr std::int32_t kSignBit = std::numeric_limits<std::int32_t>::min();

    void put(const LocalRay& ray, std::size_t i) {
        if (!ray.valid) return;
        valid |= 1U << i;
        const auto store = [i](const auto(&v)[3], auto fourth, auto(&to)[RayLanes::kRays][4]) {
            std::copy(v, v + 3, to[i]);
            to[i][3] = fourth;
        };
        store(ray.inverse, ray.behind, lanes.inverse);
        store(ray.near_add, ray.square, lanes.near_add);
        store(ray.far_add, static_cast<float>(ray.error), lanes.far_add);
        store(ray.direction, ray.least_unit, lanes.direction);
        store(ray.origin, 0.0, lanes.origin);
        store(ray.step, 0.0, lanes.step);
        lanes.signs[i] = static_cast<std::int32_t>(ray.signs);
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_RAY_BLOCK_H_
