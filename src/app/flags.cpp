#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <system_error>

#include "nuvo/app/choices.h"
#include "nuvo/app/options.h"
#include "octree_file.h"

namespace nuvo::app {
namespace {

template <typename E, std::size_t N>
E parse_choice(const std::array<Choice<E>, N>& choices, std::string_view value) {
    for (const Choice<E>& choice : choices)
        if (choice.name == value) return choice.value;
    throw UsageError("must be " + joined_names(choices));
}

/// An integer that fills the whole text and lies in [low, high]; else UsageError(demand).
template <typename T>
T parse_integer(std::string_view text, T low, T high, const std::string& demand) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value < low || value > high)
        throw UsageError(demand);
    return value;
}

/// A finite number that fills the whole text and is above `low` (or equal, where `or_equal`).
double parse_number(std::string_view text, double low, bool or_equal, const std::string& demand) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool is_in_range = or_equal ? value >= low : value > low;
    if (error != std::errc() || stop != end || !std::isfinite(value) || !is_in_range)
        throw UsageError(demand);
    return value;
}

/// "x,y,z", also with blanks between.
Point3 parse_point(std::string_view text) {
    const std::string demand = "must be X,Y,Z, three numbers";
    Point3 point;
    for (double* const coordinate : {&point.x, &point.y, &point.z}) {
        const bool last = coordinate == &point.z;
        const std::size_t end = last ? text.size() : text.find_first_of(", ");
        if (end == std::string_view::npos) throw UsageError(demand);
        *coordinate =
            parse_number(text.substr(0, end), std::numeric_limits<double>::lowest(), true, demand);
        if (last) break;
        text.remove_prefix(end + 1);
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    }
    return point;
}

void apply_answers(Options& options, const std::string& value) {
    options.answer_parts = {};
    std::string_view text = value;
    while (true) {
        const std::string_view part = text.substr(0, text.find(','));
        if (part == "point")
            options.answer_parts.point = true;
        else if (part == "normal")
            options.answer_parts.normal = true;
        else if (part == "def")
            options.answer_parts.def = true;
        else
            throw UsageError("must be point, normal or def, or several with commas between");
        if (part.size() == text.size()) return;
        text.remove_prefix(part.size() + 1);
    }
}

void apply_samples(Options& options, const std::string& value) {
    options.samples = parse_integer(value, 1, kMaxSamples,
                                    "must be a whole number 1 to " + std::to_string(kMaxSamples));
}

void apply_fov(Options& options, const std::string& value) {
    constexpr double kHalfTurn = 180;
    const std::string demand = "must be degrees above 0 and below 180";
    options.fov_degrees = parse_number(value, 0, false, demand);
    if (*options.fov_degrees >= kHalfTurn) throw UsageError(demand);
}

std::string non_empty(const std::string& value, const std::string& what) {
    if (value.empty()) throw UsageError("needs " + what);
    return value;
}

void apply_resolution(Options& options, const std::string& value) {
    const int most = options.max_side_pixels;
    const std::string demand = "must be W,H or WxH, each side 1 to " + std::to_string(most) +
                               " pixels (limit " + std::to_string(most) + ", --max-side)";
    const std::size_t comma = value.find_first_of(",xX");
    if (comma == std::string::npos) throw UsageError(demand);
    const std::string_view text = value;
    options.resolution = {parse_integer(text.substr(0, comma), 1, most, demand),
                          parse_integer(text.substr(comma + 1), 1, most, demand)};
}

void apply_repetitions(Options& options, const std::string& value) {
    const std::string limit = std::to_string(kMaxRepetitions);
    options.repetitions =
        parse_integer(value, 1, kMaxRepetitions,
                      "must be a whole number 1 to " + limit + " (limit " + limit + ")");
}

void apply_type(Options& options, const std::string& value) {
    std::string name = value;  // in any letter case
    for (char& c : name)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    options.profile.type = parse_choice(kOctreeTypes, name);
    options.type_given = true;
}

