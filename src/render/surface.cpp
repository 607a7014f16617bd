#include "surface.h"

namespace nuvo {

Vector3 shading_normal(const Object& object, std::uint32_t triangle, const Vector3& geometric,
                       const Vec2<double>& uv, const Vector3& ray_direction) {
    Vector3 normal = geometric;
    const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
    if (mesh && !mesh->normals.empty()) {
        const auto& triangles =
            mesh->normal_triangles.empty() ? mesh->triangles : mesh->normal_triangles;
        const IndexTriple& corner = triangles[triangle];
        const Vector3 blended = mesh->normals[corner[0]] * (1 - uv.x - uv.y) +
                                mesh->normals[corner[1]] * uv.x + mesh->normals[corner[2]] * uv.y;
        const Vector3 unit = normalized(blended);
        if (unit != Vector3{}) normal = unit;
    }
    if (!object.solid && dot(geometric, ray_direction) > 0) normal = -normal;
    return normal;
}

}  // namespace nuvo
