#pragma once

#include "predicates_bounded.h"

/// Where a line meets a triangle's plane, with error bounds. Internal to the predicates.
namespace nuvo::detail {

/// The plane form t = n.(a - o) / n.d: n comes from the edges, so that a small triangle far away
/// keeps its accuracy.
template <typename T>
struct PlaneRoot {
    Bounded<T> numerator;
    Bounded<T> denominator;
    Vec3<T> normal;
    Vec3<T> normal_magnitude;  ///< gamma(4) times this bounds the normal's error
};

template <typename T>
PlaneRoot<T> plane_root(const ExactRay& ray, const Triangle& t) {
    const Vec3<T> corner(t.a);
    const Vec3<T> e1 = Vec3<T>(t.b) - corner;
    const Vec3<T> e2 = Vec3<T>(t.c) - corner;
    const Vec3<T> normal = cross(e1, e2);
    const Vec3<T> size = cross_magnitude(e1, e2);
    return {triple_product(corner - Vec3<T>(ray.origin()), normal, size),
            triple_product(direction_of<T>(ray), normal, size), normal, size};
}

}  // namespace nuvo::detail
