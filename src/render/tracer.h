#pragma once

#include "nuvo/math/progress.h"
#include "nuvo/render/render.h"
#include "nuvo/render/shading.h"
#include "surface_color.h"

namespace nuvo {

/// Is told nothing, at no cost.
struct NoObserver {
    template <typename Hit>
    void hit(const Hit&) const {}
    template <typename Surface>
    void asks(const Surface&, std::size_t) const {}
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

    Image image(Resolution resolution, Progress* progress = nullptr) {
        Image image(resolution.width, resolution.height);
        const RayGenerator rays(scene_.camera, resolution);
        begin(progress, "pixels", pixel_count(resolution));
        for (int y = 0; y < resolution.height; ++y) {
            for (int x = 0; x < resolution.width; ++x)
                image.at(x, y) = quantized(color(rays.ray(x, y)));
            add(progress, static_cast<std::uint64_t>(resolution.width));
        }
        return image;
    }

    /// [eq. 36, 37] `ray` has unit direction. `observer` hears of the nearest hit, of each light
    /// that shines on the surface there unless something stands between, and of each that does.
    template <typename Observer = NoObserver>
    Color color(const Ray& ray, Observer&& observer = {}) {
        ++primary_rays_;
        const auto prepared = kernel_.prepare(ray);
        const auto hit = search_.closest(prepared);
        if (!hit) return scene_.background.color(ray.direction);
        observer.hit(*hit);
        return surface_color(
            scene_, kernel_, prepared, *hit, ray, [&](const auto& surface, std::size_t light) {
                observer.asks(surface, light);
                if (scene_.lights[light].casts_shadow && blocked(surface, scene_.lights[light]))
                    return false;
                observer.lit(light);
                return true;
            });
    }

    std::uint64_t primary_rays() const { return primary_rays_; }
    std::uint64_t shadow_rays() const { return shadow_rays_; }

  private:
    template <typename Surface>
    bool blocked(const Surface& surface, const Light& light) {
        ++shadow_rays_;
        const auto shadow = kernel_.shadow(surface, light);
        const auto occluded = [&](const auto& way) { return search_.occluded(way); };
        if constexpr (requires { kernel_.any_way(shadow, occluded); })
            return kernel_.any_way(shadow, occluded);
        else
            return occluded(shadow);
    }

    const Scene& scene_;
    const Kernel& kernel_;
    Search search_;
    std::uint64_t primary_rays_ = 0;
    std::uint64_t shadow_rays_ = 0;
};

}  // namespace nuvo