void apply_profile(Options& options, const std::string& value) {
    const OctreeType type = options.profile.type;
    options.profile = parse_choice(kProfiles, value)();
    // --type comes earlier in the table and belongs to the user whatever the profile.
    if (options.type_given) options.profile.type = type;
    options.profile_name = value;
    if (value == "thesis") options.defaults = &x3d::thesis_defaults;
}

void apply_compare(Options& options, const std::string& value) {
    if (!value.empty() && value != "brute") throw UsageError("must be brute, or nothing");
    options.compare = true;
    options.compare_brute_force = !value.empty();
}

void apply_max_objects(Options& options, const std::string& value) {
    constexpr std::size_t kMost = 1'000'000'000;
    options.profile.max_objects =
        parse_integer(value, std::size_t{1}, kMost, "must be a whole number 1 to 1000000000");
}

void apply_step(Options& options, const std::string& value) {
    options.profile.step.reset();
    if (value != "exact")
        options.profile.step = parse_number(value, 0, false, "must be exact or a number > 0");
}

void apply_bias(Options& options, const std::string& value) {
    options.profile.bias.reset();
    if (value != "exact")
        options.profile.bias = parse_number(value, 0, true, "must be exact or a number >= 0");
}

void apply_isa(Options& options, const std::string& value) {
    options.isa = parse_choice(kInstructionSets, value);
    std::string supported;
    for (const InstructionSet isa : supported_instruction_sets()) {
        if (isa == options.isa) return;
        supported += (supported.empty() ? "" : ", ") + std::string(name_of(kInstructionSets, isa));
    }
    throw UsageError("this machine has " + supported);
}

void apply_octree(Options& options, const std::string& value) {
    if (octree_format(value) == nullptr) throw UsageError("octrees are .x3d, .json or .bin");
    options.octree = value;
}

void apply_pixel(Options& options, const std::string& value) {
    const std::string demand = "must be x,y within the picture, counted from 0,0 at its top left";
    const std::size_t comma = value.find(',');
    if (comma == std::string::npos) throw UsageError(demand);
    const std::string_view text = value;
    options.pixel = {
        parse_integer(text.substr(0, comma), 0, options.resolution.width - 1, demand),
        parse_integer(text.substr(comma + 1), 0, options.resolution.height - 1, demand)};
}

/// A whole number from 1 to `most`.
std::size_t parse_limit(const std::string& value, std::size_t most) {
    return parse_integer(value, std::size_t{1}, most,
                         "must be a whole number 1 to " + std::to_string(most));
}

constexpr std::size_t kMostThings = 1'000'000'000;
constexpr std::size_t kMostBytes = 1'000'000'000'000;

std::vector<Flag> camera_flags() {
    return {
        {"from", "--from", "X,Y,Z", "",
         "the camera's place; without --at it looks at the middle of the scene",
         [](Options& o, const std::string& v) { o.from = parse_point(v); }},
        {"at", "--at", "X,Y,Z", "", "the point in the middle of the picture, +y upwards",
         [](Options& o, const std::string& v) { o.at = parse_point(v); }},
        {"fov", "--fov", "DEGREES", "", "the smaller of the two angles of view", apply_fov},
    };
}

