#pragma once

#include <cmath>
#include <limits>

namespace nuvo {

/// Bounds where nothing is known; ends of rays.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// u: a correctly rounded double operation has a relative error of at most u, except where its
/// result is subnormal.
inline constexpr double kUnitRoundoff = 0x1p-53;
/// The absolute error of a product that becomes subnormal; sums and differences have none.
inline constexpr double kUnderflow = 0x1p-1074;

/// The same of a float operation: half the distance from 1 to the next float.
inline constexpr float kFloatRoundoff = 0x1p-24F;
/// More than what the products of a float stage lose below the normal range, where a few of them
/// are multiplied with numbers up to the size of a picture; added to a stage's bound.
inline constexpr double kFloatUnderflow = 0x1p-120;

/// A float not below `value` >= 0: two roundoffs more outweigh the conversion's one, and the
/// smallest normal number what it loses below that. Of 0 it is 0, because subnormal operands slow
/// every operation down.
inline float rounded_up(double value) {
    if (value == 0) return 0;
    return static_cast<float>(value * (1 + 2 * static_cast<double>(kFloatRoundoff)) +
                              static_cast<double>(std::numeric_limits<float>::min()));
}

/// gamma(n) = n u / (1 - n u): bounds the relative error of a product of n factors (1 + e), |e| <=
/// u, and, with the sum of the absolute values, that of a sum of such products. (Higham, Lemma 3.1)
constexpr double gamma(int n) { return n * kUnitRoundoff / (1 - n * kUnitRoundoff); }

/// The same of float operations, n up to 512, rounded up by so much that sums of up to 512 such
/// bounds, in floats, are bounds of the product, too: n u (1 + 2^-12). What goes through a square
/// root counts by half, so n need not be whole.
constexpr float roundings(double n) {
    return static_cast<float>(n * (1 + 0x1p-12)) * kFloatRoundoff;
}

/// value + error exactly.
struct TwoTerms {
    double value;
    double error;
};

/// a - b exactly, unless a - b overflows (Knuth). Never depends on |a| and |b|.
inline TwoTerms two_diff(double a, double b) {
    const double value = a - b;
    const double b_part = a - value;
    const double a_part = value + b_part;
    return {value, (a - a_part) + (b_part - b)};
}

}  // namespace nuvo
