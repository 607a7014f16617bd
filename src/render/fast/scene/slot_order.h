#pragma once

#include <vector>

#include "nuvo/render/primitives.h"

// Tables by slot are read all over by rays that are near each other. Shapes near in space get slots
// near each other along a Z-order curve (Morton 1966), so that a line of a cache, or a page, serves
// several of them. Triangles of a mesh are near each other already.

namespace nuvo {

/// Sorts `ids` along a Z-order curve through `box`, which encloses all primitives, by the middle of
/// each primitive's box. A few, whose tables fit into a cache anyway, stay as they are.
void sort_in_space(const Primitives& primitives, const Bounds3& box, std::vector<PrimitiveId>& ids);

}  // namespace nuvo