std::vector<Flag> scene_flags() {
    const x3d::Limits standard;
    return {
        {"viewpoint", "--viewpoint", "NAME|N|standard|fit", "",
         "the camera: a Viewpoint's DEF or description, or its number from 1; the standard's at "
         "0 0 10; or one that shows the whole scene; else the first Viewpoint, or where there is "
         "none the standard's if it shows the scene well, else the fitted one",
         [](Options& o, const std::string& v) { o.viewpoint = non_empty(v, "a name or number"); }},
        {"defaults", "--defaults", joined_names(kDefaults), "by profile",
         "what stands in for missing fields: the standard's, or the published program's, which "
         "also "
         "ignores light radii and keeps coincident shapes",
         [](Options& o, const std::string& v) { o.defaults = parse_choice(kDefaults, v); }},
        {"strict", "--strict", "", "",
         "refuse a scene of which something would be left out because it cannot be read",
         [](Options& o, const std::string&) { o.strict = true; }},
        {"describe", "--describe", "", "",
         "print what was read (shapes, lights, camera, bounds, warnings) and draw nothing",
         [](Options& o, const std::string&) { o.describe = true; }},
        {"max-depth", "--max-depth", "N", std::to_string(standard.depth),
         "refuse scenes of elements nested deeper, in the file or by USE and Inline; up to " +
             std::to_string(kLargestMaxDepth),
         [](Options& o, const std::string& v) {
             o.limits.depth = parse_limit(v, kLargestMaxDepth);
         }},
        {"max-elements", "--max-elements", "N", std::to_string(standard.elements),
         "refuse scenes of more elements, in the file or by USE and Inline",
         [](Options& o, const std::string& v) { o.limits.elements = parse_limit(v, kMostThings); }},
        {"max-attributes", "--max-attributes", "N", std::to_string(standard.attributes),
         "refuse files of more attributes",
         [](Options& o, const std::string& v) {
             o.limits.attributes = parse_limit(v, kMostThings);
         }},
        {"max-shapes", "--max-shapes", "N", std::to_string(standard.shapes),
         "refuse scenes of more Shapes, each USE and Inline counted",
         [](Options& o, const std::string& v) { o.limits.shapes = parse_limit(v, kMostThings); }},
        {"max-vertices", "--max-vertices", "N", std::to_string(standard.vertices),
         "refuse scenes whose meshes read more points, indices, normals and colors",
         [](Options& o, const std::string& v) { o.limits.vertices = parse_limit(v, kMostThings); }},
        {"max-file-size", "--max-file-size", "BYTES", std::to_string(standard.file_bytes),
         "refuse scenes of more bytes, unpacked and with all that they Inline",
         [](Options& o, const std::string& v) {
             o.limits.file_bytes = parse_limit(v, kMostBytes);
         }},
        {"max-side", "--max-side", "N", std::to_string(kMaxSidePixels),
         "refuse pictures wider or higher than N pixels; up to " + std::to_string(kLargestMaxSide),
         [](Options& o, const std::string& v) {
             o.max_side_pixels = static_cast<int>(parse_limit(v, kLargestMaxSide));
         }},
    };
}

std::vector<Flag> thesis_flags() {
    const std::string standard_resolution =
        std::to_string(Resolution().width) + "," + std::to_string(Resolution().height);
    return {
        {"file", "--file", "PATH", Options().file,
         "the X3D scene, --file= may be left out, and so may .x3d or .x3dz; - reads standard input",
         [](Options& o, const std::string& v) { o.file = non_empty(v, "a file name"); }},
        {"rep", "--rep", "N", std::to_string(Options().repetitions),
         "build and trace N times and print the average; 1 to " + std::to_string(kMaxRepetitions),
         apply_repetitions},
        {"res", "--res", "W,H", standard_resolution,
         "size of the picture, W,H or WxH, each side 1 to " + std::to_string(kMaxSidePixels) +
             " pixels",
         apply_resolution},
        {"type", "--type", joined_names(kOctreeTypes), "uniform",
         "the octree; by default the fast profile takes what it measures to be smaller",
         apply_type},
        {"showoctree", "-showoctree", "", "", "print the octree as text first (extremely verbose)",
         [](Options& o, const std::string&) { o.show_octree = true; }},
        {"compare", "-compare", "[=brute]", "",
         "render once each with the uniform octree and the non-uniform one (tiles: and the exact "
         "profile's), with =brute also by brute force, whose cost is said beforehand; print how "
         "far "
         "the pictures are apart and write the difference picture",
         apply_compare},
        {"help", "-h, --help", "", "", "print this list",
         [](Options& o, const std::string&) { o.help = true; }},
    };
}

