#include "float_sine.h"

#include <cmath>

namespace nuvo::generator {

namespace {

// pi / 2 in two parts; the first has 33 bits, so that its whole multiples here are exact.
constexpr double kQuarterHigh = 0x1.921fb544p+0;
constexpr double kQuarterLow = 0x1.0b4611a626331p-34;

/// The Taylor series of sine (`degree` 1) or cosine (`degree` 0) for |x| <= pi / 4, until its terms
/// are below the last bit of a double.
double series(double x, int degree) {
    double term = degree == 0 ? 1 : x;
    double sum = term;
    for (int n = degree + 2; n < 22; n += 2) {
        term *= -x * x / (n * (n - 1));
        sum += term;
    }
    return sum;
}

/// Sine of `angle` plus `quarters` quarter turns.
float sine(float angle, int quarters) {
    const double turns = std::floor(static_cast<double>(angle) / kQuarterHigh + 0.5);
    const double rest = (static_cast<double>(angle) - turns * kQuarterHigh) - turns * kQuarterLow;
    const int quarter = (static_cast<int>(turns) + quarters) % 4;
    const double value = series(rest, quarter % 2 == 0 ? 1 : 0);
    return static_cast<float>(quarter < 2 ? value : -value);
}

}  // namespace

float float_sine(float angle) { return sine(angle, 0); }

float float_cosine(float angle) { return sine(angle, 1); }

}  // namespace nuvo::generator
