// Measures every method of cutting on one scene and prints JSON:
//   nuvo_study --file=SCENE.x3d [option]...
#include <charconv>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "gap.h"
#include "measure.h"
#include "nuvo/app/json_writer.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::study {
namespace {

constexpr std::string_view kUsage =
    "usage: nuvo_study --file=SCENE.x3d [option]...   figures of every method, as JSON\n"
    "  --methods=A,B,...      some only; the first's picture is what others are compared with\n"
    "  --leaves=primitives|shapes\n"
    "  --in-program           with the program's own additions to a method's planes\n"
    "  --costs=thesis         cut by the published costs and order\n"
    "  --step=S               price of a step in tests (6)\n"
    "  --evaluations=N        of a search in one voxel (100)\n"
    "  --res=W,H --rounds=N --rays=N\n"
    "                         --rounds=0: counts only; -1: nothing but --gap\n"
    "  --others               grid, kd-tree and BVH, too\n"
    "  --gap=N                distance from exact optima on up to N voxels\n"
    "  --list                 the methods\n";

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Request {
    std::string file;
    std::vector<const Method*> methods;
    bool others = false;
    bool list = false;
    std::size_t gap_voxels = 0;
    MeasureOptions options;
};

template <typename T>
T number(std::string_view text, std::string_view argument) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(std::string(argument) + ": not a number");
    return value;
}

std::vector<const Method*> parse_methods(std::string_view names) {
    std::vector<const Method*> found;
    while (!names.empty()) {
        const std::size_t comma = std::min(names.find(','), names.size());
        const std::string_view name = names.substr(0, comma);
        names.remove_prefix(std::min(comma + 1, names.size()));
        const Method* method = find_method(name);
        if (!method) throw UsageError("no method is called " + std::string(name) + "; see --list");
        found.push_back(method);
    }
    return found;
}

void parse_argument(std::string_view argument, Request& request) {
    const std::size_t sign = std::min(argument.find('='), argument.size());
    const std::string_view key = argument.substr(0, sign);
    const std::string_view value = argument.substr(std::min(sign + 1, argument.size()));
    MeasureOptions& options = request.options;
    if (key == "--file") {
        request.file = value;
    } else if (key == "--methods") {
        request.methods = parse_methods(value);
    } else if (argument == "--leaves=shapes") {
        options.tree.leaves = LeafContent::kShapes;
    } else if (argument == "--leaves=primitives") {
        options.tree.leaves = LeafContent::kPrimitives;
    } else if (argument == "--in-program") {
        options.tree.in_program = true;
    } else if (argument == "--costs=thesis") {
        options.tree.thesis_costs = true;
    } else if (key == "--step") {
        options.tree.step = number<double>(value, argument);
    } else if (key == "--evaluations") {
        options.evaluations = number<int>(value, argument);
    } else if (key == "--rounds") {
        options.rounds = number<int>(value, argument);
    } else if (key == "--rays") {
        options.random_rays = number<std::size_t>(value, argument);
    } else if (key == "--gap") {
        request.gap_voxels = number<std::size_t>(value, argument);
    } else if (key == "--res" && value.find(',') != std::string_view::npos) {
        const std::size_t comma = value.find(',');
        options.resolution = {number<int>(value.substr(0, comma), argument),
                              number<int>(value.substr(comma + 1), argument)};
    } else if (argument == "--others") {
        request.others = true;
    } else if (argument == "--list") {
        request.list = true;
    } else {
        throw UsageError("unknown option " + std::string(argument));
    }
}

void write_work(app::JsonWriter& json, std::string_view name, const Work& work) {
    json.key(name);
    json.begin_object();
    json.member("rays", work.rays);
    json.member("tests", work.tests);
    json.member("leaves", work.leaves);
    json.member("nodes", work.nodes);
    json.end_object();
}

void write_row(app::JsonWriter& json, const Row& row) {
    json.begin_object();
    json.member("name", row.name);
    json.member("kind", row.kind);
    json.member("leaves", row.sizes.leaves);
    json.member("references", row.sizes.references);
    json.member("depth", row.sizes.depth);
    json.member("bytes", row.sizes.bytes);
    json.member("sah", row.sah);
    json.member("evaluations", row.evaluations);
    json.member("same_picture", row.same_picture);
    json.member("same_as_brute_force", row.same_as_brute);
    write_work(json, "camera", row.camera);
    write_work(json, "random", row.random);
    json.member("build_seconds", row.build_seconds);
    json.member("trace_seconds", row.trace_seconds);
    json.end_object();
}

void write_gap(app::JsonWriter& json, const Method& method, std::string_view objective,
               const Gap& gap) {
    json.begin_object();
    json.member("name", method.name);
    json.member("objective", objective);
    json.member("voxels", gap.voxels);
    json.member("without", gap.without);
    json.member("exact", gap.exact);
    json.member("unbounded", gap.unbounded);
    json.member("mean", gap.mean);
    json.member("worst", gap.worst);
    json.member("evaluations", gap.evaluations);
    json.end_object();
}

void write_gaps(app::JsonWriter& json, const Scene& scene, const Request& request) {
    const Primitives primitives = flatten(scene, request.options.tree.leaves);
    const std::vector<AskedVoxel> voxels =
        asked_voxels(scene, primitives, request.options.tree, request.gap_voxels);
    for (const Method* method : request.methods) {
        write_gap(json, *method, "eq19-medians",
                  gap_of(*method, voxels, Weight::kShare, Space::kMedians));
        write_gap(json, *method, "eq19-voxel",
                  gap_of(*method, voxels, Weight::kShare, Space::kVoxel));
        write_gap(json, *method, "area-voxel",
                  gap_of(*method, voxels, Weight::kArea, Space::kVoxel));
    }
}

void run(Request request) {
    if (request.list) {
        for (const Method& method : methods())
            std::cout << method.name << '\t' << method.source << '\n';
        return;
    }
    if (request.file.empty()) throw UsageError("--file=SCENE.x3d is needed");
    if (request.methods.empty())
        for (const Method& method : methods()) request.methods.push_back(&method);
    const Scene scene = x3d::read_file(request.file);
    app::JsonWriter json;
    json.begin_object();
    json.member("file", request.file);
    json.member("lights", scene.lights.size());
    const Primitives primitives = flatten(scene, request.options.tree.leaves);
    json.member("items", primitives.item_count());
    json.member("primitives", primitives.sources.size());
    json.member("leaf_content",
                request.options.tree.leaves == LeafContent::kShapes ? "shapes" : "primitives");
    json.member("in_program", request.options.tree.in_program);
    json.member("thesis_costs", request.options.tree.thesis_costs);
    json.member("step", request.options.tree.step);
    json.member("pixels", request.options.resolution.width * request.options.resolution.height);
    json.key("rows");
    json.begin_array();
    if (request.options.rounds >= 0)
        for (const Row& row : measure(scene, request.methods, request.others, request.options))
            write_row(json, row);
    json.end_array();
    json.key("gaps");
    json.begin_array();
    if (request.gap_voxels > 0) write_gaps(json, scene, request);
    json.end_array();
    json.end_object();
    std::cout << json.text();
}

}  // namespace
}  // namespace nuvo::study

int main(int argc, char** argv) {
    using namespace nuvo::study;
    try {
        Request request;
        for (int i = 1; i < argc; ++i) parse_argument(argv[i], request);
        run(std::move(request));
        return 0;
    } catch (const UsageError& error) {
        std::cerr << "nuvo_study: " << error.what() << '\n' << kUsage;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "nuvo_study: " << error.what() << '\n';
        return 3;
    }
}
