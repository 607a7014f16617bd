#include "nuvo/render/explain.h"

#include "chosen.h"
#include "nuvo/math/error_bounds.h"
#include "storyteller.h"
#include "tracer.h"

namespace nuvo {
namespace {

// Hears from the tracer what the searches do not tell: whose rays they follow.
template <typename Kernel>
class Listener {
  public:
    Listener(const Scene& scene, const Kernel& kernel, Storyteller& teller, PixelStory& story)
        : scene_(scene), kernel_(kernel), teller_(teller), story_(story) {}

    void hit(const typename Kernel::Hit& hit) {
        nearest_ = hit;
        const PrimitiveSource& source = kernel_.source(hit.primitive);
        SurfaceStory& surface = story_.surface.emplace();
        surface.primitive = hit.primitive;
        surface.shape = scene_.objects[source.object].shape_index;
        surface.triangle = source.triangle;
        surface.t = static_cast<double>(kernel_.t(hit));
    }
    template <typename Surface>
    void asks(const Surface& surface, std::size_t index) {
        const Light& light = scene_.lights[index];
        LightStory& story = light_story(index);
        story.end = LightStory::End::kBlocked;
        story.sample = sample_light(light, surface.point);
        if (!light.casts_shadow) return;
        const auto shadow = kernel_.shadow(surface, light);
        const Ray ray = kernel_.walk_ray(shadow.ray);
        teller_.begin(story.shadow.emplace(), ray, static_cast<double>(shadow.end));
    }
    void lit(std::size_t index) { light_story(index).end = LightStory::End::kLit; }

    const std::optional<typename Kernel::Hit>& nearest() const { return nearest_; }

  private:
    LightStory& light_story(std::size_t index) {
        story_.surface->lights.resize(scene_.lights.size());
        return story_.surface->lights[index];
    }

    const Scene& scene_;
    const Kernel& kernel_;
    Storyteller& teller_;
    PixelStory& story_;
    std::optional<typename Kernel::Hit> nearest_;
};

// The terms of each light's part, by the functions that shade, and why others have none.
template <typename Surface>
void add_terms(const Scene& scene, std::uint32_t object, const Surface& at, const Ray& ray,
               SurfaceStory& story) {
    story.point = at.point;
    story.normal = at.normal;
    story.lights.resize(scene.lights.size());
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        LightStory& told = story.lights[i];
        if (!told.sample) {
            if (light.scope.includes(object)) told.end = LightStory::End::kTooFar;
            continue;
        }
        told.terms = light_terms(light, *told.sample, story.material, at.normal, -ray.direction);
        if (told.end == LightStory::End::kLit)
            told.adds =
                light_contribution(light, *told.sample, story.material, at.normal, -ray.direction);
    }
}

// The surface as the tracer finds it once more.
template <typename Kernel, typename Hit>
void describe_surface(const Scene& scene, const Kernel& kernel, const Ray& ray, const Hit& hit,
                      SurfaceStory& story) {
    const PrimitiveSource& source = kernel.source(hit.primitive);
    const Object& object = scene.objects[source.object];
    const auto surface = kernel.surface(kernel.prepare(ray), hit, object);
    story.material = material_at(scene, source, surface.uv);
    if (story.material.lit) add_terms(scene, source.object, surface, ray, story);
}

}  // namespace

PixelStory explain_pixel(const Scene& scene, const Primitives& primitives, const Octree& octree,
                         const Profile& profile, Resolution resolution, int x, int y) {
    PixelStory story;
    Storyteller teller;
    const Ray ray = RayGenerator(scene.camera, resolution).ray(x, y);
    teller.begin(story.primary, ray, kInfinity);
    with_kernel(scene, primitives, profile, [&](const auto& plain) {
        const TellingKernel kernel(plain, teller);
        Listener listener(scene, kernel, teller, story);
        with_search(kernel, primitives, octree, profile, TellingCounter{&teller}, [&](auto search) {
            story.color = Tracer(scene, kernel, std::move(search)).color(ray, listener);
        });
        if (const auto& hit = listener.nearest())
            describe_surface(scene, plain, ray, *hit, *story.surface);
    });
    story.bytes = quantized(story.color);
    return story;
}

}  // namespace nuvo
