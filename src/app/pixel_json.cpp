#include "nuvo/app/json_writer.h"
#include "nuvo/app/pixel.h"
#include "options_json.h"
#include "pixel_words.h"

namespace nuvo::app {
namespace {

void write_triple(JsonWriter& json, std::string_view name, const Vec3<double>& v) {
    json.member(name, std::vector<double>{v.x, v.y, v.z});
}

class Writer {
  public:
    Writer(JsonWriter& json, const Scene& scene, const Primitives& primitives,
           const Profile& profile)
        : json_(json), scene_(scene), primitives_(primitives), profile_(profile) {}

    void ray(std::string_view name, const RayStory& ray) {
        json_.key(name);
        json_.begin_object();
        write_triple(json_, "origin", ray.ray.origin);
        write_triple(json_, "direction", ray.ray.direction);
        json_.member("t_end", ray.t_end);
        json_.member("intersection_tests", ray.intersection_tests());
        json_.member("voxel_searches", ray.searches);
        if (!ray.before.empty()) tests("itself", ray.before);
        json_.key("voxels");
        json_.begin_array();
        for (const VoxelStory& voxel : ray.voxels) {
            json_.begin_object();
            json_.member("name", std::to_string(voxel.name));
            write_triple(json_, "min", voxel.box.min);
            write_triple(json_, "max", voxel.box.max);
            json_.member("t_in", voxel.t_in);
            json_.member("t_out", voxel.t_out);
            json_.member("items", voxel.items);
            tests("tests", voxel.tests);
            json_.end_object();
        }
        json_.end_array();
        json_.end_object();
    }
    void surface(const SurfaceStory& surface) {
        json_.key("hit");
        json_.begin_object();
        primitive(surface.primitive);
        json_.member("t", surface.t);
        if (surface.point) write_triple(json_, "point", *surface.point);
        if (surface.normal) write_triple(json_, "normal", *surface.normal);
        json_.end_object();
        const Material& m = surface.material;
        json_.key("material");
        json_.begin_object();
        json_.member("lit", m.lit);
        write_triple(json_, "diffuse", m.diffuse_color);
        write_triple(json_, "specular", m.specular_color);
        write_triple(json_, "emissive", m.emissive_color);
        json_.member("ambient_intensity", m.ambient_intensity);
        json_.member("shininess", m.shininess);
        json_.end_object();
        json_.key("lights");
        json_.begin_array();
        for (std::size_t i = 0; i < surface.lights.size(); ++i) light(i, surface.lights[i]);
        json_.end_array();
    }

  private:
    void primitive(PrimitiveId id) {
        const PrimitiveSource& source = primitives_.sources[id];
        const Object& object = scene_.objects[source.object];
        json_.member("kind", kind_word(kind_of(object.shape)));
        json_.member("shape", object.shape_index);
        json_.member("triangle", source.triangle);
    }
    void tests(std::string_view name, const std::vector<TestStory>& tests) {
        json_.key(name);
        json_.begin_array();
        for (const TestStory& test : tests) {
            json_.begin_object();
            primitive(test.primitive);
            json_.member("hit", test.hit);
            json_.member("t", test.t);
            json_.member("stage", stage_word(profile_.precision, test.stage));
            json_.end_object();
        }
        json_.end_array();
    }
    void light(std::size_t index, const LightStory& story) {
        json_.begin_object();
        json_.member("light", index);
        json_.member("kind", kind_word(scene_.lights[index].kind));
        json_.member("end", end_word(story.end));
        if (story.shadow) ray("shadow_ray", *story.shadow);
        if (story.sample) {
            write_triple(json_, "to_light", story.sample->to_light);
            json_.member("strength", story.sample->strength);
            write_triple(json_, "ambient", story.terms.ambient);
            write_triple(json_, "diffuse", story.terms.diffuse);
            write_triple(json_, "specular", story.terms.specular);
            write_triple(json_, "adds", story.adds);
        }
        json_.end_object();
    }

    JsonWriter& json_;
    const Scene& scene_;
    const Primitives& primitives_;
    const Profile& profile_;
};

}  // namespace

std::string pixel_json(const Options& options, const Scene& scene, const Primitives& primitives,
                       const PixelReport& report) {
    Options walk = options;
    walk.profile = report.profile;
    JsonWriter json;
    Writer out(json, scene, primitives, report.profile);
    json.begin_object();
    json.member("schema", "nuvo.pixel/1");
    json.member("nuvo", NUVO_VERSION);
    json.member("file", report.file);
    write_resolution(json, options.resolution);
    json.member("pixel",
                std::vector<double>{static_cast<double>(report.x), static_cast<double>(report.y)});
    write_profile(json, walk);
    out.ray("ray", report.story.primary);
    if (report.story.surface) {
        out.surface(*report.story.surface);
    } else {
        json.member("hit", std::optional<int>());
    }
    write_triple(json, "color", report.story.color);
    const Rgb8& bytes = report.story.bytes;
    json.member("bytes",
                std::vector<double>{static_cast<double>(bytes.r), static_cast<double>(bytes.g),
                                    static_cast<double>(bytes.b)});
    json.end_object();
    return json.text();
}

}  // namespace nuvo::app
