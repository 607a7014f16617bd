#pragma once

#include <cstdint>

#include "fast/light/light_point.h"
#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "nuvo/render/fast.h"

// What a triangle hides from a light is a cone cut off by the triangle: the points on the inner
// side of the three planes through the light and an edge, and beyond the triangle's own (shadow
// volumes: Crow 1977, "Shadow algorithms for computer graphics"). All four are affine functions of
// the point, for a light at a place and for one in a direction alike; so a shadow ray against a
// triangle is 12 multiplications and additions and a minimum.

namespace nuvo {

/// Four functions n.P + w of a point P of the local frame, |n|_1 = 1, positive where the triangle
/// hides P from the light. The first three belong to the edges, the last to the triangle's plane.
/// One that double arithmetic cannot place well enough is 0 everywhere: it decides nothing.
struct alignas(64) ShadowPlanes {
    float plane[4][4];  ///< n, w
};

/// The planes of triangles as `light` sees them.
struct ShadowPlanesJob {
    const FastScene& scene;
    const LightPoint& light;
    ShadowPlanes* out;    ///< of place 0
    std::uint8_t* hides;  ///< by batch of 8: bit i says that triangle i may hide something
    const Light& exact_light;
};

/// Makes the records of a chunk, at its places, but for triangles that hide nothing: of those whose
/// back is invisible the light has to see the front. From a light that is not finite all may hide
/// something, and their planes decide nothing.
void make_shadow_planes(const ShadowPlanesJob& job, const TriangleChunk& chunk, InstructionSet isa);

}  // namespace nuvo
