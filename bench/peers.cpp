#include <charconv>
#include <fstream>
#include <iostream>
#include <string_view>

#include "contest.h"
#include "nuvo/app/choices.h"
#include "nuvo/app/report.h"
#include "nuvo/scene/x3d.h"

// nuvo and Embree over one scene: scripts/bench_peers.sh runs this program scene by scene.

namespace nuvo::bench {
namespace {

constexpr std::string_view kUsage =
    "usage: nuvo_peers --scene=FILE --json=FILE [option]...\n"
    "  --rounds=N       interleaved rounds (9)\n"
    "  --res=W,H        size of the pictures (1920,1080)\n"
    "  --type=NAME      uniform, nonuniform or measured octrees only\n"
    "  --isa=NAME       avx512, avx2, sse4.2 or sse2 for both sides (the best)\n"
    "  --back-faces=draw  nuvo's frames see all faces, too, as Embree's do\n"
    "  --parts=LIST     of frame, check, rays, exactness, threads (all, with commas)\n"
    "  --pictures=NAME  write NAME-ours.bmp and NAME-embree.bmp\n"
    "  --pov=FILE       write the scene for POV-Ray and stop\n";

int whole_number(std::string_view text, std::string_view argument) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1)
        throw std::invalid_argument(std::string(argument) + ": not a whole number from 1 on");
    return value;
}

Resolution parse_resolution(std::string_view text, std::string_view argument) {
    const auto comma = text.find(',');
    if (comma == text.npos) throw std::invalid_argument(std::string(argument) + ": must be W,H");
    return {whole_number(text.substr(0, comma), argument),
            whole_number(text.substr(comma + 1), argument)};
}

constexpr std::string_view kMeasured = "measured";

std::string_view type_name(std::optional<OctreeType> type) {
    return type ? app::name_of(app::kOctreeTypes, *type) : kMeasured;
}

std::vector<std::optional<OctreeType>> parse_type(std::string_view text) {
    if (text == kMeasured) return {std::nullopt};
    for (const auto& choice : app::kOctreeTypes)
        if (choice.name == text) return {choice.value};
    throw std::invalid_argument("--type: neither uniform nor nonuniform");
}

ContestOptions parse(const std::vector<std::string_view>& arguments) {
    ContestOptions options;
    for (const std::string_view argument : arguments) {
        const auto equals = argument.find('=');
        const std::string_view name = argument.substr(0, equals);
        const std::string_view value = equals == argument.npos ? "" : argument.substr(equals + 1);
        if (name == "--scene") {
            options.scene = value;
        } else if (name == "--json") {
            options.json = value;
        } else if (name == "--rounds") {
            options.rounds = whole_number(value, argument);
        } else if (name == "--res") {
            options.resolution = parse_resolution(value, argument);
        } else if (name == "--type") {
            options.types = parse_type(value);
        } else if (name == "--isa") {
            options.isa = value;
            instruction_set(options.isa);
        } else if (name == "--back-faces") {
            if (value != "draw") throw std::invalid_argument(std::string(argument) + ": not draw");
            options.back_faces = BackFaces::kDraw;
        } else if (name == "--parts") {
            options.parts = value;
        } else if (name == "--pictures") {
            options.pictures = value;
        } else if (name == "--pov") {
            options.pov = value;
        } else {
            throw std::invalid_argument("unknown option " + std::string(argument));
        }
    }
    if (options.scene.empty() || (options.json.empty() && !options.pov))
        throw std::invalid_argument("give --scene=FILE and --json=FILE");
    return options;
}

/// The reader's limits are for files of strangers; these are ours.
Scene load(const std::string& file) {
    x3d::Limits limits;
    limits.vertices = 100'000'000;
    limits.elements = 50'000'000;
    limits.attributes = 50'000'000;
    limits.shapes = 10'000'000;
    return x3d::read_file(file, {.limits = limits});
}

void write_ours(app::JsonWriter& json, const OurSamples& samples) {
    json.begin_object();
    json.member("type", type_name(samples.type));
    write_samples(json, "build", samples.build);
    write_samples(json, "scratch", samples.scratch);
    write_samples(json, "frame", samples.frame);
    write_samples(json, "tables", samples.tables);
    write_samples(json, "primary", samples.primary);
    write_samples(json, "shadow", samples.shadow);
    write_samples(json, "shading", samples.shading);
    json.member("structure_bytes", samples.memory.structure);
    json.member("table_bytes", samples.memory.tables);
    json.end_object();
}

void write_embree(app::JsonWriter& json, const EmbreeSamples& samples) {
    json.begin_object();
    write_samples(json, "convert", samples.convert);
    write_samples(json, "build", samples.build);
    write_samples(json, "scratch", samples.scratch);
    write_samples(json, "primary", samples.primary);
    write_samples(json, "trace", samples.trace);
    write_samples(json, "frame", samples.frame);
    json.member("structure_bytes", samples.memory.structure);
    json.member("peak_bytes", samples.memory.peak);
    json.end_object();
}

