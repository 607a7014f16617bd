#pragma once

#include <cmath>

#include "fast/camera/camera_tables.h"
#include "fast/scene/triangle_chunk.h"

namespace nuvo {

/// How far pixel coordinates and directions reach: over the picture and the middles of its tiles,
/// from which functions are evaluated. A tile that sticks out has its middle less than half a
/// tile outside.
struct CameraExtent {
    explicit CameraExtent(const CameraRays& camera)
        : x(0.5 * (camera.resolution.width + kTileSide)),
          y(0.5 * (camera.resolution.height + kTileSide)),
          direction(3 * (max_norm(camera.forward) + x * max_norm(camera.right) +
                         y * max_norm(camera.down))) {}

    double x;  ///< pixels
    double y;
    double direction;  ///< bounds the sum of |components| of forward, X right and Y down
};

struct CameraTrianglesJob {
    const CameraRays& camera;
    Point3 eye;    ///< world space
    double scale;  ///< of the local frame
};

/// The record of a triangle of which double arithmetic cannot tell it, and no pixels at all where
/// the eye lies in its plane or behind a front that alone is visible: from there it is never hit.
void make_exact_camera_triangle(const CameraTrianglesJob& job, const Triangle& triangle,
                                bool front_only, CameraTriangle& out, PixelBox& box);

}  // namespace nuvo
