#include "nuvo/app/study.h"

#include <algorithm>
#include <iostream>
#include <random>
#include <sstream>

#include "meter.h"
#include "nuvo/app/choices.h"
#include "nuvo/app/clocks.h"
#include "nuvo/app/commands.h"
#include "nuvo/image/file_writer.h"
#include "scene_files.h"

namespace nuvo::app {
namespace {

struct Combination {
    std::string_view profile;
    std::string_view change;
};

// One answer at a time around either profile, then the corners: both octrees at their fastest,
// cheap numbers in the right structure, and right numbers in the published one.
constexpr Combination kCombinations[] = {
    {"exact", ""},
    {"exact", "--type=nonuniform"},
    {"exact", "--walk=descent"},
    {"exact", "--step=1"},
    {"exact", "--step=0.1"},
    {"exact", "--step=0.01"},
    {"exact", "--step=0.001"},
    {"exact", "--step=0.0001"},
    {"exact", "--step=0.00001"},
    {"exact", "--precision=double"},
    {"exact", "--precision=float"},
    {"exact", "--bias=0"},
    {"exact", "--bias=0.004"},
    {"exact", "--bias=0.04"},
    {"fast", ""},
    {"fast", "--type=nonuniform"},
    {"thesis", ""},
    {"thesis", "--type=nonuniform"},
    {"thesis", "--walk=descent"},
    {"thesis", "--step=1"},
    {"thesis", "--step=0.1"},
    {"thesis", "--step=0.01"},
    {"thesis", "--step=0.001"},
    {"thesis", "--step=0.0001"},
    {"thesis", "--step=0.00001"},
    {"thesis", "--step=exact"},
    {"thesis", "--precision=double"},
    {"thesis", "--precision=exact"},
    {"thesis", "--bias=0.004"},
    {"thesis", "--bias=0"},
    {"thesis", "--bias=exact"},
    {"exact", "--type=nonuniform --walk=descent"},
    {"exact", "--type=nonuniform --walk=descent --precision=double"},
    {"exact", "--precision=double --bias=0.004"},
    {"exact", "--precision=float --bias=0"},
    {"exact", "--precision=float --bias=0.04"},
    {"exact", "--step=0.01 --precision=float --bias=0.04"},
    {"thesis", "--precision=double --bias=exact"},
    {"thesis", "--step=exact --precision=exact --bias=exact"},
    {"thesis", "--type=nonuniform --step=exact --precision=exact --bias=exact"},
};

OctreeType other(OctreeType type) {
    return type == OctreeType::kUniform ? OctreeType::kNonuniform : OctreeType::kUniform;
}

StudyCase study_case(const Combination& combination, const Profile& given) {
    std::vector<std::string> arguments{"--profile=" + std::string(combination.profile)};
    std::istringstream words{std::string(combination.change)};
    std::string change;
    for (std::string word; words >> word;) {
        // The table is written for the uniform type; with the other one given it is mirrored.
        if (word.starts_with("--type="))
            word = "--type=" + std::string(name_of(kOctreeTypes, other(given.type)));
        change += (change.empty() ? "" : " ") + word;
        arguments.push_back(std::move(word));
    }
    StudyCase result{std::string(combination.profile), change, parse(arguments).profile};
    result.answers.back_faces = given.back_faces;  // what is seen; the study is about how well
    if (change.find("--type=") == std::string::npos) result.answers.type = given.type;
    if (result.answers.tracer == TracerChoice::kTiles) return result;
    result.answers.midpoint = given.midpoint;
    result.answers.max_objects = given.max_objects;
    return result;
}

double median(std::vector<double> values) {
    const std::size_t half = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// What a case must be right about; no facts: they are not known.
struct Truth {
    std::vector<PixelFacts> facts;
    Image picture;
};

/// The same by the tile tracer, which tells its picture only.
void measure_tiles(const Scene& scene, Resolution resolution, Meter& meter, StudyRow& row,
                   Truth* shown) {
    Progress* const progress = meter.begin("building");
    const StageStopwatch build;
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastOptions options;
    options.type = row.what.answers.type;
    options.back_faces = row.what.answers.back_faces;
    options.progress = progress;
    FastTracer tracer(scene, primitives, options);
    row.build_seconds.push_back(build.seconds());
    meter.begin("tracing");
    const StageStopwatch trace;
    Image picture = tracer.render(resolution);
    row.trace_seconds.push_back(trace.seconds());
    if (shown != nullptr) *shown = {{}, std::move(picture)};
}

/// Builds and traces a case once; what it shows only where `shown` asks.
void measure(const Scene& scene, Resolution resolution, Meter& meter, StudyRow& row, Truth* shown) {
    const Profile& profile = row.what.answers;
    if (profile.tracer == TracerChoice::kTiles)
        return measure_tiles(scene, resolution, meter, row, shown);
    Progress* const progress = meter.begin("building");
    const StageStopwatch build;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile, progress);
    row.build_seconds.push_back(build.seconds());
    meter.begin("tracing");
    const StageStopwatch trace;
    Image picture = render(scene, primitives, octree, profile, resolution, progress);
    row.trace_seconds.push_back(trace.seconds());
    if (shown == nullptr) return;
    shown->picture = std::move(picture);
    meter.begin("tracing once more for facts");
    shown->facts = render_facts(scene, primitives, octree, profile, resolution, progress);
}

void compare_with(const Truth& truth, const Truth& shown, StudyRow& row) {
    row.difference = image::compare(truth.picture, shown.picture);
    if (shown.facts.empty()) return;
    std::size_t wrong_primitives = 0, wrong_shadows = 0;
    for (std::size_t i = 0; i < truth.facts.size(); ++i) {
        if (truth.facts[i].primitive != shown.facts[i].primitive) {
            ++wrong_primitives;
        } else if (truth.facts[i].lit != shown.facts[i].lit) {
            ++wrong_shadows;
        }
    }
    row.wrong_primitives = wrong_primitives;
    row.wrong_shadows = wrong_shadows;
}

}  // namespace

std::vector<StudyCase> study_cases(const Profile& given) {
    std::vector<StudyCase> cases;
    for (const Combination& combination : kCombinations)
        cases.push_back(study_case(combination, given));
    return cases;
}

MedianInterval median_interval(std::span<const double> values) {
    constexpr int kResamples = 2000;
    constexpr double kTail = 0.025;  // outside a 95 % interval, on each side
    std::mt19937_64 random(values.size());
    std::vector<double> medians;
    std::vector<double> sample(values.size());
    for (int i = 0; i < kResamples; ++i) {
        for (double& value : sample) value = values[random() % values.size()];
        medians.push_back(median(sample));
    }
    std::sort(medians.begin(), medians.end());
    const auto cut = static_cast<std::size_t>(kTail * kResamples);
    return {median({values.begin(), values.end()}), medians[cut], medians[kResamples - 1 - cut]};
}

void mark_frontier(std::vector<StudyRow>& rows) {
    const auto beats = [](const StudyRow& a, const StudyRow& b) {
        return a.trace.median <= b.trace.median && a.difference.rms <= b.difference.rms &&
               (a.trace.median < b.trace.median || a.difference.rms < b.difference.rms);
    };
    for (StudyRow& row : rows)
        row.on_frontier = std::none_of(rows.begin(), rows.end(),
                                       [&](const StudyRow& rival) { return beats(rival, row); });
}

std::vector<StudyRow> run_study(const Scene& scene, const Options& options) {
    std::vector<StudyRow> rows;
    for (StudyCase& what : study_cases(options.profile)) rows.emplace_back().what = std::move(what);
    Meter meter(options.shows_progress());
    const auto rounds = static_cast<std::size_t>(options.repetitions);
    Truth truth, shown;
    for (int round = 0; round < options.repetitions; ++round) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            meter.begin_part("picture", static_cast<std::size_t>(round) * rows.size() + i + 1,
                             rounds * rows.size());
            if (round > 0) {
                // Every other round backwards, so that a machine that slows down does so for all.
                measure(scene, options.resolution, meter,
                        rows[round % 2 == 0 ? i : rows.size() - 1 - i], nullptr);
                continue;
            }
            measure(scene, options.resolution, meter, rows[i], i == 0 ? &truth : &shown);
            if (i > 0) compare_with(truth, shown, rows[i]);
        }
    }
    compare_with(truth, truth, rows.front());
    for (StudyRow& row : rows) {
        row.trace = median_interval(row.trace_seconds);
        row.build_median = median(row.build_seconds);
    }
    mark_frontier(rows);
    return rows;
}

ExitCode study_command(const Options& options) {
    const LoadedScene loaded = [&] {
        Meter meter(options.shows_progress());
        return load(options, meter);
    }();
    if (options.study_json) check_outputs({loaded.path}, {*options.study_json});
    const std::vector<StudyRow> rows = run_study(loaded.scene, options);
    const std::string& file = loaded.name;
    if (options.study_json)
        image::write_file_atomically(*options.study_json, study_json(options, file, rows));
    if (!options.quiet)
        (options.standard_output_taken() ? std::cerr : std::cout)
            << study_text(options, file, rows);
    return kDone;
}

}  // namespace nuvo::app
