#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "nuvo/geometry/ellipsoid.h"
#include "nuvo/math/ray.h"

/// The thesis' tests as they stand: one rounding after another, no bounds. T is float (the thesis)
/// or double.
namespace nuvo::plain {

template <typename T>
struct Hit {
    T t;
    Vec2<T> uv;         ///< triangle: weights of b and c; else 0
    bool front = true;  ///< the ray meets the side on which the corners run counterclockwise
};

/// Moeller and Trumbore, both sides; the division waits until the hit is sure. [thesis 4.2.4]
template <typename T>
std::optional<Hit<T>> hit(const RayT<T>& ray, const Vec3<T>& a, const Vec3<T>& b,
                          const Vec3<T>& c) {
    const Vec3<T> e1 = b - a;
    const Vec3<T> e2 = c - a;
    const Vec3<T> p = cross(ray.direction, e2);
    const T determinant = dot(e1, p);
    const Vec3<T> s = ray.origin - a;
    const T side = determinant < 0 ? T(-1) : T(1);
    const T size = determinant * side;
    const T u = dot(s, p) * side;
    if (!(u >= 0 && u <= size)) return std::nullopt;
    const Vec3<T> q = cross(s, e1);
    const T v = dot(ray.direction, q) * side;
    if (!(v >= 0 && u + v <= size) || size == 0) return std::nullopt;
    const T t = dot(e2, q) * side / size;
    if (!(t > 0)) return std::nullopt;
    return Hit<T>{t, {u / size, v / size}, determinant > 0};
}

/// The roots of |f + t d|^2 = R^2, in the order of t, by the quadratic formula. [eq. 22-24]
template <typename T>
std::optional<Vec2<T>> roots(const Vec3<T>& f, const Vec3<T>& d, T radius) {
    const T a = dot(d, d);
    const T b = dot(d, f);
    const T c = dot(f, f) - radius * radius;
    const T discriminant = b * b - a * c;
    if (!(discriminant >= 0) || a == 0) return std::nullopt;
    const T root = std::sqrt(discriminant);
    return Vec2<T>{(-b - root) / a, (-b + root) / a};
}

/// Which of the roots > 0 is met: the first one, or only where the ray enters or leaves.
enum class Met : std::uint8_t { kFirst, kEntry, kExit };

template <typename T>
std::optional<Hit<T>> root_met(const std::optional<Vec2<T>>& roots, Met met) {
    if (!roots || !(roots->y > 0)) return std::nullopt;
    if (met == Met::kEntry && !(roots->x > 0)) return std::nullopt;
    return Hit<T>{roots->x > 0 && met != Met::kExit ? roots->x : roots->y, {}};
}

template <typename T>
std::optional<Hit<T>> hit(const RayT<T>& ray, const Vec3<T>& center, T radius,
                          Met met = Met::kFirst) {
    return root_met(roots(ray.origin - center, ray.direction, radius), met);
}

/// An ellipsoid in its local space: `inverse` undoes Ellipsoid::linear.
template <typename T>
struct LocalEllipsoid {
    Vec3<T> center;
    Vec3<T> inverse[3];  ///< rows
    T radius;

    explicit LocalEllipsoid(const Ellipsoid& e)
        : center(e.center), radius(static_cast<T>(e.radius)) {
        const Matrix3 adjugate = e.linear.adjugate();
        const double determinant = e.linear.determinant();
        for (int i = 0; i < 3; ++i) inverse[i] = Vec3<T>(adjugate.row[i] / determinant);
    }
    Vec3<T> local(const Vec3<T>& v) const {
        return {dot(inverse[0], v), dot(inverse[1], v), dot(inverse[2], v)};
    }
};

template <typename T>
std::optional<Hit<T>> hit(const RayT<T>& ray, const LocalEllipsoid<T>& e, Met met = Met::kFirst) {
    return root_met(roots(e.local(ray.origin - e.center), e.local(ray.direction), e.radius), met);
}

/// Shadow: a hit at 0 < t < end.
template <typename T, typename... Primitive>
bool blocks(const RayT<T>& shadow, T end, const Primitive&... primitive) {
    const std::optional<Hit<T>> found = hit(shadow, primitive...);
    return found && found->t < end;
}

}  // namespace nuvo::plain
