#include "surface.h"

namespace nuvo {
namespace {

/// The corners' values at `uv`.
Vector3 blend(const std::vector<Vector3>& values, const IndexTriple& corner,
              const Vec2<double>& uv) {
    return values[corner[0]] * (1 - uv.x - uv.y) + values[corner[1]] * uv.x +
           values[corner[2]] * uv.y;
}

}  // namespace

Vector3 shading_normal(const Object& object, std::uint32_t triangle, const Vector3& geometric,
                       const Vec2<double>& uv, const Vector3& ray_direction) {
    Vector3 normal = geometric;
    const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
    if (mesh && !mesh->normals.empty()) {
        const auto& triangles =
            mesh->normal_triangles.empty() ? mesh->triangles : mesh->normal_triangles;
        const Vector3 unit = normalized(blend(mesh->normals, triangles[triangle], uv));
        if (unit != Vector3{}) normal = unit;
    }
    if (!object.solid && dot(geometric, ray_direction) > 0) normal = -normal;
    return normal;
}

Color mesh_color(const TriangleMesh& mesh, std::uint32_t triangle, const Vec2<double>& uv) {
    const auto& triangles = mesh.color_triangles.empty() ? mesh.triangles : mesh.color_triangles;
    return blend(mesh.colors, triangles[triangle], uv);
}

Material with_color(Material material, const Color& color) {
    (material.lit ? material.diffuse_color : material.emissive_color) = color;
    return material;
}

}  // namespace nuvo
