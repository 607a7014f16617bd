#pragma once

#include <cstddef>

#include "polygons.h"

namespace nuvo::x3d {

/// True where polygon i is clearly not convex, seen along its area vector: it turns the other way
/// at a corner, or goes round more than once. What roundings of coordinates to six digits may have
/// done is not counted. Takes time linear in the corners, little where `plane`, 0 at first and kept
/// from polygon to polygon, is a coordinate plane in which this one is convex, too.
bool is_concave(const Polygons& polygons, std::size_t i, int& plane);

}  // namespace nuvo::x3d
