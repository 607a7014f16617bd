#include "nuvo/math/error_bounds.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace nuvo {
namespace {

TEST(RoundedUp, IsNeverBelowAndLittleAbove) {
    constexpr unsigned kSeed = 3;
    std::mt19937 engine(kSeed);
    std::uniform_real_distribution<double> fraction(1, 2);
    constexpr double kLeast = std::numeric_limits<float>::min();
    for (int exponent = -200; exponent < 127; ++exponent)
        for (int i = 0; i < 100; ++i) {
            const double value = std::ldexp(fraction(engine), exponent);
            const double up = rounded_up(value);
            ASSERT_GE(up, value) << "seed " << kSeed << ", exponent " << exponent;
            ASSERT_LE(up, value * (1 + 0x1p-22) + 2 * kLeast) << "seed " << kSeed;
            ASSERT_GE(up, kLeast);  // never subnormal
        }
    EXPECT_EQ(rounded_up(0), 0);
    EXPECT_EQ(rounded_up(std::numeric_limits<double>::infinity()),
              std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace nuvo
