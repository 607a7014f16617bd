#pragma once

#include <cmath>

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/bounds.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {

/// False: the ray surely does not meet the box at any 0 <= t <= end. A quotient carries the
/// roundings of the difference, of the direction and its own; half of the slack outweighs them. A
/// NaN counts as met.
inline bool may_meet(const ExactRay& ray, double end, const Bounds3& box) {
    constexpr double kSlack = 8 * kUnitRoundoff;
    double first = 0;
    double last = end;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction()[axis];
        if (d == 0) continue;
        const double low = (box.min[axis] - ray.origin()[axis]) / d;
        const double high = (box.max[axis] - ray.origin()[axis]) / d;
        const double near = d > 0 ? low : high;
        const double far = d > 0 ? high : low;
        const double entry = near - (kSlack * std::fabs(near) + 4 * kUnderflow);
        const double exit = far + (kSlack * std::fabs(far) + 4 * kUnderflow);
        if (entry > first) first = entry;
        if (exit < last) last = exit;
    }
    return !(first > last);
}

}  // namespace nuvo
