#pragma once

#include <optional>

#include "nuvo/render/primitives.h"
#include "nuvo/render/shading.h"
#include "surface.h"

namespace nuvo {

/// The light that the material emits and reflects. [eq. 37] `unblocked(i)` is asked once, in order,
/// for each light i that reaches the point if nothing is in its way.
template <typename Surface, typename Unblocked>
Color lit_color(const Scene& scene, std::uint32_t object, const Material& material,
                const Surface& surface, const Ray& ray, Unblocked&& unblocked) {
    Color sum = material.emissive_color;
    if (!material.lit) return sum;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        if (!light.scope.includes(object)) continue;
        const std::optional<LightSample> sample = sample_light(light, surface.point);
        if (!sample || !unblocked(i)) continue;
        sum += light_contribution(light, *sample, material, surface.normal, -ray.direction);
    }
    return sum;
}

/// The material at `uv` of a primitive: with the mesh's color there, where it has colors.
inline Material material_at(const Scene& scene, const PrimitiveSource& source,
                            const Vec2<double>& uv) {
    const Object& object = scene.objects[source.object];
    const Material& own = scene.materials[object.material];
    const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
    if (mesh == nullptr || mesh->colors.empty()) return own;
    return with_color(own, mesh_color(*mesh, source.triangle, uv));
}

/// The color that `ray` (of unit direction) sees where it meets `hit`, in the one written order of
/// operations that every tracer repeats. `unblocked(surface, i)`: whether light i shines on it.
template <typename Kernel, typename Unblocked>
Color surface_color(const Scene& scene, const Kernel& kernel,
                    const typename Kernel::PreparedRay& prepared, const typename Kernel::Hit& hit,
                    const Ray& ray, Unblocked&& unblocked) {
    const PrimitiveSource& source = kernel.source(hit.primitive);
    const Object& object = scene.objects[source.object];
    const Material& own = scene.materials[object.material];
    const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
    const bool colored = mesh != nullptr && !mesh->colors.empty();
    if (!own.lit && !colored) return own.emissive_color;
    const auto surface = kernel.surface(prepared, hit, object);
    return lit_color(scene, source.object, material_at(scene, source, surface.uv), surface, ray,
                     [&](std::size_t light) { return unblocked(surface, light); });
}

}  // namespace nuvo
