#include <cmath>
#include <nlohmann/json.hpp>

#include "nuvo/app/choices.h"
#include "nuvo/app/report.h"

namespace nuvo::app {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename T>
Json value_or(const std::optional<T>& value, const char* otherwise) {
    return value ? Json(*value) : otherwise != nullptr ? Json(otherwise) : Json(nullptr);
}

Json profile_json(const Options& options) {
    const Profile& profile = options.profile;
    const bool cuts_freely = options.compare || profile.type == OctreeType::kNonuniform;
    Json json;
    json["name"] = options.profile_name;
    json["type"] = options.compare ? Json("all") : Json(name_of(kOctreeTypes, profile.type));
    json["midpoint"] =
        name_of(kMidpoints, cuts_freely ? profile.midpoint : MidpointChoice::kSpatial);
    json["costs"] = profile.max_objects ? Json(nullptr) : Json(name_of(kCosts, profile.costs));
    json["thesis_weight"] = finite_or_null(profile.thesis_weight);
    json["max_objects"] = value_or(profile.max_objects, nullptr);
    json["leaves"] = name_of(kLeafContents, profile.leaves);
    json["walk"] = name_of(kWalks, profile.walk);
    json["step"] = value_or(profile.step, "exact");
    json["precision"] = name_of(kPrecisions, profile.precision);
    json["bias"] = value_or(profile.bias, "exact");
    json["headlight"] = name_of(kHeadlights, options.headlight);
    return json;
}

Json scene_json(const SceneCounts& scene) {
    return {{"shapes", scene.shapes},   {"objects", scene.objects}, {"triangles", scene.triangles},
            {"spheres", scene.spheres}, {"lights", scene.lights},   {"warnings", scene.warnings}};
}

void add_pass(Json& json, const Pass& pass) {
    if (pass.tree)
        json["tree"] = {{"depth", pass.tree->depth},
                        {"voxels", pass.tree->voxels},
                        {"nodes", pass.tree->nodes},
                        {"references", pass.tree->references},
                        {"memory_bytes", pass.tree->memory_bytes},
                        {"smallest_width", finite_or_null(pass.tree->smallest_width)}};
    if (pass.counts)
        json["counts"] = {{"primary_rays", pass.counts->primary_rays},
                          {"shadow_rays", pass.counts->shadow_rays},
                          {"intersection_tests", pass.counts->intersection_tests},
                          {"voxel_searches", pass.counts->voxel_searches}};
    json["build_seconds"] = pass.build_seconds;
    json["trace_seconds"] = pass.trace_seconds;
    json["user_seconds"] = pass.process.user_seconds;
    json["system_seconds"] = pass.process.system_seconds;
    json["wall_seconds"] = pass.process.wall_seconds;
}

Json pair_json(const Pair& pair) {
    const image::Difference& d = pair.difference;
    return {{"first", pair.first},
            {"second", pair.second},
            {"differing_pixels", d.differing_pixels},
            {"max_difference", d.max_difference},
            {"pixel", d.equal() ? Json(nullptr) : Json{d.x, d.y}},
            {"rms", d.rms},
            {"psnr_db", finite_or_null(d.psnr_db)}};
}

}  // namespace

std::string report_json(const Options& options, const Report& report) {
    Json json;
    json["nuvo"] = NUVO_VERSION;
    json["file"] = report.file;
    if (!report.picture.empty()) json[report.rays ? "answers" : "picture"] = report.picture;
    if (!report.difference.empty()) json["difference_picture"] = report.difference;
    if (!report.rays) {
        json["resolution"] = {{"width", options.resolution.width},
                              {"height", options.resolution.height}};
        json["repetitions"] = report.passes.front().trace_seconds.size();
    }
    json["profile"] = profile_json(options);
    json["scene"] = scene_json(report.scene);
    json["parse_seconds"] = report.parse_seconds;
    if (report.passes.size() == 1) {
        add_pass(json, report.passes.front());
    } else {
        for (const Pass& pass : report.passes) {
            Json entry{{"name", pass.name}};
            add_pass(entry, pass);
            json["passes"].push_back(std::move(entry));
        }
    }
    json["write_seconds"] = report.write_seconds;
    for (const Pair& pair : report.pairs) json["pairs"].push_back(pair_json(pair));
    if (report.rays) {
        json["rays"] = *report.rays;
        json["hits"] = report.hits.value_or(0);
    }
    // A file name need not be UTF-8; what is not becomes U+FFFD.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace nuvo::app
