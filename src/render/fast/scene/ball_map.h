#pragma once

#include "fast/scene/local_frame.h"
#include "nuvo/geometry/ellipsoid.h"
#include "nuvo/math/affine.h"

namespace nuvo {

/// Makes a ball of an ellipsoid: p, seen from its centre in the local frame, becomes to_ball p.
/// Lines stay lines, and what lies inside stays inside, so spheres' tests serve for ellipsoids.
/// [numerics: ellipsoids as balls]
struct BallMap {
    Point3 center;      ///< in the local frame, rounded
    Matrix3 to_ball;    ///< shortens nothing (in largest components)
    Matrix3 from_unit;  ///< from the unit ball: the columns are half axes
    double radius;      ///< of the ball: a power of two
    double stretch;     ///< bounds |to_ball v| / |v|, largest components
    double error;       ///< bounds the same of what to_ball is off by
    bool sure;          ///< false: too flat, floats cannot tell
};
BallMap ball_map(const Ellipsoid& ellipsoid, const LocalFrame& frame);

}  // namespace nuvo
