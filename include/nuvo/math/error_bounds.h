#pragma once

#include <cmath>

namespace nuvo {

/// u: a correctly rounded double operation has a relative error of at most u, except where its
/// result is subnormal.
inline constexpr double kUnitRoundoff = 0x1p-53;
/// The absolute error of a product that becomes subnormal; sums and differences have none.
inline constexpr double kUnderflow = 0x1p-1074;

/// gamma(n) = n u / (1 - n u): bounds the relative error of a product of n factors (1 + e), |e| <=
/// u, and, with the sum of the absolute values, that of a sum of such products. (Higham, Lemma 3.1)
constexpr double gamma(int n) { return n * kUnitRoundoff / (1 - n * kUnitRoundoff); }

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
