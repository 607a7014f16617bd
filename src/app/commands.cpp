#include "nuvo/app/commands.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <optional>
#include <system_error>
#include <tuple>

#include "look.h"
#include "nuvo/app/choices.h"
#include "nuvo/app/describe.h"
#include "nuvo/app/rays.h"
#include "nuvo/app/report.h"
#include "nuvo/image/file_writer.h"
#include "nuvo/image/picture_file.h"
#include "nuvo/math/big_vector.h"
#include "passes.h"
#include "scene_files.h"
#include "text.h"

namespace nuvo::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSceneEndings[] = {".x3d", ".x3dz"};

std::vector<fs::path> with_json(std::vector<fs::path> outputs, const Options& options) {
    if (options.json) outputs.emplace_back(*options.json);
    return outputs;
}

/// Where the report goes: not among bytes.
std::ostream& report_stream(const Options& options) {
    return options.standard_output_taken() ? std::cerr : std::cout;
}

void print_report(const Options& options, const Report& report) {
    if (!options.quiet) report_stream(options) << report_text(options, report);
}

/// Nobody reads a picture on a terminal.
void check_terminal(const Options& options) {
    if (options.out == kStandardStream && ::isatty(STDOUT_FILENO) != 0)
        throw UsageError("the picture would go to the terminal: give --out=FILE");
}

void write_json(const Options& options, const Report& report) {
    if (options.json) image::write_file_atomically(*options.json, report_json(options, report));
}

void show_octree(const Scene& scene, const Profile& profile, Meter& meter) {
    std::cout << name_of(kOctreeTypes, profile.type) << " octree\n";
    const Octree octree =
        build_tree(scene, flatten(scene, profile.leaves), profile, meter.begin("building"));
    meter.end();
    print(std::cout, octree);
}

Profile with_type(Profile profile, OctreeType type) {
    profile.type = type;
    return profile;
}

Report begin_report(const LoadedScene& loaded) {
    Report report;
    report.file = loaded.name;
    report.scene = count(loaded.scene);
    report.parse_seconds = loaded.parse_seconds;
    report.warnings = loaded.scene.warnings;
    report.parse_wall_seconds = loaded.parse_wall_seconds;
    report.memory = loaded.memory;
    return report;
}

fs::path chosen_picture(const Options& options, const LoadedScene& loaded) {
    return options.out ? fs::path(*options.out) : picture_beside(loaded.path);
}

// What is to be seen with `profile`, exactly.
Profile exact_like(const Profile& profile) {
    Profile exact = exact_profile();
    exact.back_faces = profile.back_faces;
    return exact;
}

// Of a picture of which nothing but the pixels is told.
Options plain(Options options) {
    options.counters = false;
    options.json.reset();
    options.heatmap.reset();
    options.planes.reset();
    options.octree.reset();
    return options;
}

// One more picture, of which nothing but the pixels is told.
image::Difference error_of(const Image& picture, const Scene& scene, const Options& options,
                           Meter& meter) {
    Image exact;
    run_pass(scene, plain(options), exact_like(options.profile), 1, meter, exact);
    return image::compare(picture, exact);
}

// From a picture of a 16th of the width and height.
std::string brute_force_forecast(const Scene& scene, const Options& options, Meter& meter) {
    constexpr int kShrink = 16;
    Options small = plain(options);
    small.resolution = {std::max(1, options.resolution.width / kShrink),
                        std::max(1, options.resolution.height / kShrink)};
    Image trial;
    const Pass pass = run_brute_force(scene, small, meter, trial);
    const auto pixels = [](Resolution r) {
        return static_cast<double>(r.width) * static_cast<double>(r.height);
    };
    const double seconds =
        pass.trace_seconds.front() * pixels(options.resolution) / pixels(small.resolution);
    const SceneCounts counts = count(scene);
    return format("%-10s every ray against all %zu triangles and spheres: about %.3g s\n",
                  "brute force", counts.triangles + counts.spheres, seconds);
}

