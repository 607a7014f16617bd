#pragma once

#include <variant>

#include "nuvo/geometry/ellipsoid.h"
#include "nuvo/geometry/sphere.h"
#include "nuvo/geometry/triangle_mesh.h"

namespace nuvo {

/// What can be drawn: the thesis' tagged union of shapes, checked by the compiler. [thesis 5.2]
using Shape = std::variant<Sphere, Ellipsoid, TriangleMesh>;

Bounds3 bounds(const Shape& shape);

}  // namespace nuvo
