#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>

#include "nuvo/math/vec.h"

namespace nuvo::fuzz {

/// The shortest text that reads as the same double.
inline std::string text(double value) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}
inline std::string text(const Vector3& v) { return text(v.x) + " " + text(v.y) + " " + text(v.z); }

/// What the numbers of one document look like.
enum class Numbers { kIntegers, kDecimals, kDoubles, kExtreme };

/// The random choices of one document: equal seeds give equal documents on every platform.
class Chooser {
  public:
    explicit Chooser(std::uint64_t seed) : engine_(seed) {}

    Numbers numbers = Numbers::kDecimals;

    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    /// True once in `n` times.
    bool once_in(int n) { return below(n) == 0; }
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    template <typename T, std::size_t n>
    const T& one_of(const T (&values)[n]) {
        return values[below(static_cast<int>(n))];
    }

    /// A size that strains the arithmetic; within `limit`, and above its reciprocal.
    double magnitude(double limit = 1e308) {
        constexpr double kMagnitudes[] = {5e-324, 1e-320, 1e-307, 3e-162, 1e-154, 1e-107, 1e-60,
                                          1e-38,  1e-22,  1e-16,  1e-9,   1e-6,   1e-3,   1e-2,
                                          1e2,    1e4,    1e6,    1e9,    1e15,   1e22,   1e38,
                                          1e77,   1e107,  1e154,  1e200,  1e300};
        for (;;) {
            const double m = one_of(kMagnitudes);
            if (m <= limit && m >= 1 / limit) return m;
        }
    }
    double signed_magnitude() {
        const double sign = once_in(2) ? 1 : -1;
        return sign * magnitude();
    }
    /// A coordinate of a thing that is about `half` large, in the document's kind of number.
    double coordinate(double half) {
        switch (numbers) {
            case Numbers::kIntegers:
                return std::nearbyint(uniform(-half, half));
            case Numbers::kDecimals:
                return std::nearbyint(uniform(-half, half) * 10) / 10;
            case Numbers::kExtreme:
                if (once_in(12)) return signed_magnitude();
                if (once_in(6)) return 0;
                break;
            case Numbers::kDoubles:
                break;
        }
        return uniform(-half, half);
    }
    Vector3 point(double half) {
        const double x = coordinate(half);
        const double y = coordinate(half);
        return {x, y, coordinate(half)};
    }
    /// A length around 1, never 0 but rarely.
    double size() {
        if (numbers == Numbers::kExtreme && once_in(6)) return magnitude();
        constexpr double kSizes[] = {0.1, 0.25, 0.5, 1, 1, 1.5, 2, 3};
        if (numbers == Numbers::kDoubles) return uniform(0.05, 3);
        return once_in(60) ? 0 : one_of(kSizes);
    }
    /// A direction: half of them along axes, some all but.
    Vector3 direction() {
        Vector3 d;
        const int axis = below(3);
        d[axis] = once_in(2) ? 1 : -1;
        if (once_in(2)) return d;
        if (once_in(4)) {
            d[(axis + 1) % 3] = magnitude(1e20);
            return d;
        }
        return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    }
    /// A value in 0..1, its ends and numbers next to them more often.
    double fraction() {
        constexpr double kEnds[] = {0, 0, 1, 1, 0.5, 1e-60, 1e-300, 5e-324, 0x1.fffffffffffffp-1};
        return once_in(3) ? one_of(kEnds) : std::nearbyint(uniform(0, 1) * 10) / 10;
    }
    std::string color() {
        if (once_in(4)) return text({fraction(), fraction(), fraction()});
        constexpr const char* kColors[] = {"1 0 0",     "0 1 0",       "0 0.3 1",
                                           "1 0.8 0.2", "0.8 0.8 0.8", "1 1 1"};
        return one_of(kColors);
    }
    /// `value`, or one that differs in its last bits.
    double nearly(double value) {
        for (int steps = once_in(2) ? 0 : below(3); steps > 0; --steps)
            value = std::nextafter(value, once_in(2) ? 1e300 : -1e300);
        return value;
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace nuvo::fuzz