// The passes of -compare, in their order.
std::vector<std::string> compared_names(const Options& options) {
    std::vector<std::string> names;
    for (const auto& type : kOctreeTypes) names.emplace_back(type.name);
    if (options.profile.tracer == TracerChoice::kTiles) names.emplace_back("serial");
    if (options.compare_brute_force) names.emplace_back("brute force");
    return names;
}

bool is_further_apart(const image::Difference& a, const image::Difference& b) {
    return std::tie(a.max_difference, a.differing_pixels) >
           std::tie(b.max_difference, b.differing_pixels);
}

/// The tile tracer's tables are as large as the file and what is read of it: their memory serves
/// again, and so does that of each repetition.
std::optional<BlockKeeper> keeper_for(const Options& options) {
    if (options.profile.tracer != TracerChoice::kTiles) return std::nullopt;
    return std::optional<BlockKeeper>(std::in_place);
}

}  // namespace

ExitCode render_command(const Options& options) {
    check_terminal(options);
    const std::optional<BlockKeeper> keeper = keeper_for(options);
    Meter meter(options.shows_progress());
    const LoadedScene loaded = load(options, meter);
    const fs::path picture_path = chosen_picture(options, loaded);
    std::vector<fs::path> outputs = look_files(options, picture_path, "");
    outputs.push_back(picture_path);
    check_outputs({loaded.path}, with_json(outputs, options));
    if (options.show_octree) show_octree(loaded.scene, options.profile, meter);

    Report report = begin_report(loaded);
    Image picture;
    report.passes.push_back(
        run_pass(loaded.scene, options, options.profile, options.repetitions, meter, picture));
    for (const std::string& remark : report.passes.back().remarks)
        std::cerr << "nuvo: note: " << remark << '\n';
    if (options.error) report.error = error_of(picture, loaded.scene, options, meter);
    meter.begin("writing");
    const StageStopwatch write;
    image::write_picture(picture_path, picture);
    report.write_seconds = write.seconds();
    report.write_wall_seconds = write.wall_seconds();
    report.picture = picture_path.string();
    write_looks(options, picture_path, report.file, report.passes);
    write_json(options, report);
    meter.end();
    print_report(options, report);
    return kDone;
}

ExitCode compare_command(const Options& options) {
    const std::optional<BlockKeeper> keeper = keeper_for(options);
    Meter meter(options.shows_progress());
    const LoadedScene loaded = load(options, meter);
    const fs::path picture_path = chosen_picture(options, loaded);
    const fs::path difference_path = difference_beside(picture_path);
    std::vector<fs::path> outputs{picture_path, difference_path};
    for (const std::string& name : compared_names(options))
        for (const fs::path& file : look_files(options, picture_path, name))
            outputs.push_back(file);
    check_outputs({loaded.path}, with_json(outputs, options));

    Report report = begin_report(loaded);
    std::vector<Image> pictures;
    for (const auto& type : kOctreeTypes) {
        const Profile profile = with_type(options.profile, type.value);
        if (options.show_octree) show_octree(loaded.scene, profile, meter);
        report.passes.push_back(
            run_pass(loaded.scene, options, profile, 1, meter, pictures.emplace_back()));
    }
    if (options.profile.tracer == TracerChoice::kTiles) {
        report.passes.push_back(run_pass(loaded.scene, options, exact_like(options.profile), 1,
                                         meter, pictures.emplace_back()));
        report.passes.back().name = "serial";
    }
    if (options.compare_brute_force) {
        if (!options.quiet)
            report_stream(options)
                << brute_force_forecast(loaded.scene, options, meter) << std::flush;
        report.passes.push_back(
            run_brute_force(loaded.scene, options, meter, pictures.emplace_back()));
    }

    std::size_t far_first = 0, far_second = 1;
    image::Difference furthest;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        for (std::size_t j = i + 1; j < pictures.size(); ++j) {
            const image::Difference difference = image::compare(pictures[i], pictures[j]);
            report.pairs.push_back({report.passes[i].name, report.passes[j].name, difference});
            if (!is_further_apart(difference, furthest)) continue;
            furthest = difference;
            far_first = i;
            far_second = j;
        }
    }
    meter.begin("writing");
    const StageStopwatch write;
    image::write_picture(picture_path, pictures[0]);
    image::write_picture(difference_path,
                         image::difference_picture(pictures[far_first], pictures[far_second]));
    report.write_seconds = write.seconds();
    report.write_wall_seconds = write.wall_seconds();
    report.picture = picture_path.string();
    report.difference = difference_path.string();
    write_looks(options, picture_path, report.file, report.passes);
    write_json(options, report);
    meter.end();
    print_report(options, report);
    return furthest.equal() ? kDone : kPicturesDiffer;
}

