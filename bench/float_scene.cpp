#include "float_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nuvo::bench {
namespace {

void require(bool condition, const char* what) {
    if (!condition) throw std::invalid_argument(std::string("the comparison draws no ") + what);
}

FloatLight to_float(const Light& light) {
    require(light.scope == LightScope{}, "scoped lights");
    FloatLight out;
    out.kind = light.kind;
    out.color = Float3(light.color);
    out.intensity = static_cast<float>(light.intensity);
    out.ambient_intensity = static_cast<float>(light.ambient_intensity);
    out.direction = Float3(light.direction);
    out.location = Float3(light.location);
    out.attenuation = Float3(light.attenuation);
    out.radius = static_cast<float>(light.radius);
    out.units_per_world = static_cast<float>(light.units_per_world);
    out.beam_width = static_cast<float>(light.beam_width);
    out.cut_off_angle = static_cast<float>(light.cut_off_angle);
    out.casts_shadow = light.casts_shadow;
    return out;
}

FloatMaterial to_float(const Material& material) {
    require(material.lit, "unlit materials");
    return {Float3(material.diffuse_color),
            Float3(material.specular_color),
            Float3(material.emissive_color),
            static_cast<float>(material.ambient_intensity),
            static_cast<float>(128 * material.shininess),
            material.specular_color != Color{}};
}

/// Where an object's mesh begins in the shared arrays.
struct MeshStart {
    std::uint32_t position = 0;
    std::uint32_t normal = 0;
};

IndexTriple moved(const IndexTriple& corners, std::uint32_t by) {
    return {corners[0] + by, corners[1] + by, corners[2] + by};
}

MeshStart add_vertices(const TriangleMesh& mesh, FloatScene& out) {
    const MeshStart start{static_cast<std::uint32_t>(out.positions.size()),
                          static_cast<std::uint32_t>(out.normals.size())};
    for (const Point3& p : mesh.positions) out.positions.emplace_back(p);
    for (const Vector3& n : mesh.normals) out.normals.emplace_back(normalized(n));
    return start;
}

void add_triangle(const TriangleMesh& mesh, std::uint32_t triangle, MeshStart start,
                  FloatScene& out) {
    out.triangles.push_back(moved(mesh.triangles[triangle], start.position));
    if (mesh.normals.empty()) {
        out.normal_triangles.push_back({FloatScene::kFlat, 0, 0});
    } else {
        const auto& corners =
            mesh.normal_triangles.empty() ? mesh.triangles : mesh.normal_triangles;
        out.normal_triangles.push_back(moved(corners[triangle], start.normal));
    }
}

void add_primitives(const Scene& scene, const Primitives& primitives, FloatScene& out) {
    std::uint32_t current = ~std::uint32_t{0};
    MeshStart start;
    for (const PrimitiveSource& source : primitives.sources) {
        const Object& object = scene.objects[source.object];
        require(object.solid, "shapes that are not solid");
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            require(mesh->colors.empty(), "vertex colors");
            if (source.object != current) start = add_vertices(*mesh, out);
            add_triangle(*mesh, source.triangle, start, out);
            out.triangle_material.push_back(object.material);
        } else {
            const auto* sphere = std::get_if<Sphere>(&object.shape);
            require(sphere != nullptr, "ellipsoids");
            const Float3 center(sphere->center);
            out.spheres.push_back(
                {center.x, center.y, center.z, static_cast<float>(sphere->radius)});
            out.sphere_material.push_back(object.material);
        }
        current = source.object;
    }
}

}  // namespace

FloatScene to_float(const Scene& scene, const Primitives& primitives) {
    const Background& sky = scene.background;
    require(sky.sky_color.size() == 1 && sky.ground_color.size() == 1, "gradients of many colors");
    FloatScene out;
    add_primitives(scene, primitives, out);
    out.positions.emplace_back();
    if (out.normals.empty()) out.normal_triangles = {};
    for (const Material& material : scene.materials) out.materials.push_back(to_float(material));
    for (const Light& light : scene.lights) out.lights.push_back(to_float(light));
    out.sky = Float3(sky.sky_color[0]);
    out.ground = Float3(sky.ground_color[0]);
    out.camera = scene.camera;
    double largest = max_norm(scene.camera.position);
    for (const Bounds3& box : primitives.item_boxes)
        largest = std::max({largest, max_norm(box.min), max_norm(box.max)});
    out.largest_coordinate = static_cast<float>(largest);
    return out;
}

}  // namespace nuvo::bench
