#include "fast/tile/local_ray.h"

#include <algorithm>
#include <cmath>

#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

// The ray enters the box around 0 with this half width later than this, if it does. Axes along
// which the ray hardly moves are left out.
double before_box(const Point3& o, const Vector3& d, double half) {
    constexpr double kHardly = 0x1p-20;
    double entry = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(d[axis]) < kHardly) continue;
        const double near = d[axis] > 0 ? -half : half;
        entry = std::max(entry, (near - o[axis]) / d[axis]);
    }
    return entry;
}

// A point in twice the precision of a double: high + low.
struct DoublePoint {
    Point3 high;
    Vector3 low;

    // this + d * way, off by less than 2^-98 (|this| + |d| way) on each axis, once. (Dekker 1971)
    void move(const Vector3& d, double way) {
        for (int axis = 0; axis < 3; ++axis) {
            const double product = d[axis] * way;
            const double rest = std::fma(d[axis], way, -product);
            const TwoTerms sum = two_diff(high[axis], -product);
            const double tail = sum.error + (low[axis] + rest);
            high[axis] = sum.value + tail;
            low[axis] = tail - (high[axis] - sum.value);
        }
    }
};

DoublePoint local_point(const LocalFrame& frame, const Point3& p) {
    DoublePoint out;
    for (int axis = 0; axis < 3; ++axis) {
        const TwoTerms difference = two_diff(p[axis], frame.center[axis]);
        out.high[axis] = difference.value * frame.scale;
        out.low[axis] = difference.error * frame.scale;
    }
    return out;
}

}  // namespace

LocalRay::LocalRay(const Ray& ray, const LocalFrame& frame, float reach) {
    // Where neither a scaled direction nor a scaled coordinate is subnormal or overflows.
    constexpr double kRange = 0x1p900;
    const double size = max_norm(ray.direction);
    Point3 o = frame.local(ray.origin);
    const double far = max_norm(o);
    if (!(size > 1 / kRange && size < kRange && far < kRange)) return;
    const double unit = std::ldexp(1.0, -std::ilogb(size));
    const Vector3 d = ray.direction * unit;
    scale = frame.scale / unit;
    if (!(scale > 1 / kRange && scale < kRange)) return;

    constexpr double kNear = 4;  // origins within this are as good as in the box
    error = 0x1p-50 * (far + kNear);
    if (far > kNear) {
        DoublePoint point = local_point(frame, ray.origin);
        // The way is rounded, so that the first one may end as far as 2^-50 of itself before the
        // box, which is 1 away then.
        constexpr int kTries = 3;
        for (int i = 0; i < kTries && max_norm(point.high) > kNear; ++i) {
            const double way = before_box(point.high, d, reach + 1.0) * (1 - 0x1p-50);
            if (!(way > 0)) break;
            point.move(d, way);
            advance += way;
        }
        o = point.high;
        error = 0x1p-50 * (max_norm(o) + kNear) + kTries * 0x1p-96 * (far + advance);
    }
    // So all numbers of the slabs, at most 2^60 times these, stay finite as floats: an infinite one
    // would let the ray into the boxes of unused lanes.
    constexpr double kFarthest = 0x1p60;
    valid = max_norm(o) < kFarthest && error < kFarthest;
    if (!valid) return;
    // After an advance nothing is met before s = 1/2: the box is 1 away on an axis, and |d| < 2.
    behind = advance > 0 ? -0.25F : 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = o[axis];
        step[axis] = d[axis];
    }
}

}  // namespace nuvo
