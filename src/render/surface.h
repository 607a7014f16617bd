#pragma once

#include "nuvo/math/vec.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// The unit normal that lighting uses on triangle `triangle` of a mesh, or on a sphere: the file's
/// interpolated normal where there is one [eq. 46], else the geometric one. On a shape that is not
/// solid it is negated when the geometric normal points away from the viewer.
Vector3 shading_normal(const Object& object, std::uint32_t triangle, const Vector3& geometric,
                       const Vec2<double>& uv, const Vector3& ray_direction);

}  // namespace nuvo
