#pragma once

#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/exact.h"

// Planes from exact arithmetic, for what double arithmetic cannot tell.

namespace nuvo {

/// t = constant / normal.d is where the ray from the eye along d meets a triangle's plane.
struct ExactPlane {
    ExactPlane(const Triangle& triangle, const Point3& eye);

    ExactVector normal;
    Exact constant;
};

/// The vector times the power of two that brings its largest component between 1/2 and 1; each
/// component within two roundings.
struct ScaledVector {
    explicit ScaledVector(const ExactVector& v);

    Vector3 value;
    std::int64_t exponent = 0;  ///< of the factor's inverse
};

}  // namespace nuvo
