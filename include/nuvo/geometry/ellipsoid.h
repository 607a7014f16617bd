#pragma once

#include "nuvo/math/affine.h"
#include "nuvo/math/bounds.h"

namespace nuvo {

/// A sphere under a non-uniform transform: the image of the origin-centred sphere of `radius`
/// under p -> linear * p + center. Its surface is |adj(linear) (p - center)| = |det linear| radius,
/// with `linear` in double taken as exact; adj and det are polynomials in it.
struct Ellipsoid {
    Point3 center;
    Matrix3 linear;
    double radius = 1;

    /// Contains the ellipsoid, rounded outwards.
    Bounds3 bounds() const;
};

}  // namespace nuvo
