// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_RAY_BLOCK_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_RAY_BLOCK_H_
#undef NUVO_RENDER_FAST_RAY_BLOCK_H_
#else
#define NUVO_RENDER_FAST_RAY_BLOCK_H_
#endif

#include <algorithm>
#include <span>

#include "fast/rays/ray_state.h"
#include "fast/simd/lanes.h"
#include "fast/simd/prefetch.h"
#include "fast/tile/local_ray.h"
#include "nuvo/math/error_bounds.h"

// 16 rays prepared at once for float walks.
//
// The plane x = c is met at s = (c - o) / d. The walk computes fl(c i + a) with i = fl(1 / fl(d))
// and a = fl(-o i): i is off by 2 u + u^2 relatively and the sum by at most three roundings of
// |c i| + |o i|, so that s is off by less than 6 u (|c| + |o|) |i| + error |i| (u = 2^-24). a is
// made smaller for near faces and larger for far ones by `kSlabRoundings` instead of 6, for this
// rounds, too. [numerics: local frame]

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class RayBlock {
  public:
    /// The first 16 of the rays; of fewer the last one again and again.
    HWY_NOINLINE void prepare(std::span<const Ray> rays, const LocalFrame& frame, float reach) {
        // The next 16 are prepared when these are under way.
        if (rays.size() >= 2 * RayLanes::kRays)
            prefetch_lines(&rays[RayLanes::kRays], RayLanes::kRays * sizeof(Ray));
        if (!prepare_near(rays, frame, reach)) prepare_far(rays, frame, reach);
    }

    RayLanes lanes;
    std::uint32_t valid;  ///< one bit each

  private:
    static constexpr float kSlabRoundings = 10;
    static constexpr float kSlack = roundings(kSlabRoundings);
    static constexpr std::int32_t kSignBit = std::numeric_limits<std::int32_t>::min();
    // Components of d are kept off 0 by this; s d stays as near to the ray as slabs are wide.
    static constexpr float kLeastDirection = 0x1p-60F;

    // What LocalRay is, of 16.
    struct Local {
        Doubles origin[3];
        Doubles step[3];
        Doubles advance;
        Doubles scale;
        Floats error;
        Floats behind;
    };

    // True if all rays are as usual: a direction of which float exponents are enough, an origin not
    // far from the box. The same as LocalRay does, but for roundings that its bounds allow, and the
    // exponent of a direction that floats round up to a power of two.
    HWY_INLINE bool prepare_near(std::span<const Ray> rays, const LocalFrame& frame, float reach) {
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
        Local local;
        Doubles far(0.0);
        Doubles size(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            local.origin[axis] =
                (Doubles::load(origins[axis]) - Doubles(frame.center[axis])) * scale;
            local.step[axis] = Doubles::load(steps[axis]);
            far = max(far, abs(local.origin[axis]));
            size = max(size, abs(local.step[axis]));
        }
        constexpr float kUsual = 0x1p100F;
        const Floats float_size = floats_from(size);
        const RayMask usual = (float_size > Floats(1 / kUsual)) & (float_size < Floats(kUsual)) &
                              (floats_from(far) <= Floats(3.5F));
        if ((~usual).any()) return false;
        // 2^-e for 2^e <= size: |d| is in [1, 2), or rounded to float it is 2.
        const Ints exponent = shift_right<23>(bits_of(float_size)) - Ints(127);
        const Doubles unit = doubles_from(powers_of_two(-exponent));
        for (Doubles& step : local.step) step = step * unit;
        local.advance = Doubles(0.0);
        local.scale = scale / unit;
        local.error = floats_from((far + Doubles(4.0)) * Doubles(0x1p-49));
        local.behind = Floats(0.0F);
        prepare_slabs(local, reach);
        valid = 0xffff;
        return true;
    }
    // Ray by ray.
    HWY_NOINLINE void prepare_far(std::span<const Ray> rays, const LocalFrame& frame, float reach) {
        alignas(64) double origins[3][RayLanes::kRays] = {};
        alignas(64) double steps[3][RayLanes::kRays] = {};
        alignas(64) double advances[RayLanes::kRays] = {};
        alignas(64) double scales[RayLanes::kRays] = {};
        alignas(64) float errors[RayLanes::kRays] = {};
        alignas(64) float behind[RayLanes::kRays] = {};
        valid = 0;
        for (std::size_t i = 0; i < RayLanes::kRays; ++i) {
            const LocalRay ray(rays[std::min(i, rays.size() - 1)], frame, reach);
            if (!ray.valid) continue;
            valid |= 1U << i;
            for (int axis = 0; axis < 3; ++axis) {
                origins[axis][i] = ray.origin[axis];
                steps[axis][i] = ray.step[axis];
            }
            advances[i] = ray.advance;
            scales[i] = ray.scale;
            // Twice, so that the slabs' roundings of it are made up for.
            errors[i] = static_cast<float>(2 * ray.error);
            behind[i] = ray.behind;
        }
        Local local;
        for (int axis = 0; axis < 3; ++axis) {
            local.origin[axis] = Doubles::load(origins[axis]);
            local.step[axis] = Doubles::load(steps[axis]);
        }
        local.advance = Doubles::load(advances);
        local.scale = Doubles::load(scales);
        local.error = Floats::load(errors);
        local.behind = Floats::load(behind);
        prepare_slabs(local, reach);
    }

    HWY_INLINE void prepare_slabs(const Local& ray, float reach) {
        Floats direction[3];
        Floats inverse[3];
        Floats near_add[3];
        Floats far_add[3];
        Floats square(0.0F);
        Floats margin(0.0F);
        Ints signs(0);
        for (int axis = 0; axis < 3; ++axis) {
            direction[axis] = floats_from(ray.step[axis]);
            const Floats away = floats_from(abs(ray.origin[axis]));
            const Ints sign = shift_right<31>(bits_of(direction[axis]));
            const Floats i = Floats(1.0F) / max(abs(direction[axis]), Floats(kLeastDirection));
            inverse[axis] = floats_of(bits_of(i) | (sign & Ints(kSignBit)));
            const Floats slack = mul_add(away + Floats(reach), Floats(kSlack), ray.error);
            const Floats slack_of_s = slack * i;
            const Floats add = floats_from(-(ray.origin[axis] * doubles_from(inverse[axis])));
            near_add[axis] = add - slack_of_s;
            far_add[axis] = add + slack_of_s;
            signs = signs | (sign & Ints(1 << axis));
            square = mul_add(direction[axis], direction[axis], square);
            margin = max(margin, slack);
        }
        // A point of the ray at a box's entry lies within 2 margins of that box, which is to be
        // less than 2^14 units of the leaf's grid; and its error less than 2^-6 units.
        const Floats least_unit = max(margin * Floats(0x1p-13F), ray.error * Floats(0x1p6F));
        const auto store = [](const auto(&v)[3], const auto& fourth, auto(&to)[RayLanes::kRays][4])
                               HWY_ATTR { store_by_fours(v[0], v[1], v[2], fourth, to[0]); };
        store(inverse, ray.behind, lanes.inverse);
        store(near_add, square, lanes.near_add);
        store(far_add, ray.error, lanes.far_add);
        store(direction, least_unit, lanes.direction);
        store(ray.origin, Doubles(0.0), lanes.origin);
        store(ray.step, Doubles(0.0), lanes.step);
        ray.advance.store(lanes.advance);
        ray.scale.store(lanes.scale);
        signs.store(lanes.signs);
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_RAY_BLOCK_H_