namespace {

std::string answer_bytes(const LoadedScene& loaded, const Options& options,
                         std::span<const Ray> rays, std::span<const RayAnswer> answers) {
    const AnswerParts& parts = options.answer_parts;
    std::vector<HitPlace> places;
    if (parts.point || parts.normal) places = hit_places(loaded.scene, rays, answers);
    const bool is_array = options.out && fs::path(*options.out).extension() == ".npy";
    return (is_array ? answers_npy : answers_text)(answers, places, loaded.shape_names, parts);
}

}  // namespace

ExitCode rays_command(const Options& options) {
    const std::optional<BlockKeeper> keeper = keeper_for(options);
    Meter meter(options.shows_progress());
    const LoadedScene loaded = load(options, meter);
    meter.begin("reading the rays");
    const StageStopwatch read;
    const std::vector<Ray> rays = read_rays(*options.rays);
    const double read_wall_seconds = read.wall_seconds();
    meter.end();
    std::vector<fs::path> outputs;
    if (options.out) outputs.emplace_back(*options.out);
    check_outputs({loaded.path, *options.rays}, with_json(outputs, options));

    Report report = begin_report(loaded);
    report.parse_wall_seconds += read_wall_seconds;
    std::vector<RayAnswer> answers;
    report.passes.push_back(run_rays(loaded.scene, options, rays, meter, answers));
    report.rays = rays.size();
    report.hits = static_cast<std::size_t>(
        std::count_if(answers.begin(), answers.end(), [](const RayAnswer& a) { return a.hit; }));

    meter.begin("writing");
    const StageStopwatch write;
    const std::string bytes = answer_bytes(loaded, options, rays, answers);
    if (options.out) {
        image::write_file_atomically(*options.out, bytes);
        report.picture = *options.out;
    } else {
        std::cout << bytes;
    }
    report.write_seconds = write.seconds();
    report.write_wall_seconds = write.wall_seconds();
    write_json(options, report);
    meter.end();
    if (options.out) print_report(options, report);  // else the answers have standard output
    return kDone;
}

ExitCode describe_command(const Options& options) {
    Meter meter(options.shows_progress());
    const LoadedScene loaded = load(options, meter);
    std::cout << description(loaded.name, loaded.scene, loaded.parse_seconds);
    return kDone;
}

fs::path find_scene(const std::string& name) {
    std::error_code ignored;
    const fs::path given = name;
    if (fs::exists(given, ignored) && !fs::is_directory(given, ignored)) return given;
    for (const char* ending : kSceneEndings) {
        fs::path with_ending = given;
        with_ending += ending;
        if (fs::exists(with_ending, ignored)) return with_ending;
    }
    if (fs::is_directory(given, ignored)) throw x3d::Error(name + ": file: is a folder");
    throw x3d::Error(name + ": file: not found, with or without .x3d or .x3dz");
}

fs::path picture_beside(const fs::path& scene) {
    fs::path picture = scene;
    std::string ending = picture.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending == ".xml" || std::find(std::begin(kSceneEndings), std::end(kSceneEndings), ending) !=
                                std::end(kSceneEndings))
        picture.replace_extension();
    return picture += ".bmp";
}

fs::path difference_beside(const fs::path& picture) {
    std::error_code ignored;
    if (fs::exists(picture, ignored) && !is_regular(picture)) return picture;
    fs::path name = picture.stem();
    name += "-difference";
    name += picture.has_extension() ? picture.extension() : fs::path(".bmp");
    return picture.parent_path() / name;
}

}  // namespace nuvo::app
