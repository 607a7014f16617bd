#pragma once

#include <cstdint>

#include "fast/rays/wide_octree.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/ray.h"

// One ray in the local frame, prepared for float walks with proven margins.
//
// In the local frame the ray is o + s d with |d| in [1, 2) in the largest component: the direction
// was scaled by a power of two, exactly. A far origin first moves along the ray to just before the
// root, by `advance`. What that and the double roundings of o and o + s d can shift a point of the
// ray within the root's box is `error`, a bound for each axis.
//
// The plane x = c is met at s = (c - o) / d. The walk computes fl(c i + a) with i = fl(1 / fl(d))
// and a = fl(-o i): i is off by 2 u + u^2 relatively and the sum by at most three roundings of
// |c i| + |o i|, so that s is off by less than 6 u (|c| + |o|) |i| + error |i| (u = 2^-24). a is
// made smaller for near faces and larger for far ones by `kSlabRoundings` instead of 6.

namespace nuvo {

inline constexpr double kSlabRoundings = 8;

struct LocalRay {
    /// False where the numbers leave the range of the bounds: the ray is not to be walked.
    bool valid = false;
    /// Components of d are kept off 0 by this; s d stays as near to the ray as slabs are wide.
    static constexpr float kLeastDirection = 0x1p-60F;

    float inverse[3];
    float near_add[3];
    float far_add[3];
    std::uint32_t signs;  ///< of d, 1 x + 2 y + 4 z: which of WideNode::order
    float direction[3];
    float square;      ///< |d|^2 rounded
    float behind;      ///< the true origin's s, or between it and all that may be met
    float least_unit;  ///< leaves with a finer grid are not tested in float
    double origin[3];
    double step[3];      ///< d
    double error = 0;    ///< see above
    double advance = 0;  ///< in units of d
    double scale = 1;    ///< s + advance = t * scale, a power of two

    LocalRay() = default;
    LocalRay(const Ray& ray, const LocalFrame& frame, float reach);

  private:
    void prepare_slabs(float reach);
};

}  // namespace nuvo
