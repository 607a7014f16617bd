#pragma once

#include "fast/light/light_point.h"
#include "fast/light/shadow_geometry.h"
#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// The planes of triangles as `light` sees them. `reach` bounds the coordinates of the scene in the
/// local frame.
struct ShadowPlanesJob {
    const FastScene& scene;
    const LightPoint& light;
    double reach;
    ShadowPlanes* out;    ///< of place 0
    std::uint8_t* hides;  ///< by batch of 8: bit i says that triangle i may hide something
    const Light& exact_light;
};

/// Makes the records of a chunk, at its places, but for triangles that hide nothing: of those whose
/// back is invisible the light has to see the front. From a light that is not finite all may hide
/// something, and their planes decide nothing.
void make_shadow_planes(const ShadowPlanesJob& job, const TriangleChunk& chunk, InstructionSet isa);

/// On which side of the triangle's plane the light stands, exactly: the sign of n.(L - a), or of
/// n.d for a direction d to the light; n = (b - a) x (c - a).
int exact_light_side(const Light& light, const Triangle& triangle);

}  // namespace nuvo
