#pragma once

#include "aims.h"
#include "random.h"

/// How the scenes of random pictures are lit, and what they are made of.
namespace nuvo::hard {

/// Lamps on corners, edges and surfaces, within objects, far away, and a sun along an axis.
void light_from_hard_places(Scene& scene, Aims& aims, Random& random);
/// One to four lights of every kind, aimed at objects, with cones, attenuations, radii, colors and
/// scopes; a material for each object; blended normals and colors on half of the meshes.
void light_richly(Scene& scene, Aims& aims, Random& random);

}  // namespace nuvo::hard
