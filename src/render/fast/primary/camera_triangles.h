#pragma once

#include <cmath>

#include "fast/primary/camera_tables.h"
#include "fast/scene/triangle_chunk.h"

namespace nuvo {

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

struct CameraTrianglesJob {
    const CameraRays& camera;
    Point3 eye;           ///< world space
    double scale;         ///< of the local frame
    CameraTriangle* out;  ///< of slot 0
    PixelBox* boxes;      ///< of slot 0
};

/// Makes the records and pixel boxes of a chunk.
void make_camera_triangles(const CameraTrianglesJob& job, const TriangleChunk& chunk,
                           InstructionSet isa);

}  // namespace nuvo
