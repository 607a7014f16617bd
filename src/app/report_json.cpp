#include "nuvo/app/choices.h"
#include "nuvo/app/json_writer.h"
#include "nuvo/app/report.h"

namespace nuvo::app {
namespace {

void write_profile(JsonWriter& json, const Options& options) {
    const Profile& profile = options.profile;
    const bool cuts_freely = options.compare || profile.type == OctreeType::kNonuniform;
    const auto number_or_exact = [&json](const char* name, const std::optional<double>& value) {
        if (value) {
            json.member(name, *value);
        } else {
            json.member(name, "exact");
        }
    };
    json.key("profile");
    json.begin_object();
    json.member("name", options.profile_name);
    json.member("type", options.compare ? "all" : name_of(kOctreeTypes, profile.type));
    json.member("midpoint",
                name_of(kMidpoints, cuts_freely ? profile.midpoint : MidpointChoice::kSpatial));
    json.key("costs");
    if (profile.max_objects) {
        json.null();
    } else {
        json.value(name_of(kCosts, profile.costs));
    }
    json.member("thesis_weight", profile.thesis_weight);
    json.key("max_objects");
    if (profile.max_objects) {
        json.value(*profile.max_objects);
    } else {
        json.null();
    }
    json.member("leaves", name_of(kLeafContents, profile.leaves));
    json.member("walk", name_of(kWalks, profile.walk));
    number_or_exact("step", profile.step);
    json.member("precision", name_of(kPrecisions, profile.precision));
    number_or_exact("bias", profile.bias);
    json.member("headlight", name_of(kHeadlights, options.headlight));
    json.end_object();
}

void write_scene(JsonWriter& json, const SceneCounts& scene) {
    json.key("scene");
    json.begin_object();
    json.member("shapes", scene.shapes);
    json.member("objects", scene.objects);
    json.member("triangles", scene.triangles);
    json.member("spheres", scene.spheres);
    json.member("lights", scene.lights);
    json.member("warnings", scene.warnings);
    json.end_object();
}

void write_tree(JsonWriter& json, const TreeFigures& tree) {
    json.key("tree");
    json.begin_object();
    json.member("depth", tree.depth);
    json.member("voxels", tree.voxels);
    json.member("nodes", tree.nodes);
    json.member("references", tree.references);
    json.member("memory_bytes", tree.memory_bytes);
    json.member("smallest_width", tree.smallest_width);
    json.end_object();
}

void write_counts(JsonWriter& json, const TraceCounts& counts) {
    json.key("counts");
    json.begin_object();
    json.member("primary_rays", counts.primary_rays);
    json.member("shadow_rays", counts.shadow_rays);
    json.member("intersection_tests", counts.intersection_tests);
    json.member("voxel_searches", counts.voxel_searches);
    json.end_object();
}

void write_pass(JsonWriter& json, const Pass& pass) {
    if (pass.tree) write_tree(json, *pass.tree);
    if (pass.counts) write_counts(json, *pass.counts);
    json.member("build_seconds", pass.build_seconds);
    json.member("trace_seconds", pass.trace_seconds);
    json.member("user_seconds", pass.process.user_seconds);
    json.member("system_seconds", pass.process.system_seconds);
    json.member("wall_seconds", pass.process.wall_seconds);
}

/// -compare: each pass an object of its own.
void write_passes(JsonWriter& json, const std::vector<Pass>& passes) {
    json.key("passes");
    json.begin_array();
    for (const Pass& pass : passes) {
        json.begin_object();
        json.member("name", pass.name);
        write_pass(json, pass);
        json.end_object();
    }
    json.end_array();
}

void write_pairs(JsonWriter& json, const std::vector<Pair>& pairs) {
    json.key("pairs");
    json.begin_array();
    for (const Pair& pair : pairs) {
        const image::Difference& d = pair.difference;
        json.begin_object();
        json.member("first", pair.first);
        json.member("second", pair.second);
        json.member("differing_pixels", d.differing_pixels);
        json.member("max_difference", d.max_difference);
        json.member("x", d.x);
        json.member("y", d.y);
        json.member("rms", d.rms);
        json.member("psnr_db", d.psnr_db);  // null for equal pictures
        json.end_object();
    }
    json.end_array();
}

}  // namespace

std::string report_json(const Options& options, const Report& report) {
    JsonWriter json;
    json.begin_object();
    json.member("nuvo", NUVO_VERSION);
    json.member("file", report.file);
    if (!report.picture.empty()) json.member(report.rays ? "answers" : "picture", report.picture);
    if (!report.difference.empty()) json.member("difference_picture", report.difference);
    if (!report.rays) {
        json.key("resolution");
        json.begin_object();
        json.member("width", options.resolution.width);
        json.member("height", options.resolution.height);
        json.end_object();
        json.member("repetitions", report.passes.front().trace_seconds.size());
    }
    write_profile(json, options);
    write_scene(json, report.scene);
    json.member("parse_seconds", report.parse_seconds);
    if (report.passes.size() == 1) {
        write_pass(json, report.passes.front());
    } else {
        write_passes(json, report.passes);
    }
    json.member("write_seconds", report.write_seconds);
    if (!report.pairs.empty()) write_pairs(json, report.pairs);
    if (report.rays) {
        json.member("rays", *report.rays);
        json.member("hits", report.hits.value_or(0));
    }
    json.end_object();
    return json.text();
}

}  // namespace nuvo::app
