#include "nuvo/geometry/triangle_mesh.h"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace nuvo {

namespace {

__extension__ using Wide = unsigned __int128;

/// A sum of products of two doubles without any rounding, overflow or underflow: 32-bit digits of a
/// fixed-point number that spans every exponent such a product can have.
class ExactSum {
  public:
    /// Adds a * b (both finite). At most 2^20 products fit before a digit could overflow.
    void add(double a, double b) {
        if (a == 0 || b == 0) return;
        int exponent_a = 0;
        int exponent_b = 0;
        const std::int64_t mantissa_a = mantissa(a, exponent_a);
        const std::int64_t mantissa_b = mantissa(b, exponent_b);
        const bool negative = (mantissa_a < 0) != (mantissa_b < 0);
        Wide rest =
            static_cast<Wide>(std::llabs(mantissa_a)) * static_cast<Wide>(std::llabs(mantissa_b));
        const int shift = exponent_a + exponent_b + kLowest;
        int digit = shift / 32;
        // The first digit takes the bits that complete it; then 32 at a time.
        const int offset = shift % 32;
        auto low = static_cast<std::int64_t>((rest << offset) & 0xffffffffU);
        rest >>= 32 - offset;
        for (;; ++digit) {
            digits_[digit] += negative ? -low : low;
            if (rest == 0) break;
            low = static_cast<std::int64_t>(rest & 0xffffffffU);
            rest >>= 32;
        }
    }

    bool is_zero() const {
        std::int64_t carry = 0;
        for (const std::int64_t digit : digits_) {
            const std::int64_t value = digit + carry;
            if ((value & 0xffffffff) != 0) return false;
            carry = value >> 32;
        }
        return carry == 0;
    }

  private:
    static constexpr int kLowest = 2 * 1074;  // the lowest bit of a product of two subnormals
    // The highest bit: 2 * 1024 above 1, kLowest below it.
    static constexpr int kDigits = (2 * 1024 + kLowest) / 32 + 2;

    /// value = mantissa * 2^exponent, |mantissa| < 2^53, exponent in [-1074, 971].
    static std::int64_t mantissa(double value, int& exponent) {
        int e = 0;
        const double fraction = std::frexp(value, &e);
        const int lifted = e - 53 < -1074 ? -1074 : e - 53;
        exponent = lifted;
        return static_cast<std::int64_t>(std::ldexp(fraction, e - lifted));
    }

    std::int64_t digits_[kDigits] = {};
};

/// Bound on the error of p - q, where p and q are products of two differences of doubles: each
/// difference and each product has a relative error of 2^-53, their difference another; to first
/// order 3 * 2^-53 (|p| + |q|), here 4 for the higher orders and the bound's own rounding, plus
/// what products lose among the subnormals.
double minor_error(double p, double q) {
    return 2 * std::numeric_limits<double>::epsilon() * (std::fabs(p) + std::fabs(q)) +
           4 * std::numeric_limits<double>::denorm_min();
}

/// True when (bx - ax) (cy - ay) - (by - ay) (cx - ax) is certainly not zero.
bool surely_nonzero(double ax, double ay, double bx, double by, double cx, double cy) {
    const double p = (bx - ax) * (cy - ay);
    const double q = (by - ay) * (cx - ax);
    return std::fabs(p - q) > minor_error(p, q);
}

/// The same expression multiplied out (its two terms ax ay cancel), decided exactly.
bool exactly_zero(double ax, double ay, double bx, double by, double cx, double cy) {
    ExactSum sum;
    sum.add(bx, cy);
    sum.add(-bx, ay);
    sum.add(-ax, cy);
    sum.add(-by, cx);
    sum.add(by, ax);
    sum.add(ay, cx);
    return sum.is_zero();
}

}  // namespace

Bounds3 TriangleMesh::bounds() const {
    Bounds3 box;
    for (const IndexTriple& corners : triangles)
        for (const std::uint32_t corner : corners) box = box.extended(positions[corner]);
    return box;
}

bool has_zero_area(const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    if (surely_nonzero(a.x, a.y, b.x, b.y, c.x, c.y) ||
        surely_nonzero(a.y, a.z, b.y, b.z, c.y, c.z) ||
        surely_nonzero(a.z, a.x, b.z, b.x, c.z, c.x))
        return false;
    return exactly_zero(a.x, a.y, b.x, b.y, c.x, c.y) &&
           exactly_zero(a.y, a.z, b.y, b.z, c.y, c.z) && exactly_zero(a.z, a.x, b.z, b.x, c.z, c.x);
}

}  // namespace nuvo
