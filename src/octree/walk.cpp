#include "nuvo/octree/walk.h"

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/exact.h"

namespace nuvo {

double path_error_bound(const Bounds3& root) {
    return 16 * kUnitRoundoff * detail::size_of(root) + 32 * kUnderflow;
}

namespace detail {

// Halfway between the exponents of the largest distance and of the root, so that the largest t does
// not overflow and the root's are not subnormal.
int scale_direction(const Bounds3& root, const Point3& origin, Vector3& direction) {
    const double size = size_of(root);
    const int wanted = (std::ilogb(std::fmax(size, kUnderflow)) +
                        std::ilogb(std::fmax(std::fmax(size, max_norm(origin)), kUnderflow))) /
                       2;
    const int shift = std::clamp(wanted, -500, 500) - std::ilogb(max_norm(direction));
    for (int axis = 0; axis < 3; ++axis) direction[axis] = std::ldexp(direction[axis], shift);
    return shift;
}

bool approach(const Ray& ray, const Bounds3& root, Point3& origin, double& base) {
    const ExactVector direction(ray.direction);
    ExactVector point(ray.origin);
    origin = ray.origin;
    base = 0;
    // A step leaves 8 roundings of its length to go, so that few are needed; the ray may also pass
    // the root beside, and then nothing brings it near.
    constexpr int kEnoughSteps = 64;
    for (int i = 0; i < kEnoughSteps && is_far(origin, root); ++i) {
        const std::optional<Entry> entry = slab_entry({origin, ray.direction}, root);
        if (!entry) return false;
        const double step = entry->before();
        if (!(step > 0)) break;
        point = point + direction * Exact(step);
        base += step;
        origin = {point.x.approximate().rounded(), point.y.approximate().rounded(),
                  point.z.approximate().rounded()};
    }
    return true;
}

}  // namespace detail

}  // namespace nuvo
