#include "nuvo/app/choices.h"
#include "nuvo/app/json_writer.h"
#include "nuvo/app/report.h"
#include "options_json.h"

namespace nuvo::app {
namespace {

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

void write_leaves(JsonWriter& json, const LeafHistogram& leaves) {
    json.key("leaf_depths");
    json.begin_array();
    for (std::size_t depth = 0; depth < leaves.levels.size(); ++depth) {
        json.begin_object();
        json.member("depth", depth);
        json.member("leaves", leaves.levels[depth].leaves);
        json.member("volume_share", leaves.levels[depth].volume_share);
        json.end_object();
    }
    json.end_array();
    json.key("leaf_items");
    json.begin_array();
    for (std::size_t power = 0; power < leaves.items.size(); ++power) {
        const std::size_t first = power == 0 ? 0 : std::size_t{1} << (power - 1);
        json.begin_object();
        json.member("from", first);
        json.member("to", power == 0 ? 0 : 2 * first - 1);
        json.member("leaves", leaves.items[power]);
        json.end_object();
    }
    json.end_array();
}

void write_sah(JsonWriter& json, const FinalSah& sah) {
    json.key("sah");
    json.begin_object();
    json.member("cost", sah.cost);
    json.member("interior", sah.prices.interior);
    json.member("leaf", sah.prices.leaf);
    json.member("object", sah.prices.object);
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
    json.member("out_of_budget", tree.out_of_budget);
    if (tree.sah) write_sah(json, *tree.sah);
    write_leaves(json, tree.leaves);
    json.key("bytes");
    json.begin_object();
    json.member("nodes", tree.node_bytes);
    json.member("references", tree.reference_bytes);
    json.member("names", tree.memory_bytes - tree.node_bytes - tree.reference_bytes);
    json.end_object();
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
    if (!counts.predicates) return;
    json.key("predicates");
    json.begin_object();
    json.member("tests", counts.predicates->tests);
    json.member("wider", counts.predicates->wider);
    json.member("exact", counts.predicates->exact);
    json.end_object();
}

void write_tiles(JsonWriter& json, const TileFigures& tiles, bool has_serial_counts) {
    json.key("tiles");
    json.begin_object();
    json.member("threads", tiles.threads);
    json.member("isa", name_of(kInstructionSets, tiles.isa));
    json.member("depth", tiles.depth);
    json.member("voxels_with_items", tiles.voxels);
    json.member("nodes", tiles.nodes);
    json.member("references", tiles.references);
    json.member("structure_bytes", tiles.memory.structure);
    json.member("corner_bytes", tiles.memory.corners);
    json.member("kept_bytes", tiles.memory.kept);
    json.member("table_bytes", tiles.memory.tables);
    write_leaves(json, tiles.leaves);
    json.end_object();
    if (tiles.counts && !has_serial_counts) {
        json.key("counts");
        json.begin_object();
        json.member("primary_rays", tiles.counts->primary_rays);
        json.member("shadow_rays", tiles.counts->shadow_rays);
        json.end_object();
    }
    if (!tiles.stage_seconds) return;
    json.key("stage_seconds");
    json.begin_object();
    json.member("tables", tiles.stage_seconds->tables);
    json.member("primary", tiles.stage_seconds->primary);
    json.member("shadow", tiles.stage_seconds->shadow);
    json.member("shading", tiles.stage_seconds->shading);
    json.end_object();
}

/// What was written for others to look at.
void write_look_files(JsonWriter& json, const LookFiles& files) {
    if (files.heatmap) {
        json.key("heatmap");
        json.begin_object();
        json.member("file", files.heatmap->file);
        json.member("of", name_of(kHeatmaps, files.heatmap->of));
        json.member("largest", files.heatmap->largest);
        json.member("scale_max", files.heatmap->scale_max);
        json.end_object();
    }
    if (!files.planes.empty()) {
        json.key("planes");
        json.begin_array();
        for (const std::string& plane : files.planes) json.value(plane);
        json.end_array();
    }
    if (!files.octree.empty()) json.member("octree_file", files.octree);
}

void write_memory(JsonWriter& json, const PassMemory& memory) {
    json.member("primitives_bytes", memory.primitives);
    json.member("tracer_bytes", memory.tracer);
    json.member("picture_bytes", memory.picture);
    json.member("peak_building_bytes", memory.peak_building);
    json.member("peak_tracing_bytes", memory.peak_tracing);
}

void write_memory(JsonWriter& json, const Report& report) {
    json.key("memory");
    json.begin_object();
    json.member("scene_bytes", report.memory.scene);
    json.member("peak_start_bytes", report.memory.peak_start);
    json.member("peak_reading_bytes", report.memory.peak_reading);
    if (report.passes.size() == 1) write_memory(json, report.passes.front().memory);
    json.end_object();
}

void write_pass(JsonWriter& json, const Pass& pass) {
    if (pass.tiles) write_tiles(json, *pass.tiles, pass.counts.has_value());
    if (pass.tiles && pass.tree) json.member("walk", "serial exact");  // its tree and counts
    if (pass.tree) write_tree(json, *pass.tree);
    if (pass.counts) write_counts(json, *pass.counts);
    write_look_files(json, pass.files);
    json.member("build_seconds", pass.build_seconds);
    json.member("trace_seconds", pass.trace_seconds);
    json.member("build_wall_seconds", pass.build_wall_seconds);
    json.member("trace_wall_seconds", pass.trace_wall_seconds);
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
        json.key("memory");
        json.begin_object();
        write_memory(json, pass.memory);
        json.end_object();
        write_pass(json, pass);
        json.end_object();
    }
    json.end_array();
}

void write_difference(JsonWriter& json, const image::Difference& d) {
    json.member("differing_pixels", d.differing_pixels);
    json.member("max_difference", d.max_difference);
    json.member("x", d.x);
    json.member("y", d.y);
    json.member("rms", d.rms);
    json.member("psnr_db", d.psnr_db);  // null for equal pictures
}

void write_warnings(JsonWriter& json, const std::vector<std::string>& warnings) {
    json.key("warnings");
    json.begin_array();
    for (const std::string& warning : warnings) json.value(warning);
    json.end_array();
}

void write_pairs(JsonWriter& json, const std::vector<Pair>& pairs) {
    json.key("pairs");
    json.begin_array();
    for (const Pair& pair : pairs) {
        json.begin_object();
        json.member("first", pair.first);
        json.member("second", pair.second);
        write_difference(json, pair.difference);
        json.end_object();
    }
    json.end_array();
}

}  // namespace

