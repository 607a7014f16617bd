#pragma once

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

/// For primitives that `box` holds.
LocalFrame local_frame(const Primitives& primitives, const Bounds3& box);

}  // namespace nuvo
