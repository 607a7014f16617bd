#pragma once

#include <cmath>

#include "nuvo/math/bounds.h"
#include "nuvo/render/primitives.h"

namespace nuvo {

/// The frame in which floats are good for the scene: moved so that its box, or where most of it
/// stands in far less room than that, lies around 0, and scaled by a power of two so that no
/// coordinate exceeds 1.
struct LocalFrame {
    Point3 center;
    double scale = 1;  ///< a power of two
    /// Coordinates up to this are as good as 0: a quarter of the scene's, or as wide as that place.
    double dense = 0.25;

    /// Three roundings at most: of the difference, in units of the larger operand; none of the
    /// product unless it is subnormal.
    Point3 local(const Point3& p) const { return (p - center) * scale; }
};

/// A triangle's corners in the local frame, each number rounded to nearest: a.x, a.y, a.z, b.x ...
/// c.z.
struct LocalTriangle {
    float corner[9];
};
/// A sphere in the local frame, each number rounded to nearest.
struct LocalSphere {
    Vec3<float> center;
    float radius;
};
/// The sphere's largest number.
inline float size_of(const LocalSphere& sphere) {
    return std::fmax(sphere.radius, max_norm(sphere.center));
}

/// For primitives that `box` holds.
LocalFrame local_frame(const Primitives& primitives, const Bounds3& box);

}  // namespace nuvo
