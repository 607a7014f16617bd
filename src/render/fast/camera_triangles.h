#pragma once

#include <cmath>

#include "camera_tables.h"

namespace nuvo {

/// What products of a table's floats lose below the normal range, a few of them with room for the
/// picture's size: added to every bound.
inline constexpr double kTableUnderflow = 0x1p-120;

/// How far pixel coordinates and directions reach.
struct CameraExtent {
    explicit CameraExtent(const CameraRays& camera)
        : x(0.5 * camera.resolution.width),
          y(0.5 * camera.resolution.height),
          direction(3 * (max_norm(camera.forward) + x * max_norm(camera.right) +
                         y * max_norm(camera.down))) {}

    double x;  ///< half the picture, pixels
    double y;
    double direction;  ///< bounds the sum of |components| of forward, X right and Y down
};

/// Fills the table and the boxes of all triangles.
void make_camera_triangles(InstructionSet isa, const FastScene& scene, const CameraRays& camera,
                           BigVector<CameraTriangle>& out, BigVector<PixelBox>& boxes);

}  // namespace nuvo
