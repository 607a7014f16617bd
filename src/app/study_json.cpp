#include "nuvo/app/json_writer.h"
#include "nuvo/app/study.h"
#include "options_json.h"

namespace nuvo::app {
namespace {

void write_row(JsonWriter& json, Options options, const StudyRow& row) {
    options.profile_name = row.what.profile;
    options.profile = row.what.answers;
    const image::Difference& d = row.difference;
    json.begin_object();
    json.member("change", row.what.change);
    write_profile(json, options);
    json.member("trace_seconds_median", row.trace.median);
    json.member("trace_seconds_interval", std::vector<double>{row.trace.low, row.trace.high});
    json.member("build_seconds_median", row.build_median);
    json.member("trace_seconds", row.trace_seconds);
    json.member("build_seconds", row.build_seconds);
    json.member("wrong_primitives", row.wrong_primitives);
    json.member("wrong_shadows", row.wrong_shadows);
    json.member("differing_pixels", d.differing_pixels);
    json.member("max_difference", d.max_difference);
    json.member("rms", d.rms);
    json.member("psnr_db", d.psnr_db);  // null for equal pictures
    json.member("frontier", row.on_frontier);
    json.end_object();
}

}  // namespace

std::string study_json(const Options& options, const std::string& file,
                       const std::vector<StudyRow>& rows) {
    JsonWriter json;
    json.begin_object();
    json.member("schema", "nuvo.study/1");
    json.member("nuvo", NUVO_VERSION);
    write_provenance(json, options);
    json.member("file", file);
    write_resolution(json, options.resolution);
    json.member("rounds", options.repetitions);
    json.key("rows");
    json.begin_array();
    for (const StudyRow& row : rows) write_row(json, options, row);
    json.end_array();
    json.end_object();
    return json.text();
}

}  // namespace nuvo::app
