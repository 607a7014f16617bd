#pragma once

#include "nuvo/math/vec.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// The unit normal that lighting uses on triangle `triangle` of a mesh, or on a sphere: the file's
/// interpolated normal where there is one [eq. 46], else the geometric one. On a shape that is not
/// solid it is negated when the geometric normal points away from the viewer.
Vector3 shading_normal(const Object& object, std::uint32_t triangle, const Vector3& geometric,
                       const Vec2<double>& uv, const Vector3& ray_direction);

/// The color that `triangle` of the mesh has at `uv` in place of its material's, blended between
/// its corners. The mesh has colors.
Color mesh_color(const TriangleMesh& mesh, std::uint32_t triangle, const Vec2<double>& uv);

/// `material` with `color` as its diffuse color, or as its emissive one where it is unlit.
Material with_color(Material material, const Color& color);

}  // namespace nuvo
