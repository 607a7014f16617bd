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
#include "fast/simd/lanes.h"

// 16 rays prepared at once: what LocalRay is, side by side.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class RayBlock {
  public:
    static constexpr std::size_t kRays = 16;

    /// The first 16 of the rays, or all.
    HWY_NOINLINE void prepare(std::span<const Ray> rays, const LocalFrame& frame, float reach) {
        for (std::size_t i = 0; i < kRays; ++i) {
            const Ray& ray = rays[std::min(i, rays.size() - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis][i] = ray.origin[axis];
                step[axis][i] = ray.direction[axis];
            }
        }
        if (prepare_near(frame, reach)) return;
        for (std::size_t i = 0; i < kRays; ++i)
            put(LocalRay(rays[std::min(i, rays.size() - 1)], frame, reach), i);
    }

    // Fields of LocalRay.
    alignas(64) float inverse[3][kRays];
    float near_add[3][kRays];
    float far_add[3][kRays];
    std::int32_t signs[kRays];
    float behind[kRays];
    float least_unit[kRays];
    float direction[3][kRays];
    float square[kRays];
    float error[kRays];
    alignas(64) double origin[3][kRays];
    double step[3][kRays];
    std::uint32_t valid;  ///< one bit each

  private:
    // True if all rays are as usual: a direction of which float exponents are enough, an origin not
    // far from the box. The same as LocalRay does, but for roundings that its bounds allow.
    HWY_INLINE bool prepare_near(const LocalFrame& frame, float reach_of_boxes) {
        const Doubles scale(frame.scale);
        Doubles o[3];
        Doubles d[3];
        Doubles far(0.0);
        Doubles size(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            o[axis] = (Doubles::load(origin[axis]) - Doubles(frame.center[axis])) * scale;
            d[axis] = Doubles::load(step[axis]);
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
        const Floats error_bound = floats_from((far + Doubles(4.0)) * Doubles(0x1p-49));
        Floats squares(0.0F);
        Floats margin(0.0F);
        Ints sign_bits(0);
        for (int axis = 0; axis < 3; ++axis) {
            const Doubles along = d[axis] * unit;
            const Floats along_float = floats_from(along);
            const Floats away = floats_from(abs(o[axis]));
            const Ints sign = shift_right<31>(bits_of(along_float));
            const Floats size_on_axis = max(abs(along_float), Floats(LocalRay::kLeastDirection));
            const Floats i = Floats(1.0F) / size_on_axis;
            const Floats signed_i = floats_of(bits_of(i) | (sign & Ints(kSignBit)));
            const Floats slack =
                mul_add(away + Floats(reach_of_boxes), Floats(kSlack), error_bound);
            const Doubles at = o[axis] * doubles_from(signed_i);
            const Floats slack_of_s = slack * i;
            const Floats add = floats_from(-at);
            signed_i.store(inverse[axis]);
            (add - slack_of_s).store(near_add[axis]);
            (add + slack_of_s).store(far_add[axis]);
            along_float.store(direction[axis]);
            o[axis].store(origin[axis]);
            along.store(step[axis]);
            sign_bits = sign_bits | (sign & Ints(1 << axis));
            squares = mul_add(along_float, along_float, squares);
            margin = max(margin, slack);
        }
        sign_bits.store(signs);
        Floats(0.0F).store(behind);
        squares.store(square);
        error_bound.store(error);
        max(margin * Floats(0x1p-13F), error_bound * Floats(0x1p6F)).store(least_unit);
        valid = 0xffff;
        return true;
    }
    // Two roundings of the sum and one of the product more than LocalRay has: u |o i| + 2 u slack.
    static constexpr float kSlack = static_cast<float>(kSlabRoundings + 2) * kFloatRoundoff;
    static constexpr std::int32_t kSignBit = std::numeric_limits<std::int32_t>::min();

    void put(const LocalRay& ray, std::size_t i) {
        if (i == 0) valid = 0;
        valid |= ray.valid ? 1U << i : 0U;
        if (!ray.valid) return;
        for (int axis = 0; axis < 3; ++axis) {
            inverse[axis][i] = ray.inverse[axis];
            near_add[axis][i] = ray.near_add[axis];
            far_add[axis][i] = ray.far_add[axis];
            direction[axis][i] = ray.direction[axis];
            origin[axis][i] = ray.origin[axis];
            step[axis][i] = ray.step[axis];
        }
        signs[i] = static_cast<std::int32_t>(ray.signs);
        behind[i] = ray.behind;
        least_unit[i] = ray.least_unit;
        square[i] = ray.square;
        error[i] = static_cast<float>(ray.error);
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_RAY_BLOCK_H_