std::string report_json(const Options& options, const Report& report) {
    JsonWriter json;
    json.begin_object();
    json.member("schema", "nuvo.report/1");
    json.member("nuvo", NUVO_VERSION);
    write_provenance(json, options);
    json.member("file", report.file);
    if (!report.picture.empty()) json.member(report.rays ? "answers" : "picture", report.picture);
    if (!report.difference.empty()) json.member("difference_picture", report.difference);
    if (!report.rays) {
        write_resolution(json, options.resolution);
        json.member("samples", options.samples);
        json.member("repetitions", report.passes.front().trace_seconds.size());
    }
    write_profile(json, options);
    write_scene(json, report.scene);
    write_warnings(json, report.warnings);
    json.member("parse_seconds", report.parse_seconds);
    json.member("parse_wall_seconds", report.parse_wall_seconds);
    if (report.passes.size() == 1) {
        write_pass(json, report.passes.front());
    } else {
        write_passes(json, report.passes);
    }
    json.member("write_seconds", report.write_seconds);
    json.member("write_wall_seconds", report.write_wall_seconds);
    write_memory(json, report);
    json.member("peak_memory_bytes", peak_memory_bytes());
    if (!report.pairs.empty()) write_pairs(json, report.pairs);
    if (report.error) {
        json.key("error");
        json.begin_object();
        write_difference(json, *report.error);
        json.end_object();
    }
    if (report.rays) {
        json.member("rays", *report.rays);
        json.member("hits", report.hits.value_or(0));
    }
    json.end_object();
    return json.text();
}

}  // namespace nuvo::app
