#pragma once

#include "fast/scene/local_frame.h"
#include "nuvo/math/ray.h"

// One ray in the local frame, prepared for float walks with proven margins.
//
// In the local frame the ray is o + s d with |d| in [1, 2) in the largest component: the direction
// was scaled by a power of two, exactly. A far origin first moves along the ray to just before the
// octree's box, by `advance`. What that and the double roundings of o and o + s d can shift a point
// of the ray within that box is `error`, a bound for each axis.

namespace nuvo {

struct LocalRay {
    /// False where the numbers leave the range of the bounds: the ray is not to be walked.
    bool valid = false;
    double origin[3];
    double step[3];      ///< d
    double error = 0;    ///< see above
    double advance = 0;  ///< in units of d
    double scale = 1;    ///< s + advance = t * scale, a power of two
    float behind = 0;    ///< the true origin's s, or between it and all that may be met

    LocalRay(const Ray& ray, const LocalFrame& frame, float reach);
};

}  // namespace nuvo
