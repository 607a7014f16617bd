#include "fast/camera/exact_planes.h"

#include <algorithm>
#include <cmath>

#include "nuvo/math/error_bounds.h"

namespace nuvo {

namespace {

// Of a plane through a point, which counts from the anchor.
Exact from_anchor_of(const ExactVector& normal, const ExactVector& point,
                     const CameraRays& camera) {
    return camera.parallel ? dot(normal, point) * Exact(-camera.scale) : Exact();
}

}  // namespace

ExactPlane::ExactPlane(const Triangle& t, const CameraRays& camera) {
    const ExactVector corner(t.a);
    normal = cross(ExactVector(t.b) - corner, ExactVector(t.c) - corner);
    const ExactVector a = corner - ExactVector(camera.anchor);
    from_anchor = from_anchor_of(normal, a, camera);
    constant = camera.parallel ? dot(normal, ExactVector(camera.forward))
                               : dot(normal, a) * Exact(camera.scale);
}

ScaledPlane::ScaledPlane(const ExactVector& exact_normal, const Exact& exact_constant) {
    WideDouble part[4];
    bool found = false;
    for (int i = 0; i < 4; ++i) {
        part[i] = (i < 3 ? exact_normal[i] : exact_constant).approximate();
        if (part[i].significand() == 0) continue;
        exponent = found ? std::max(exponent, part[i].exponent()) : part[i].exponent();
        found = true;
    }
    for (int i = 0; i < 4; ++i) {
        if (part[i].significand() == 0) continue;
        (i < 3 ? normal[i] : from_anchor) =
            WideDouble(part[i].significand(), part[i].exponent() - exponent).rounded();
    }
}

PixelFunction along_rays(const CameraRays& camera, const ScaledPlane& plane, double factor) {
    const CameraExtent extent(camera);
    const Vector3 normal = plane.normal * factor;
    const double a = dot(normal, camera.right);
    const double b = dot(normal, camera.down);
    const double c = camera.parallel ? plane.from_anchor * factor : dot(normal, camera.forward);
    const double most = std::fabs(a) * extent.x + std::fabs(b) * extent.y + std::fabs(c);
    const double reach = camera.parallel ? extent.starts : extent.direction;
    return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
            rounded_up(gamma(64) * (max_norm(normal) * reach + std::fabs(c)) +
                       roundings(kCameraRoundings) * most + kFloatUnderflow)};
}

bool make_exact_camera_triangle(const CameraRays& camera, const Triangle& triangle, bool front_only,
                                CameraTriangle& out) {
    const ExactPlane plane(triangle, camera);
    const int sign = plane.constant.sign();
    if (sign == 0 || (front_only && sign > 0)) return false;
    const auto put = [&](int i, const PixelFunction& f) {
        out.a[i] = f.a;
        out.b[i] = f.b;
        out.c[i] = f.c;
        out.e[i] = f.e;
    };
    const ExactVector anchor(camera.anchor);
    const ExactVector corner[3] = {ExactVector(triangle.a) - anchor,
                                   ExactVector(triangle.b) - anchor,
                                   ExactVector(triangle.c) - anchor};
    // Edge functions may have any positive factor.
    for (int i = 0; i < 3; ++i) {
        const ExactVector& p = corner[(i + 1) % 3];
        const ExactVector& q = corner[(i + 2) % 3];
        const ExactVector normal =
            camera.parallel ? cross(ExactVector(camera.forward), q - p) : cross(p, q);
        put(i, along_rays(camera, {normal, from_anchor_of(normal, p, camera)}, sign));
    }
    const ScaledPlane scaled(plane.normal, plane.from_anchor);
    const double factor = (WideDouble(1, scaled.exponent) / plane.constant.approximate()).rounded();
    constexpr double kLargest = 0x1p120;
    if (std::fabs(factor) * (CameraExtent(camera).direction + 1) < kLargest)
        put(3, along_rays(camera, scaled, factor));
    else
        put(3, {0, 0, 0, kFloatInfinity});
    return true;
}

}  // namespace nuvo
