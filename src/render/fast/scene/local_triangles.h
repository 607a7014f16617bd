#pragma once

#include "fast/scene/octant_tests.h"
#include "fast/scene/triangle_chunk.h"

namespace nuvo {

/// Triangles in the local frame and the boxes around them, rounded outwards.
struct LocalTrianglesJob {
    const LocalFrame& frame;
    LocalTriangle* triangles;  ///< of slot 0
    Bounds3T<float>* boxes;    ///< of slot 0
    std::uint8_t* front_only;  ///< of slots 0 to 7, a bit each, and so on
};

/// Makes those of a chunk.
void make_local_triangles(const LocalTrianglesJob& job, const TriangleChunk& chunk);

}  // namespace nuvo
