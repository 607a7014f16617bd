#include "nuvo/octree/walk.h"

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/exact.h"

namespace nuvo {

double path_error_bound(const Bounds3& root) {
    return 16 * kUnitRoundoff * detail::size_of(root) + 32 * kUnderflow;
}

namespace detail {

int scale_direction(const Bounds3& root, Vector3& direction) {
    const int wanted = std::ilogb(std::fmax(size_of(root), kUnderflow));
    const int shift = std::clamp(wanted, -500, 500) - std::ilogb(max_norm(direction));
    for (int axis = 0; axis < 3; ++axis) direction[axis] = std::ldexp(direction[axis], shift);
    return shift;
}

bool enter_exactly(const Ray& ray, const Bounds3& root, Point3& entry, double& t) {
    const ExactVector o(ray.origin);
    const ExactVector d(ray.direction);
    // The last near face to be met: at t = way / speed, with speed > 0.
    int axis = -1;
    Exact way;
    Exact speed;
    for (int k = 0; k < 3; ++k) {
        if (ray.direction[k] == 0) continue;
        const bool up = ray.direction[k] > 0;
        const Exact to_face = up ? Exact(root.min[k]) - o[k] : o[k] - Exact(root.max[k]);
        if (axis >= 0 && compare(to_face * speed, way * abs(d[k])) <= 0) continue;
        axis = k;
        way = to_face;
        speed = abs(d[k]);
    }
    if (axis < 0 || way.sign() < 0) return false;
    for (int k = 0; k < 3; ++k) {
        const Exact at = o[k] * speed + d[k] * way;  // the entry's coordinate times speed
        if (compare(at, Exact(root.min[k]) * speed) < 0 ||
            compare(at, Exact(root.max[k]) * speed) > 0)
            return false;
        entry[k] = std::clamp((at.approximate() / speed.approximate()).rounded(), root.min[k],
                              root.max[k]);
    }
    entry[axis] = ray.direction[axis] > 0 ? root.min[axis] : root.max[axis];
    const double rounded = (way.approximate() / speed.approximate()).rounded();
    t = std::fmax(
        0, std::fmin(rounded, std::numeric_limits<double>::max() / 2) * (1 - 8 * kUnitRoundoff) -
               kUnderflow);
    return true;
}

}  // namespace detail

}  // namespace nuvo
