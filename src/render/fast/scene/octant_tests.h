#pragma once

#include <cstdint>
#include <span>

#include "fast/scene/local_frame.h"
#include "nuvo/octree/compact_build.h"

namespace nuvo {

/// Clears in masks[i] the octants whose closed box triangles[items[i]] surely does not touch:
/// the separating axes of Akenine-Moeller (2001) as edge functions, after Schwarz and Seidel
/// (2010).
void clear_octants(std::span<const LocalTriangle> triangles, const CutVoxel& voxel,
                   std::span<const std::uint32_t> items, std::span<std::uint8_t> masks);

/// The same for the surfaces of spheres[items[i] - first]; an octant wholly inside a sphere does
/// not touch it.
void clear_octants(std::span<const LocalSphere> spheres, std::uint32_t first, const CutVoxel& voxel,
                   std::span<const std::uint32_t> items, std::span<std::uint8_t> masks);

}  // namespace nuvo
