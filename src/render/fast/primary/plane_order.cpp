#include "fast/primary/plane_order.h"

#include <cmath>
#include <limits>

#include "fast/camera/exact_planes.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {
PlaneOrder PlaneOrders::order_of(Slot first, Slot second) const {
    const Point3& eye = scene_.scene().camera.position;
    const ExactPlane p(scene_.triangle(first), eye);
    const ExactPlane q(scene_.triangle(second), eye);
    const int sign = p.constant.sign() * q.constant.sign();
    if (sign == 0) return {0, 0, 0, std::numeric_limits<float>::infinity()};
    const ExactVector difference{p.normal.x * q.constant - q.normal.x * p.constant,
                                 p.normal.y * q.constant - q.normal.y * p.constant,
                                 p.normal.z * q.constant - q.normal.z * p.constant};
    const Vector3 m = ScaledVector(difference).value * sign;
    if (m == Vector3{}) return {0, 0, scene_.id(first) < scene_.id(second) ? 1.0F : -1.0F, 0};
    const CameraExtent extent(camera_);
    const double a = dot(m, camera_.right);
    const double b = dot(m, camera_.down);
    const double c = dot(m, camera_.forward);
    // m, the products, and the exact ray's direction, which was rounded in other ways.
    const double error = gamma(64) * max_norm(m) * extent.direction;
    const double most = std::fabs(a) * extent.x + std::fabs(b) * extent.y + std::fabs(c);
    return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
            rounded_up(error + roundings(kCameraRoundings) * most + kFloatUnderflow)};
}

}  // namespace nuvo
