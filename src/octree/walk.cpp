#include "nuvo/octree/walk.h"

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/exact.h"

namespace nuvo {

double path_error_bound(const Bounds3& root) {
    const double size = std::fmax(max_norm(root.min), max_norm(root.max));
    return 16 * kUnitRoundoff * size;
}

namespace detail {

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