void write_survey(app::JsonWriter& json, const Survey& survey) {
    json.key("embree_survey");
    json.begin_object();
    json.member("version", survey.version);
    json.member("primary_width", survey.mode.primary_width);
    json.member("primary_coherent", survey.mode.primary_coherent);
    json.member("shadow_width", survey.mode.shadow_width);
    json.member("shadow_coherent", survey.mode.shadow_coherent);
    json.member("user_spheres", survey.options.spheres == SphereKind::kUser);
    json.key("least_seconds");
    json.begin_object();
    for (const SurveyRow& row : survey.rows) json.member(row.what, row.seconds);
    json.end_object();
    json.end_object();
}

void write_frames(app::JsonWriter& json, const FrameContest& contest) {
    json.key("ours");
    json.begin_array();
    for (const OurSamples& samples : contest.ours) write_ours(json, samples);
    json.end_array();
    json.key("embree");
    write_embree(json, contest.embree);
    json.member("differing_pixels", contest.agreement.differing);
    json.member("visibly_differing_pixels", contest.agreement.visible);
}

void write_rays(app::JsonWriter& json, const RayContest& contest, const ContestOptions& options) {
    json.key("rays");
    json.begin_object();
    json.member("rays", contest.rays);
    json.member("hits", contest.hits);
    json.member("differing", contest.differing);
    for (std::size_t i = 0; i < contest.ours.size(); ++i) {
        const std::string type(type_name(options.types[i]));
        write_samples(json, "ours_" + type, contest.ours[i]);
    }
    write_samples(json, "embree", contest.embree);
    json.end_object();
}

void write_exactness(app::JsonWriter& json, const ExactnessPrice& price) {
    json.key("exactness");
    json.begin_object();
    write_samples(json, "exact", price.exact);
    write_samples(json, "plain", price.plain);
    json.member("differing_pixels", price.differing);
    json.end_object();
}

void write_threads(app::JsonWriter& json, const ThreadContest& contest) {
    json.key("threads");
    json.begin_object();
    write_samples(json, "ours_1", contest.ours_one);
    write_samples(json, "ours_2", contest.ours_two);
    write_samples(json, "ours_build_1", contest.ours_build_one);
    write_samples(json, "ours_build_2", contest.ours_build_two);
    write_samples(json, "embree_1", contest.embree_one);
    write_samples(json, "embree_2", contest.embree_two);
    json.member("same_bytes", contest.same_bytes);
    json.end_object();
}

void write_head(app::JsonWriter& json, const Scene& scene, const ContestOptions& options) {
    const app::SceneCounts counts = app::count(scene);
    json.member("scene", options.scene.substr(options.scene.rfind('/') + 1));
    json.member("triangles", counts.triangles);
    json.member("spheres", counts.spheres);
    json.member("lights", counts.lights);
    json.member("width", options.resolution.width);
    json.member("height", options.resolution.height);
    json.member("rounds", options.rounds);
    json.member("isa", options.isa.empty() ? std::string("best") : options.isa);
}

/// All that the options ask for, as JSON.
std::string measured(const Scene& scene, const ContestOptions& options) {
    const auto wanted = [&](const char* part) {
        return ("," + options.parts + ",").find("," + std::string(part) + ",") != std::string::npos;
    };
    app::JsonWriter json;
    json.begin_object();
    write_head(json, scene, options);
    const Survey survey = [&] {
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        return survey_embree(to_float(scene, primitives), options);
    }();
    write_survey(json, survey);
    const std::optional<OctreeType> type = options.types.front();
    if (wanted("frame")) write_frames(json, contest_frames(scene, options, survey));
    if (wanted("check")) json.member("pixels_unlike_exact", pixels_unlike_exact(scene, options));
    if (wanted("rays")) write_rays(json, contest_rays(scene, options, survey), options);
    if (wanted("exactness")) write_exactness(json, price_of_exactness(scene, options, type));
    if (wanted("threads")) write_threads(json, contest_threads(scene, options, survey, type));
    json.end_object();
    return json.text();
}

void run(const ContestOptions& options) {
    const Scene scene = load(options.scene);
    if (options.pov)
        return write_povray(scene, flatten(scene, LeafContent::kPrimitives), *options.pov);
    std::ofstream file(options.json, std::ios::trunc);
    file << measured(scene, options) << std::flush;
    if (!file) throw std::runtime_error(options.json + ": cannot be written");
}

}  // namespace
}  // namespace nuvo::bench

int main(int argc, char** argv) {
    try {
        nuvo::bench::run(nuvo::bench::parse({argv + std::min(argc, 1), argv + argc}));
        return 0;
    } catch (const std::invalid_argument& error) {
        std::cerr << "nuvo_peers: " << error.what() << "\n" << nuvo::bench::kUsage;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "nuvo_peers: " << error.what() << "\n";
        return 1;
    }
}
