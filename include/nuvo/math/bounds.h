#pragma once

#include <limits>

#include "nuvo/math/vec.h"

namespace nuvo {

/// A closed axis-parallel box. A default-constructed box is empty (min > max) and is the identity
/// of `extended`.
template <typename T>
struct Bounds3T {
    Vec3<T> min{std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity(),
                std::numeric_limits<T>::infinity()};
    Vec3<T> max{-std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity(),
                -std::numeric_limits<T>::infinity()};

    constexpr bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    constexpr Vec3<T> widths() const { return max - min; }
    /// Halfway between the faces, without overflow.
    constexpr Vec3<T> center() const { return min * T(0.5) + max * T(0.5); }
    constexpr bool contains(const Vec3<T>& p) const {
        return min.x <= p.x && p.x <= max.x && min.y <= p.y && p.y <= max.y && min.z <= p.z &&
               p.z <= max.z;
    }
    /// True when the boxes share at least a point.
    constexpr bool overlaps(const Bounds3T& b) const {
        return min.x <= b.max.x && b.min.x <= max.x && min.y <= b.max.y && b.min.y <= max.y &&
               min.z <= b.max.z && b.min.z <= max.z;
    }
    constexpr Bounds3T extended(const Vec3<T>& p) const {
        return {nuvo::min(min, p), nuvo::max(max, p)};
    }
    constexpr Bounds3T extended(const Bounds3T& b) const {
        return {nuvo::min(min, b.min), nuvo::max(max, b.max)};
    }
    /// Every face moved outwards by `margin` (>= 0).
    constexpr Bounds3T inflated(T margin) const {
        const Vec3<T> m{margin, margin, margin};
        return {min - m, max + m};
    }
    /// Area of the six faces, in square scene units; 0 for an empty box.
    constexpr T surface_area() const {
        if (empty()) return T(0);
        const Vec3<T> w = widths();
        return T(2) * (w.x * w.y + w.y * w.z + w.z * w.x);
    }
    friend constexpr bool operator==(const Bounds3T&, const Bounds3T&) = default;
};

using Bounds3 = Bounds3T<double>;

}  // namespace nuvo
