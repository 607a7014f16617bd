#pragma once

#include <cstddef>
#include <functional>

#include "polygons.h"

namespace nuvo::x3d {

/// Fills `cuts` so that the triangles of every polygon cover it, concave or not: those that are
/// convex as fans, the others by a constrained Delaunay triangulation in the plane. A polygon of n
/// corners gets n - 2 triangles, where need be ones of zero area. Leaves `cuts` empty where fans do
/// for all. Returns how many polygons could not be cut (they cross themselves) and are fans.
/// A cut may take time quadratic in n: `before_cut(n)` is called first and may throw.
std::size_t cut_concave(Polygons& polygons,
                        const std::function<void(std::size_t corners)>& before_cut);

}  // namespace nuvo::x3d
