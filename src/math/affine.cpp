#include "nuvo/math/affine.h"

namespace nuvo {

Matrix3 rotation(const Vector3& axis, double angle_rad) {
    const Vector3 k = normalized(axis);
    if (k == Vector3{}) return {};
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    const double v = 1 - c;
    return {{{c + k.x * k.x * v, k.x * k.y * v - k.z * s, k.x * k.z * v + k.y * s},
             {k.y * k.x * v + k.z * s, c + k.y * k.y * v, k.y * k.z * v - k.x * s},
             {k.z * k.x * v - k.y * s, k.z * k.y * v + k.x * s, c + k.z * k.z * v}}};
}

}  // namespace nuvo