std::vector<Flag> profile_flags() {
    return {
        {"profile", "--profile", joined_names(kProfiles), "exact",
         "a bundle of the answers below: right numbers, the published program, or the right "
         "numbers' picture in the least time",
         apply_profile},
        {"tracer", "--tracer", joined_names(kTracers), "by profile",
         "one ray at a time, or groups of rays in vector registers, which decide every answer "
         "below but the type themselves",
         [](Options& o, const std::string& v) { o.profile.tracer = parse_choice(kTracers, v); }},
        {"threads", "--threads", "N", std::to_string(Options().threads),
         "threads, up to " + std::to_string(kMaxThreads) +
             "; 0: one for each core; with the exact profile any but 1 bring the tile tracer, "
             "whose "
             "picture is the same",
         [](Options& o, const std::string& v) {
             o.threads = parse_integer(
                 v, 0, kMaxThreads, "must be a whole number 0 to " + std::to_string(kMaxThreads));
         }},
        {"isa", "--isa", joined_names(kInstructionSets), "",
         "instruction set of the tile tracer; none given: the best of the machine", apply_isa},
        {"midpoint", "--midpoint", joined_names(kMidpoints), "by profile",
         "where a non-uniform voxel is cut: at its centre, by true areas, or by the thesis' search "
         "as its program ran it (two names)",
         [](Options& o, const std::string& v) {
             o.profile.midpoint = parse_choice(kMidpoints, v);
         }},
        {"costs", "--costs", joined_names(kCosts), "by profile",
         "when a cut pays: by the published costs and rules, or by measured ones",
         [](Options& o, const std::string& v) { o.profile.costs = parse_choice(kCosts, v); }},
        {"max-objects", "--max-objects", "N", "",
         "cut until a voxel holds at most N, whatever it costs", apply_max_objects},
        {"leaves", "--leaves", joined_names(kLeafContents), "by profile",
         "what voxels hold: whole shapes, or spheres and single triangles",
         [](Options& o, const std::string& v) {
             o.profile.leaves = parse_choice(kLeafContents, v);
         }},
        {"walk", "--walk", joined_names(kWalks), "by profile",
         "how the next voxel is found: by its name, or down from the root",
         [](Options& o, const std::string& v) { o.profile.walk = parse_choice(kWalks, v); }},
        {"step", "--step", "exact|K", "by profile",
         "how a ray enters the next voxel: at the face itself, or K smallest widths past it",
         apply_step},
        {"precision", "--precision", joined_names(kPrecisions), "by profile",
         "arithmetic of the intersection tests",
         [](Options& o, const std::string& v) {
             o.profile.precision = parse_choice(kPrecisions, v);
         }},
        {"bias", "--bias", "exact|B", "by profile",
         "where shadow rays start: on the surface itself, or B along its normal", apply_bias},
        {"back-faces", "--back-faces", joined_names(kBackFaces), "by profile",
         "of shapes with solid=\"true\": invisible to the camera and to lights, or drawn",
         [](Options& o, const std::string& v) {
             o.profile.back_faces = parse_choice(kBackFaces, v);
         }},
    };
}

