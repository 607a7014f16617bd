#pragma once

#include "compact_cut.h"

namespace nuvo {

/// On each axis the plane for which the surface area heuristic of the two sides is least, or the
/// upper face where no plane is better than none.
Vec3<float> sweep_planes(const Bounds3T<float>& voxel, ItemSpan items, BoxSpan boxes);

}  // namespace nuvo
