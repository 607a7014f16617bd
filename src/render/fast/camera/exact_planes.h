#pragma once

#include "fast/camera/camera_tables.h"
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

/// The function c + a X + b Y of the pixel coordinates X, Y of CameraRays, off by at most e over
/// the picture, as CameraTriangle has them; e is infinite where floats cannot tell.
struct PixelFunction {
    float a = 0;
    float b = 0;
    float c = 0;
    float e = 0;
};
/// d.v of the rays' directions d. Counts the roundings of v, and of the exact rays' directions,
/// which were rounded in other ways.
PixelFunction along_rays(const CameraRays& camera, const Vector3& v);

/// The record of a triangle of which double arithmetic cannot tell it. False: the eye lies in its
/// plane or behind a front that alone is visible; from there it is never hit, and has no record.
bool make_exact_camera_triangle(const CameraRays& camera, const Triangle& triangle, bool front_only,
                                CameraTriangle& out);

}  // namespace nuvo
