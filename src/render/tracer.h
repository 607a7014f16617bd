#pragma once

#include "nuvo/render/render.h"
#include "nuvo/render/shading.h"
#include "surface.h"

namespace nuvo {

/// Is told nothing, at no cost.
struct NoObserver {
    void hit(PrimitiveId) const {}
    void lit(std::size_t) const {}
};

/// The serial reference tracer: one primary ray a pixel, one shadow ray a light that reaches the
/// hit point, no recursion. [thesis 4.1, 4.3.2, 5.3.2] `Kernel` decides how exact, `Search` how
/// fast.
template <typename Kernel, typename Search>
class Tracer {
  public:
    Tracer(const Scene& scene, const Kernel& kernel, Search search)
        : scene_(scene), kernel_(kernel), search_(std::move(search)) {}

    Image image(Resolution resolution) {
        Image image(resolution.width, resolution.height);
        const RayGenerator rays(scene_.camera, resolution);
        for (int y = 0; y < resolution.height; ++y)
            for (int x = 0; x < resolution.width; ++x)
                image.at(x, y) = quantized(color(rays.ray(x, y)));
        return image;
    }

    /// [eq. 36, 37] `ray` has unit direction. `observer` hears of the nearest primitive and of
    /// each light that reaches it.
    template <typename Observer = NoObserver>
    Color color(const Ray& ray, Observer&& observer = {}) {
        ++primary_rays_;
        const auto prepared = kernel_.prepare(ray);
        const auto hit = search_.closest(prepared);
        if (!hit) return scene_.background.color(ray.direction);
        observer.hit(hit->primitive);
        const std::uint32_t index = kernel_.source(hit->primitive).object;
        const Object& object = scene_.objects[index];
        const Material& own = scene_.materials[object.material];
        const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        const bool colored = mesh != nullptr && !mesh->colors.empty();
        if (!own.lit && !colored) return own.emissive_color;
        const auto surface = kernel_.surface(prepared, *hit, object);
        if (!colored) return lit(index, own, surface, ray, observer);
        const std::uint32_t triangle = kernel_.source(hit->primitive).triangle;
        const Color vertex_color = mesh_color(*mesh, triangle, surface.uv);
        return lit(index, with_color(own, vertex_color), surface, ray, observer);
    }

    std::uint64_t primary_rays() const { return primary_rays_; }
    std::uint64_t shadow_rays() const { return shadow_rays_; }

  private:
    // The light that the material emits and reflects. [eq. 37]
    template <typename Surface, typename Observer>
    Color lit(std::uint32_t index, const Material& material, const Surface& surface, const Ray& ray,
              Observer& observer) {
        Color sum = material.emissive_color;
        if (!material.lit) return sum;
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const Light& light = scene_.lights[i];
            if (!light.scope.includes(index)) continue;
            const std::optional<LightSample> sample = sample_light(light, surface.point);
            if (!sample || (light.casts_shadow && blocked(surface, light))) continue;
            observer.lit(i);
            sum += light_contribution(light, *sample, material, surface.normal, -ray.direction);
        }
        return sum;
    }

    template <typename Surface>
    bool blocked(const Surface& surface, const Light& light) {
        ++shadow_rays_;
        return search_.occluded(kernel_.shadow(surface, light));
    }

    const Scene& scene_;
    const Kernel& kernel_;
    Search search_;
    std::uint64_t primary_rays_ = 0;
    std::uint64_t shadow_rays_ = 0;
};

}  // namespace nuvo
