#include <cmath>

#include "nuvo/app/choices.h"
#include "nuvo/app/pixel.h"
#include "nuvo/app/report.h"
#include "pixel_words.h"
#include "text.h"

namespace nuvo::app {
namespace {

std::string triple(const Vec3<double>& v) { return format("%.9g %.9g %.9g", v.x, v.y, v.z); }

/// "triangle 3 of shape 12", "sphere, shape 4".
std::string primitive_text(const Scene& scene, const Primitives& primitives, PrimitiveId id) {
    const PrimitiveSource& source = primitives.sources[id];
    const Object& object = scene.objects[source.object];
    const std::string kind(kind_word(kind_of(object.shape)));
    if (kind_of(object.shape) == PrimitiveKind::kTriangle)
        return kind + format(" %u of shape %u", source.triangle, object.shape_index);
    return kind + format(", shape %u", object.shape_index);
}

class Writer {
  public:
    Writer(const Scene& scene, const Primitives& primitives, const Profile& profile)
        : scene_(scene), primitives_(primitives), profile_(profile) {}

    void line(int level, const std::string& text) {
        text_ += std::string(static_cast<std::size_t>(2 * level), ' ') + text + '\n';
    }
    void ray(int level, const char* name, const RayStory& ray, const char* yes) {
        line(level,
             format("%s from %s along %s", name, triple(ray.ray.origin).c_str(),
                    triple(ray.ray.direction).c_str()) +
                 (std::isfinite(ray.t_end) ? format(" to t = %.9g", ray.t_end) : "") + ": " +
                 counted(ray.voxels.size(), "voxel") + ", " +
                 counted(ray.intersection_tests(), "test") + " of an item, " +
                 format("%llu voxel searches", static_cast<unsigned long long>(ray.searches)));
        for (const TestStory& test : ray.before) tested(level + 1, test, yes);
        for (const VoxelStory& voxel : ray.voxels) {
            line(level + 1,
                 format("voxel %llu, t %.9g to %.9g, box [%s] [%s], %s",
                        static_cast<unsigned long long>(voxel.name), voxel.t_in, voxel.t_out,
                        triple(voxel.box.min).c_str(), triple(voxel.box.max).c_str(),
                        counted(voxel.items, "item").c_str()));
            for (const TestStory& test : voxel.tests) tested(level + 2, test, yes);
        }
    }
    void surface(const SurfaceStory& surface) {
        line(0, format("hit        %s at t = %.17g",
                       primitive_text(scene_, primitives_, surface.primitive).c_str(), surface.t));
        if (!surface.point) return;
        line(1, "point " + triple(*surface.point) + ", normal " + triple(*surface.normal));
        const Material& m = surface.material;
        line(1, "material diffuse " + triple(m.diffuse_color) + ", specular " +
                    triple(m.specular_color) + ", emissive " + triple(m.emissive_color) +
                    format(", ambient %.9g, shininess %.9g", m.ambient_intensity, m.shininess));
        for (std::size_t i = 0; i < surface.lights.size(); ++i) light(i, surface.lights[i]);
    }
    void color(const PixelStory& story) {
        std::string terms = story.surface
                                ? "emissive " + triple(story.surface->material.emissive_color)
                                : "background";
        if (story.surface)
            for (std::size_t i = 0; i < story.surface->lights.size(); ++i)
                if (story.surface->lights[i].end == LightStory::End::kLit)
                    terms += format(" + light %zu", i);
        line(0, "color      " + terms + " = " + triple(story.color));
        line(0, format("bytes      %d %d %d", story.bytes.r, story.bytes.g, story.bytes.b));
    }
    const std::string& text() const { return text_; }

  private:
    void tested(int level, const TestStory& test, const char* yes) {
        line(level, primitive_text(scene_, primitives_, test.primitive) + ": " +
                        (!test.hit ? "no"
                         : test.t  ? format("%s at t = %.9g", yes, *test.t)
                                   : yes) +
                        " (" + std::string(stage_word(profile_.precision, test.stage)) + ")");
    }
    void light(std::size_t index, const LightStory& story) {
        line(1, format("light %zu, %s: %s", index,
                       std::string(kind_word(scene_.lights[index].kind)).c_str(),
                       std::string(end_word(story.end)).c_str()));
        if (story.shadow) ray(2, "shadow ray", *story.shadow, "in the way");
        if (!story.sample) return;
        line(2, format("strength %.9g, towards %s", story.sample->strength,
                       triple(story.sample->to_light).c_str()));
        line(2, "ambient " + triple(story.terms.ambient) + ", diffuse " +
                    triple(story.terms.diffuse) + ", specular " + triple(story.terms.specular));
        line(2, "adds " + triple(story.adds));
    }

    const Scene& scene_;
    const Primitives& primitives_;
    const Profile& profile_;
    std::string text_;
};

}  // namespace

std::string pixel_text(const Options& options, const Scene& scene, const Primitives& primitives,
                       const PixelReport& report) {
    Writer out(scene, primitives, report.profile);
    Options walk = options;
    walk.profile = report.profile;
    out.line(0, "scene      " + report.file);
    out.line(0, "walk       " + profile_flags_text(walk));
    out.line(0, format("pixel      %d,%d of %d x %d", report.x, report.y, options.resolution.width,
                       options.resolution.height));
    out.ray(0, "ray       ", report.story.primary, "hit");
    if (report.story.surface)
        out.surface(*report.story.surface);
    else
        out.line(0, "hit        nothing");
    out.color(report.story);
    return out.text();
}

}  // namespace nuvo::app
