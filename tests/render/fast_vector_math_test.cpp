// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/fast_vector_math_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/simd/vector_math.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void powers(const float* z, const float* exponent, float* out) {
    power_of_complement(Floats::load(z), Floats::load(exponent)).store(out);
}
void arcs(const float* x, float* out) { arc_cosine(Floats::load(x)).store(out); }
void arc_sines(const float* x, float* out) { arc_sine(Floats::load(x)).store(out); }
void inverse_roots(const float* x, float* out) { inverse_sqrt(Floats::load(x)).store(out); }
void reciprocals(const float* x, float* out) { reciprocal(Floats::load(x)).store(out); }
void rounded(const double* x, float* out) { floats_from(Doubles::load(x)).store(out); }

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "fast/simd/dispatch.h"

// Against the C library in double, whose errors do not count here.

namespace nuvo {
namespace {

constexpr int kLanes = 16;
constexpr double kUnit = 0x1p-24;
using Unary = void (*)(const float*, float*);

TEST(VectorMath, DoublesBeyondFloatsBecomeInfinite) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const InstructionSet isa : supported_instruction_sets()) {
        const double x[kLanes] = {1e300, -1e300, 1.5, -1e-300, 3.5e38, -3.5e38, 0x1.fffffefp127};
        float y[kLanes];
        (NUVO_FOR_ISA(isa, rounded))(x, y);
        const float expected[kLanes] = {kInfinity, -kInfinity, 1.5F,           -0.0F,
                                        kInfinity, -kInfinity, 0x1.fffffep127F};
        for (int lane = 0; lane < kLanes; ++lane) EXPECT_EQ(y[lane], expected[lane]);
    }
}

/// The largest of error(x, f(x)) over numbers made by `make(i)`.
template <typename Make, typename Error>
double worst(Unary f, int count, Make&& make, Error&& error) {
    double most = 0;
    for (int i = 0; i < count; i += kLanes) {
        float x[kLanes];
        float y[kLanes];
        for (int lane = 0; lane < kLanes; ++lane) x[lane] = make(i + lane);
        f(x, y);
        for (int lane = 0; lane < kLanes; ++lane) {
            const double e = error(static_cast<double>(x[lane]), static_cast<double>(y[lane]));
            if (!(e <= most)) most = e;  // a NaN stays
        }
    }
    return most;
}

double worst_power(InstructionSet isa, unsigned seed, int count) {
    const auto f = NUVO_FOR_ISA(isa, powers);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    double most = 0;
    for (int i = 0; i < count; i += kLanes) {
        float z[kLanes];
        float e[kLanes];
        float y[kLanes];
        for (int lane = 0; lane < kLanes; ++lane) {
            // Half of the numbers near 0, where lobes are steep; all exponents of X3D and 0.
            const float any = unit(random);
            z[lane] = std::min(lane % 2 == 0 ? any : any * any * any * any, 1 - 0x1p-24F);
            e[lane] = lane == 5 ? 0 : lane % 3 == 0 ? 128.0F : 128 * unit(random);
        }
        f(z, e, y);
        for (int lane = 0; lane < kLanes; ++lane) {
            const double true_power =
                std::pow(1 - static_cast<double>(z[lane]), static_cast<double>(e[lane]));
            most = std::max(most, std::fabs(static_cast<double>(y[lane]) - true_power));
        }
    }
    return most;
}

TEST(VectorMath, PowersStayWithinTheirBound) {
    constexpr unsigned kSeed = 4711;
    for (const InstructionSet isa : supported_instruction_sets()) {
        const double most = worst_power(isa, kSeed, 1 << 22);
        RecordProperty("units" + std::to_string(static_cast<int>(isa)),
                       std::to_string(most / kUnit));
        EXPECT_LE(most, 6 * kUnit) << "seed " << kSeed << ", " << most / kUnit << " units";
        EXPECT_GT(most, 0);
    }
}

TEST(VectorMath, ArcsStayWithinTheirBound) {
    constexpr int kSteps = 1 << 22;
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto error = [](double x, double y) { return std::fabs(y - std::acos(x)); };
        const auto even = [=](int i) {
            return static_cast<float>(2.0 * std::min(i, kSteps) / kSteps - 1);
        };
        // Near the ends: 1 - 2^-24, 1 - 2^-23 ...
        const auto ends = [](int i) {
            return (i % 2 == 0 ? 1 : -1) * (1 - static_cast<float>(i / 2) * 0x1p-24F);
        };
        const Unary f = NUVO_FOR_ISA(isa, arcs);
        const double most =
            std::max(worst(f, kSteps + kLanes, even, error), worst(f, 1 << 16, ends, error));
        RecordProperty("units" + std::to_string(static_cast<int>(isa)),
                       std::to_string(most / kUnit));
        EXPECT_LE(most, 8 * kUnit) << most / kUnit << " units";
    }
}

TEST(VectorMath, InversesOfInfinityAreUnknown) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        float x[kLanes] = {0, std::numeric_limits<float>::infinity()};
        float y[kLanes];
        NUVO_FOR_ISA(isa, inverse_roots)(x, y);
        for (const float root : y) EXPECT_TRUE(std::isnan(root)) << static_cast<int>(isa);
        NUVO_FOR_ISA(isa, reciprocals)(x, y);
        EXPECT_TRUE(std::isnan(y[1])) << static_cast<int>(isa);
    }
}

TEST(VectorMath, ArcSinesStayWithinTheirRelativeBound) {
    constexpr int kSteps = 1 << 20;
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto error = [](double x, double y) {
            return x == 0 ? y : std::fabs(y / std::asin(x) - 1);
        };
        const auto even = [=](int i) {
            return static_cast<float>(std::sqrt(0.5) * std::min(i, kSteps) / kSteps);
        };
        const auto small = [](int i) {
            return std::ldexp(1 + static_cast<float>(i % 1024) / 1024, -(i / 1024));
        };
        const Unary f = NUVO_FOR_ISA(isa, arc_sines);
        const double most =
            std::max(worst(f, kSteps + kLanes, even, error),
                     worst(
                         f, 1 << 16, [&](int i) { return small(i + 1024); }, error));
        EXPECT_LE(most, 16 * kUnit) << most / kUnit << " units";
        EXPECT_GT(most, 0);
    }
}

TEST(VectorMath, InversesStayWithinTheirBounds) {
    constexpr int kCount = 1 << 20;
    // Mantissas from 1 to 4 at exponents far apart.
    const auto make = [](int i) {
        const auto mantissa = static_cast<float>(1 + 3.0 * (i / kLanes) / (kCount / kLanes));
        return std::ldexp(mantissa, i % kLanes * 8 - 60);
    };
    for (const InstructionSet isa : supported_instruction_sets()) {
        const double root =
            worst(NUVO_FOR_ISA(isa, inverse_roots), kCount, make,
                  [](double x, double y) { return std::fabs(y * std::sqrt(x) - 1); });
        EXPECT_LE(root, 2.2 * kUnit) << root / kUnit << " units";
        const double inverse = worst(NUVO_FOR_ISA(isa, reciprocals), kCount, make,
                                     [](double x, double y) { return std::fabs(y * x - 1); });
        EXPECT_LE(inverse, 1.2 * kUnit) << inverse / kUnit << " units";
    }
}

}  // namespace
}  // namespace nuvo
#endif
