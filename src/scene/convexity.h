#pragma once

#include <cstddef>

#include "polygons.h"

namespace nuvo::x3d {

/// How many polygons are clearly not convex, seen along their area vector: they turn the other way
/// at a corner, or go round more than once. What roundings of coordinates to six digits may have
/// done is not counted. Takes time linear in the corners.
std::size_t count_concave(const Polygons& polygons, int threads);

}  // namespace nuvo::x3d
