#pragma once

#include "fast/camera/camera_tables.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/exact.h"

// Planes from exact arithmetic, for what double arithmetic cannot tell.

namespace nuvo {

/// A triangle's plane as CameraRays sees it: q = (normal.p + from_anchor) / constant, with p the
/// ray's direction in perspective, where from_anchor is 0, and its offset in a parallel projection.
struct ExactPlane {
    ExactPlane(const Triangle& triangle, const CameraRays& camera);

    ExactVector normal;
    Exact from_anchor;
    Exact constant;
};

/// The numbers of normal.p + from_anchor times the power of two that brings the largest between 1/2
/// and 1; each within two roundings.
struct ScaledPlane {
    ScaledPlane(const ExactVector& normal, const Exact& from_anchor);

    Vector3 normal;
    double from_anchor = 0;
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
/// Of a plane, times a factor. Counts the roundings of its numbers, and of the exact rays, which
/// were rounded in other ways.
PixelFunction along_rays(const CameraRays& camera, const ScaledPlane& plane, double factor);

/// The record of a triangle of which double arithmetic cannot tell it. False: the eye lies in its
/// plane or behind a front that alone is visible; from there it is never hit, and has no record.
bool make_exact_camera_triangle(const CameraRays& camera, const Triangle& triangle, bool front_only,
                                CameraTriangle& out);

}  // namespace nuvo
