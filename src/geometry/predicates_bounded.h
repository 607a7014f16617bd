#pragma once

#include "nuvo/geometry/predicates.h"

/// Triple products with running error bounds, in double and, where that is not enough, in the
/// platform's long double (64 bits on x86; where it is no wider, the exact stage follows at once).
/// Internal to the predicates.
namespace nuvo::detail {

/// gamma(n) of T's own roundoff.
template <typename T>
constexpr T gamma_of(int n) {
    const T nu = static_cast<T>(n) * std::numeric_limits<T>::epsilon() / 2;
    return nu / (1 - nu);
}

/// The absolute error of a product of T that becomes subnormal. None where T's exponents have room
/// for every product of doubles that is asked for (six factors from 2^-1074 on).
template <typename T>
constexpr T underflow_of() {
    return std::numeric_limits<T>::min_exponent < -6 * 1074 ? T(0) : static_cast<T>(kUnderflow);
}

template <typename T>
T sum(const Vec3<T>& v) {
    return v.x + v.y + v.z;
}

/// A value with its error bound. A NaN or infinite bound: nothing is known.
template <typename T>
struct Bounded {
    T value;
    T error;

    bool sure() const { return std::fabs(value) > error && finite(); }
    int sign() const { return value > 0 ? 1 : -1; }
    /// Surely zero: every product was.
    bool vanishes() const { return error == 0; }
    /// Known within `relative`.
    bool within(double relative) const {
        return error <= static_cast<T>(relative) * std::fabs(value) && finite();
    }

  private:
    bool finite() const { return error < std::numeric_limits<T>::max(); }
};

/// n . d for a cross product n = p x q with the magnitudes of its terms; each of d, p, q is known
/// within one roundoff (a difference, or a direction without its tail): terms of 8 roundings each,
/// over the sum of their magnitudes; and underflow. [numerics: triple product]
template <typename T>
Bounded<T> triple_product(const Vec3<T>& d, const Vec3<T>& n, const Vec3<T>& n_magnitude) {
    const Vec3<T> size = magnitude(d);
    return {dot(n, d),
            gamma_of<T>(9) * dot(n_magnitude, size) + 16 * underflow_of<T>() * (sum(size) + 1)};
}
/// The ray's direction rounded to T: within one roundoff of the true one.
template <typename T>
Vec3<T> direction_of(const ExactRay& ray) {
    if constexpr (std::is_same_v<T, double>) {
        return ray.direction();
    } else {
        return Vec3<T>(ray.direction()) + Vec3<T>(ray.tail());
    }
}

}  // namespace nuvo::detail
