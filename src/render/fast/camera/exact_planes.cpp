#include "fast/camera/exact_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nuvo/math/error_bounds.h"

namespace nuvo {

ExactPlane::ExactPlane(const Triangle& t, const Point3& eye) {
    const ExactVector a(t.a);
    normal = cross(ExactVector(t.b) - a, ExactVector(t.c) - a);
    constant = dot(normal, a - ExactVector(eye));
}

ScaledVector::ScaledVector(const ExactVector& v) {
    WideDouble part[3];
    bool found = false;
    for (int axis = 0; axis < 3; ++axis) {
        part[axis] = v[axis].approximate();
        if (part[axis].significand() == 0) continue;
        exponent = found ? std::max(exponent, part[axis].exponent()) : part[axis].exponent();
        found = true;
    }
    for (int axis = 0; axis < 3; ++axis)
        if (part[axis].significand() != 0)
            value[axis] =
                WideDouble(part[axis].significand(), part[axis].exponent() - exponent).rounded();
}

PixelFunction along_rays(const CameraRays& camera, const Vector3& v) {
    const CameraExtent extent(camera);
    const double a = dot(v, camera.right);
    const double b = dot(v, camera.down);
    const double c = dot(v, camera.forward);
    const double most = std::fabs(a) * extent.x + std::fabs(b) * extent.y + std::fabs(c);
    return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
            rounded_up(gamma(64) * max_norm(v) * extent.direction +
                       roundings(kCameraRoundings) * most + kFloatUnderflow)};
}

bool make_exact_camera_triangle(const CameraRays& camera, const Triangle& triangle, bool front_only,
                                CameraTriangle& out) {
    const ExactPlane plane(triangle, camera.eye);
    const int sign = plane.constant.sign();
    if (sign == 0 || (front_only && sign > 0)) return false;
    const auto put = [&](int i, const PixelFunction& f) {
        out.a[i] = f.a;
        out.b[i] = f.b;
        out.c[i] = f.c;
        out.e[i] = f.e;
    };
    const ExactVector eye(camera.eye);
    const ExactVector corner[3] = {ExactVector(triangle.a) - eye, ExactVector(triangle.b) - eye,
                                   ExactVector(triangle.c) - eye};
    // Edge functions may have any positive factor.
    for (int i = 0; i < 3; ++i)
        put(i,
            along_rays(camera,
                       ScaledVector(cross(corner[(i + 1) % 3], corner[(i + 2) % 3])).value * sign));
    const ScaledVector normal(plane.normal);
    const WideDouble constant = plane.constant.approximate();
    const WideDouble inverse =
        WideDouble(1, normal.exponent) / (constant * WideDouble(camera.scale));
    constexpr double kLargest = 0x1p120;
    const double factor = inverse.rounded();
    if (std::fabs(factor) * CameraExtent(camera).direction < kLargest)
        put(3, along_rays(camera, normal.value * factor));
    else
        put(3, {0, 0, 0, std::numeric_limits<float>::infinity()});
    return true;
}

}  // namespace nuvo
