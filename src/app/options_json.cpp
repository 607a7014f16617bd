#include "options_json.h"

#include "nuvo/app/choices.h"
#include "nuvo/app/report.h"

namespace nuvo::app {

void write_profile(JsonWriter& json, const Options& options) {
    const Profile& profile = options.profile;
    const bool tiles = profile.tracer == TracerChoice::kTiles;
    const bool cuts_freely = options.compare || profile.type == OctreeType::kNonuniform;
    const MidpointChoice free_cut = tiles ? MidpointChoice::kSweep : profile.midpoint;
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
    json.member("tracer", name_of(kTracers, profile.tracer));
    json.member("type", options.compare             ? "all"
                        : type_is_measured(options) ? "measured"
                                                    : name_of(kOctreeTypes, profile.type));
    json.member("midpoint", name_of(kMidpoints, cuts_freely ? free_cut : MidpointChoice::kSpatial));
    json.key("costs");
    if (profile.max_objects) {
        json.null();
    } else {
        json.value(name_of(kCosts, profile.costs));
    }
    json.member("max_objects", profile.max_objects);
    json.member("leaves", name_of(kLeafContents, profile.leaves));
    json.key("walk");
    if (tiles) {
        json.null();
    } else {
        json.value(name_of(kWalks, profile.walk));
    }
    number_or_exact("step", profile.step);
    json.member("precision", name_of(kPrecisions, profile.precision));
    number_or_exact("bias", profile.bias);
    json.member("back_faces", name_of(kBackFaces, profile.back_faces));
    json.member("defaults", name_of(kDefaults, options.defaults));
    json.member("headlight", name_of(kHeadlights, options.headlight));
    json.end_object();
}

void write_resolution(JsonWriter& json, Resolution resolution) {
    json.key("resolution");
    json.begin_object();
    json.member("width", resolution.width);
    json.member("height", resolution.height);
    json.end_object();
}

}  // namespace nuvo::app
