#include "nuvo/math/exact.h"

#include <gtest/gtest.h>

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace nuvo {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr std::uint64_t kSeed = 20250341;

/// Any finite double: every exponent alike, subnormals included.
double any_double(std::mt19937_64& engine) {
    for (;;) {
        const double v = std::bit_cast<double>(engine());
        if (std::isfinite(v)) return engine() % 8 == 0 ? std::trunc(std::remainder(v, 64)) : v;
    }
}

/// Doubles of like size, that cancel.
double near_one(std::mt19937_64& engine) {
    const double coarse = static_cast<double>(static_cast<int>(engine() % 2001) - 1000) * 0x1p-7;
    return coarse + (engine() % 2 != 0 ? static_cast<double>(engine() % 1024) * 0x1p-52 : 0.0);
}

int sign(const Rational& r) { return r < 0 ? -1 : r > 0 ? 1 : 0; }

/// |w - r| <= 2 u |r|, where w may lie outside the range of a double.
bool approximates(const WideDouble& w, const Rational& r) {
    Rational value(w.significand());
    const Rational two_to_the(boost::multiprecision::cpp_int(1)
                              << std::abs(static_cast<int>(w.exponent())));
    value = w.exponent() < 0 ? Rational(value / two_to_the) : Rational(value * two_to_the);
    return abs(Rational(value - r)) <= abs(r) * Rational(0x1p-52);
}

TEST(Exact, PolynomialsOfAnyDoublesMatchRationals) {
    std::mt19937_64 engine(kSeed);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", case " << i);
        double v[6];
        for (double& x : v) x = i % 2 != 0 ? any_double(engine) : near_one(engine);
        const Exact exact = (Exact(v[0]) * Exact(v[1]) - Exact(v[2]) * Exact(v[3])) * Exact(v[4]) +
                            Exact(v[5]) * Exact(v[0]) * Exact(v[3]);
        const Rational truth =
            (Rational(v[0]) * Rational(v[1]) - Rational(v[2]) * Rational(v[3])) * Rational(v[4]) +
            Rational(v[5]) * Rational(v[0]) * Rational(v[3]);
        ASSERT_EQ(exact.sign(), sign(truth));
        ASSERT_TRUE(approximates(exact.approximate(), truth));
        // Exactly, not only in the first digits: the difference to a perturbed twin keeps its sign.
        const Exact tiny(std::numeric_limits<double>::denorm_min());
        const Exact delta = tiny * tiny * tiny;
        ASSERT_EQ((exact + delta - exact).sign(), 1);
        ASSERT_EQ(compare(exact, exact + delta), -1);
        ASSERT_EQ((exact - exact).sign(), 0);
    }
}

TEST(Exact, HighDegreesSpillAndStayExact) {
    std::mt19937_64 engine(kSeed + 1);
    for (int i = 0; i < 60; ++i) {
        Exact product(1);
        Exact sum;
        Rational rational_product(1);
        Rational rational_sum;
        for (int k = 0; k < 30; ++k) {
            const double v = any_double(engine);
            product = product * Exact(v == 0 ? 3 : v);
            rational_product *= Rational(v == 0 ? 3 : v);
            sum = sum + (k % 2 != 0 ? product : -product);
            rational_sum += k % 2 != 0 ? rational_product : -rational_product;
        }
        ASSERT_EQ(sum.sign(), sign(rational_sum));
        ASSERT_EQ(
            compare(product * product, sum * sum),
            sign(Rational(rational_product * rational_product - rational_sum * rational_sum)));
    }
}

TEST(Exact, CopiesAndMovesKeepSmallAndLargeValues) {
    Exact large(1);
    for (int i = 0; i < 20; ++i) large = large * (Exact(1e300) + Exact(1e-300));
    const Exact copy = large;
    Exact moved = std::move(large);
    EXPECT_EQ(compare(copy, moved), 0);
    Exact small(3);
    moved = small;
    EXPECT_EQ(compare(moved, Exact(3)), 0);
    small = copy;
    EXPECT_EQ(compare(small, copy), 0);
    const Exact& self = small;
    small = self;
    EXPECT_EQ(compare(small, copy), 0);
}

TEST(Exact, ByHand) {
    EXPECT_EQ(Exact(0.0).sign(), 0);
    EXPECT_EQ(Exact(-0.0).sign(), 0);
    EXPECT_EQ((Exact(1e308) * Exact(1e308) - Exact(1e308) * Exact(1e308)).sign(), 0);
    EXPECT_EQ((Exact(1e308) + Exact(5e-324) - Exact(1e308)).approximate().rounded(), 5e-324);
    EXPECT_EQ((Exact(0.1) * Exact(10) - Exact(1)).approximate().rounded(), 0x1p-54);
    EXPECT_EQ((Exact(0x1p32) * Exact(0x1p32)).approximate().rounded(), 0x1p64);
    EXPECT_EQ((Exact(0x1p64) - Exact(1)).approximate().rounded(), 0x1p64);
    EXPECT_EQ((Exact(1) - Exact(0x1p64)).sign(), -1);
    EXPECT_EQ(compare(abs(Exact(-2)), Exact(2)), 0);
}

TEST(WideDouble, DoesNotLeaveItsRange) {
    const WideDouble huge(1e300);
    const WideDouble tiny(1e-300);
    EXPECT_DOUBLE_EQ((huge * huge * tiny * tiny).rounded(), 1);
    EXPECT_DOUBLE_EQ(sqrt(huge * huge).rounded(), 1e300);
    EXPECT_DOUBLE_EQ(sqrt(WideDouble(2)).rounded(), std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(sqrt(WideDouble(0.5)).rounded(), std::sqrt(0.5));
    EXPECT_EQ((huge * huge).rounded(), std::numeric_limits<double>::infinity());
    EXPECT_EQ((tiny * tiny).rounded(), 0);
    EXPECT_EQ((huge + tiny).rounded(), 1e300);
    EXPECT_EQ((WideDouble(3) + WideDouble(-3)).rounded(), 0);
    EXPECT_EQ((WideDouble(1) / WideDouble(4)).rounded(), 0.25);
}

}  // namespace
}  // namespace nuvo
