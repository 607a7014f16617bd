#pragma once

#include <cmath>
#include <limits>

namespace nuvo {

/// The exact error of `sum` = fl(a + b): a + b = sum + error (Knuth's two-sum).
inline double sum_error(double a, double b, double sum) {
    const double b_part = sum - a;
    return (a - (sum - b_part)) + (b - b_part);
}

/// a + b rounded towards +infinity, b >= 0; an exact sum stays as it is.
inline double add_up(double a, double b) {
    const double sum = a + b;
    return sum_error(a, b, sum) > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity())
                                    : sum;
}

/// a - b rounded towards -infinity, b >= 0; an exact difference stays as it is.
inline double subtract_down(double a, double b) { return -add_up(-a, b); }

}  // namespace nuvo
