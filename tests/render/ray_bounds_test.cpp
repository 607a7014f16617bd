// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/ray_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/rays/ray_block.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_RAY_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_RAY_BOUNDS_TEST_CPP_
struct PreparedRays {
    RayLanes lanes;
    std::uint32_t valid;
};
#endif
}  // namespace nuvo

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void prepare_rays(std::span<const Ray> rays, const LocalFrame& frame, float reach,
                  PreparedRays& out) {
    RayBlock block;
    block.prepare(rays, frame, reach);
    out = {block.lanes, block.valid};
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "real_numbers.h"

// Single rays at planes and boxes against 60 digits, from near and far.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261201;

// 16 rays to places about the root, of any length.
std::vector<Ray> any_rays(std::mt19937_64& random, const LocalFrame& frame, bool is_far) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < RayLanes::kRays; ++i) {
        const Point3 aim = frame.center + uniform_point(random, 4);
        const double away = is_far ? std::exp2(uniform(random, 4, 44)) : uniform(random, 0, 8);
        Vector3 way = uniform_point(random, std::exp2(uniform(random, -20, 20)));
        // Just below a power of two, to which floats round it.
        if (random() % 8 == 0) way[static_cast<int>(random() % 3)] = -0x1.fffffffffp20;
        rays.push_back({aim - normalized(way) * away, way});
    }
    return rays;
}

// The planes x = c of boxes in the root, from wherever the ray starts.
TEST(RayBounds, HoldTheSlabsOfRays) {
    std::mt19937_64 random(kSeed);
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto prepare = NUVO_FOR_ISA(isa, prepare_rays);
        double share[2] = {}, point_share[2] = {};
        int judged = 0;
        for (int round = 0; round < 1500; ++round) {
            const LocalFrame frame{uniform_point(random, 100), 0.25, 0.25};
            const float reach = 1;
            const bool is_far = round % 2 != 0;
            const std::vector<Ray> rays = any_rays(random, frame, is_far);
            PreparedRays made;
            prepare(rays, frame, reach, made);
            for (std::size_t i = 0; i < RayLanes::kRays; ++i) {
                if ((made.valid >> i & 1) == 0) continue;
                const double advance = made.lanes.advance[i];
                const double scale = made.lanes.scale[i];
                // A point of the ray near the boxes, as a leaf finds it.
                const double most = (1 + uniform(random, 0, 1)) * (is_far ? 2 : 1);
                const auto at = static_cast<float>(most * uniform(random, 0, 1));
                for (int axis = 0; axis < 3; ++axis) {
                    const double step = made.lanes.step[i][axis];
                    const double p = made.lanes.origin[i][axis] + static_cast<double>(at) * step;
                    const Real there = (Real(rays[i].origin[axis]) - Real(frame.center[axis])) *
                                           Real(frame.scale) +
                                       (Real(at) + Real(advance)) * Real(step);
                    const Real error(made.lanes.far_add[i][3]);
                    ASSERT_LE(abs(Real(p) - there), error)
                        << "seed " << kSeed << ", round " << round;
                    attain(point_share[is_far], abs(Real(p) - there), error);
                }
                for (int axis = 0; axis < 3; ++axis) {
                    const float plane = random() % 2 != 0
                                            ? std::copysign(reach, made.lanes.inverse[i][axis])
                                            : static_cast<float>(uniform(random, -1, 1));
                    const Real d = Real(rays[i].direction[axis]) * Real(frame.scale);
                    if (d == 0) continue;
                    const Real o =
                        (Real(rays[i].origin[axis]) - Real(frame.center[axis])) * Real(frame.scale);
                    const Real s = (Real(plane) - o) / d * Real(scale) - Real(advance);
                    const float inverse = made.lanes.inverse[i][axis];
                    const float near = made.lanes.near_add[i][axis];
                    const float far = made.lanes.far_add[i][axis];
                    for (const float low : {std::fma(plane, inverse, near), plane * inverse + near})
                        ASSERT_LE(Real(low), s) << "seed " << kSeed << ", round " << round;
                    for (const float high : {std::fma(plane, inverse, far), plane * inverse + far})
                        ASSERT_GE(Real(high), s) << "seed " << kSeed << ", round " << round;
                    ++judged;
                    const Real middle = (Real(near) + Real(far)) / 2 + Real(plane) * Real(inverse);
                    attain(share[is_far], abs(s - middle), (Real(far) - Real(near)) / 2);
                }
            }
        }
        EXPECT_GT(judged, 50'000);
        EXPECT_GT(share[0], 0.14);
        EXPECT_GT(share[1], 0.15);
        EXPECT_GT(point_share[0], 0.03);
        EXPECT_GT(point_share[1], 0.06);
    }
}

// The point where a ray enters a box by its slabs is less than 2^14 of the finest units from the
// box.
TEST(RayBounds, HoldWhereRaysEnterBoxes) {
    std::mt19937_64 random(kSeed + 1);
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto prepare = NUVO_FOR_ISA(isa, prepare_rays);
        int entered = 0;
        double share = 0;
        for (int round = 0; round < 3000; ++round) {
            const LocalFrame frame{uniform_point(random, 100), 0.25, 0.25};
            const std::vector<Ray> rays = any_rays(random, frame, round % 4 == 0);
            PreparedRays made;
            prepare(rays, frame, 1, made);
            for (std::size_t i = 0; i < RayLanes::kRays; ++i) {
                if ((made.valid >> i & 1) == 0) continue;
                const float* const inverse = made.lanes.inverse[i];
                float low[3], high[3], first = 0, last = 0x1p60F;
                for (int axis = 0; axis < 3; ++axis) {
                    low[axis] = static_cast<float>(uniform(random, -1, 1));
                    high[axis] = std::fmin(
                        1.0F, low[axis] + static_cast<float>(std::exp2(uniform(random, -24, 0))));
                    if (random() % 3 == 0) {
                        low[axis] = -1;
                        high[axis] = 1;
                    }
                    const bool negative = std::signbit(inverse[axis]);
                    first = std::fmax(first, std::fma(negative ? high[axis] : low[axis],
                                                      inverse[axis], made.lanes.near_add[i][axis]));
                    last = std::fmin(last, std::fma(negative ? low[axis] : high[axis],
                                                    inverse[axis], made.lanes.far_add[i][axis]));
                }
                if (first > last) continue;
                ++entered;
                const Real reach = Real(made.lanes.least_unit(i)) * 0x1p14;
                for (int axis = 0; axis < 3; ++axis) {
                    const Real p = Real(made.lanes.origin[i][axis]) +
                                   Real(first) * Real(made.lanes.step[i][axis]);
                    const Real outside = std::max(Real(low[axis] - p), Real(p - high[axis]));
                    ASSERT_LE(outside, reach) << "seed " << kSeed + 1 << ", round " << round;
                    attain(share, outside, reach);
                }
            }
        }
        EXPECT_GT(entered, 5000);
        EXPECT_GT(share, 0.5);
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
