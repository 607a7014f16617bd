#include "fast/primary/plane_order.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {

PixelFunction PlaneOrders::order_of(Slot first, Slot second) const {
    const ExactPlane p(scene_.triangle(first), camera_);
    const ExactPlane q(scene_.triangle(second), camera_);
    const int sign = p.constant.sign() * q.constant.sign();
    if (sign == 0) return {0, 0, 0, kFloatInfinity};
    const ExactVector difference{p.normal.x * q.constant - q.normal.x * p.constant,
                                 p.normal.y * q.constant - q.normal.y * p.constant,
                                 p.normal.z * q.constant - q.normal.z * p.constant};
    const Exact constant = p.from_anchor * q.constant - q.from_anchor * p.constant;
    const ScaledPlane m(difference, constant);
    if (m.normal == Vector3{} && m.from_anchor == 0)
        return {0, 0, scene_.id(first) < scene_.id(second) ? 1.0F : -1.0F, 0};
    return along_rays(camera_, m, sign);
}

}  // namespace nuvo