std::vector<Flag> output_flags() {
    return {
        {"rays", "--rays", "FILE", "",
         "answer the rays of FILE and draw nothing: a line each, ox oy oz dx dy dz, or a NumPy "
         "array "
         "of n x 6; answers as an array where --out ends in .npy",
         [](Options& o, const std::string& v) { o.rays = non_empty(v, "a file name"); }},
        {"answers", "--answers", "point,normal,def", "",
         "what --rays tells of a hit besides, some of these: where it is, the shape's unit normal "
         "there, and its DEF or that of the nearest node around it",
         apply_answers},
        {"study", "--study", "[=FILE]", "",
         "render with each combination of answers worth comparing, --rep times, and print speed "
         "against error; write every figure to FILE as JSON",
         [](Options& o, const std::string& v) {
             o.study = true;
             if (!v.empty()) o.study_json = v;
         }},
        {"out", "--out", "FILE", "",
         "the picture (default: beside the scene), .png or .bmp by its ending; or the rays' "
         "answers; -: standard output (BMP), and the report to standard error",
         [](Options& o, const std::string& v) { o.out = non_empty(v, "a file name"); }},
        {"samples", "--samples", "N", "1",
         "make each pixel the mean of N x N exact ones, rounded to the nearest; 1 to " +
             std::to_string(kMaxSamples),
         apply_samples},
        {"json", "--json", "FILE", "", "write counts and every raw time to FILE",
         [](Options& o, const std::string& v) { o.json = non_empty(v, "a file name"); }},
        {"headlight", "--headlight", joined_names(kHeadlights), "auto",
         "a light at the camera; auto: as the file says, or where it has no light",
         [](Options& o, const std::string& v) { o.headlight = parse_choice(kHeadlights, v); }},
        {"error", "--error", "", "",
         "render once more with the exact profile, untimed, and report how far the picture is from "
         "that one",
         [](Options& o, const std::string&) { o.error = true; }},
        {"counters", "--counters", "", "",
         "count intersection tests and voxel searches in an extra pass that is not timed (--json "
         "does, too); of the tile tracer: rays, and the time of each stage",
         [](Options& o, const std::string&) { o.counters = true; }},
        {"quiet", "--quiet", "", "", "no report on standard output",
         [](Options& o, const std::string&) { o.quiet = true; }},
        {"version", "--version", "", "",
         "print version, commit, compiler, instruction sets and libraries",
         [](Options& o, const std::string&) { o.version = true; }},
    };
}

std::vector<Flag> look_flags() {
    return {
        {"heatmap", "--heatmap", joined_names(kHeatmaps), "",
         "paint what each pixel cost, beside the picture as NAME-tests.png: intersection tests, "
         "voxel searches, or the stage of arithmetic that its tests needed; with -compare one for "
         "each octree, on one scale",
         [](Options& o, const std::string& v) { o.heatmap = parse_choice(kHeatmaps, v); }},
        {"heatmap-max", "--heatmap-max", "N", "",
         "the value at the top of the heat map's scale, so that several share one; else its own "
         "largest value",
         [](Options& o, const std::string& v) {
             o.heatmap_max = parse_number(v, 0, false, "must be a number > 0");
         }},
        {"planes", "--planes", "PREFIX", "",
         "write a NumPy array of one value a pixel each to PREFIX-tests.npy, -searches, -t, "
         "-shape, -triangle and -stage",
         [](Options& o, const std::string& v) { o.planes = non_empty(v, "a prefix of names"); }},
        {"octree", "--octree", "FILE", "",
         "write the octree's voxels: .x3d, a wireframe colored by depth for Blender and others; "
         ".json; or .bin, 8 float32 a voxel",
         apply_octree},
        {"pixel", "--pixel", "x,y", "",
         "tell the life of one pixel's ray, its voxels, tests, shadow rays and colors, as text and "
         "with --json as JSON, and draw nothing; from 0,0, the top left",
         apply_pixel},
    };
}

std::vector<Flag> make_flags() {
    const std::pair<const char*, std::vector<Flag>> groups[] = {
        {"Scene, picture and octree, as in the thesis", thesis_flags()},
        {"Profile and its answers", profile_flags()},
        {"What is made and told", output_flags()},
        {"Looking into a picture", look_flags()},
        {"Camera", camera_flags()},
        {"Reading the scene", scene_flags()}};
    std::vector<Flag> all;
    for (const auto& [heading, part] : groups) {
        all.insert(all.end(), part.begin(), part.end());
        for (auto flag = all.end() - static_cast<std::ptrdiff_t>(part.size()); flag != all.end();
             ++flag)
            flag->group = heading;
    }
    return all;
}

}  // namespace

const std::vector<Flag>& flags() {
    static const std::vector<Flag> table = make_flags();
    return table;
}

}  // namespace nuvo::app
