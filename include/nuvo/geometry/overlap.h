#pragma once

#include "nuvo/geometry/sphere.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/bounds.h"

namespace nuvo {

/// False only when the triangle surely has no point in the closed box: the separating axes of
/// Akenine-Moeller (2001), each widened by its rounding error.
bool overlaps(const Triangle& triangle, const Bounds3& box);

/// False only when the sphere's surface surely has no point in the closed box; a box wholly inside
/// the sphere does not overlap it. [COMP1011]
bool overlaps(const Sphere& sphere, const Bounds3& box);

}  // namespace nuvo
