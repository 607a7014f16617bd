#pragma once

#include "nuvo/math/bounds.h"
#include "nuvo/math/vec.h"

namespace nuvo {

/// A round sphere in world space. [eq. 2] radius > 0.
struct Sphere {
    Point3 center;
    double radius = 1;

    /// Contains the sphere, rounded outwards.
    Bounds3 bounds() const;
};

}  // namespace nuvo
