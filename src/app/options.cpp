#include "nuvo/app/options.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <map>
#include <numeric>
#include <thread>

#include "nuvo/image/picture_file.h"

namespace nuvo::app {
namespace {

namespace po = boost::program_options;

/// Edits (insert, delete, replace, swap neighbours) that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min(
                {last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = last;
        last = row;
    }
    return last[b.size()];
}

/// The flag that a mistyped name was meant to be, if one is near.
const Flag* nearest_flag(std::string_view name) {
    const Flag* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const Flag& flag : flags()) {
        const bool begins = name.size() >= 3 && flag.name.compare(0, name.size(), name) == 0;
        const std::size_t distance = begins ? 1 : edit_distance(name, flag.name);
        if (distance >= least || distance >= name.size()) continue;
        least = distance;
        nearest = &flag;
    }
    return nearest;
}

std::string first_spelling(const Flag& flag) {
    return flag.spelling.substr(0, flag.spelling.find(','));
}

[[noreturn]] void fail_unknown(const std::string& token) {
    std::string name = token.substr(std::min(token.find_first_not_of('-'), token.size()));
    name.resize(std::min(name.find('='), name.size()));
    const Flag* const meant = nearest_flag(name);
    throw UsageError(token + ": unknown flag" +
                     (meant != nullptr ? ", did you mean " + first_spelling(*meant) + "?"
                                       : " (nuvo -h lists them)"));
}

po::options_description description() {
    po::options_description all;
    for (const Flag& flag : flags()) {
        const std::string names = flag.name == "help" ? "help,h" : flag.name;
        if (flag.value.empty()) {
            all.add_options()(names.c_str(), "");
        } else if (flag.may_stand_alone()) {
            all.add_options()(names.c_str(), po::value<std::string>()->implicit_value(""), "");
        } else {
            all.add_options()(names.c_str(), po::value<std::string>(), "");
        }
    }
    return all;
}

/// A word that is no flag is the scene.
void take_scene(const std::string& word, std::map<std::string, std::string>& given) {
    const std::string name = word.substr(0, word.find('='));
    for (const Flag& flag : flags())
        if (name.size() < word.size() && name == flag.name)
            throw UsageError(word + ": a flag begins with a dash, did you mean --" + word + "?");
    if (!given.emplace("file", word).second)
        throw UsageError(word + ": a second scene, beside " + given.at("file"));
}

/// Whether the word's value is the next word.
bool wants_value(const std::string& word) {
    const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());
    if (dashes == 0 || dashes > 2) return false;
    for (const Flag& flag : flags())
        if (flag.name == word.substr(dashes)) return !flag.value.empty() && !flag.may_stand_alone();
    return false;
}

/// A flag's value that was forgotten: the next word is a flag, too. A value that looks like one can
/// be given after =.
void check_value(const std::string& flag, const std::string& value) {
    const std::string name = value.substr(0, value.find('='));
    const bool is_flag = std::any_of(flags().begin(), flags().end(), [&](const Flag& other) {
        return name == "-" + other.name || name == "-h";
    });
    if (is_flag || value.starts_with("--"))
        throw UsageError(flag + ": needs a value, and " + value + " is a flag (" + flag + "=" +
                         value + " takes it as the value)");
}

/// Of all names only those of flags come to Boost, whose messages never end where a name holds
/// their own placeholders.
void check_known(const std::string& word) {
    if (word == "-h" || word == "--") return;
    const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());
    const std::string name = word.substr(dashes, word.find('=') - dashes);
    const bool known = std::any_of(flags().begin(), flags().end(),
                                   [&](const Flag& flag) { return flag.name == name; });
    if (!known || dashes > 2) fail_unknown(word);
}

/// The words that are neither flags nor their values, taken out of the arguments.
std::vector<std::string> take_words(std::vector<std::string>& arguments) {
    std::vector<std::string> words, flagged;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        const bool is_value = i > 0 && wants_value(arguments[i - 1]);
        if (is_value) check_value(arguments[i - 1], word);
        const bool is_flag = word.size() > 1 && word.front() == '-';
        if (is_flag && !is_value) check_known(word);
        (is_value || is_flag ? flagged : words).push_back(word);
    }
    arguments = std::move(flagged);
    return words;
}

/// Flag name to value, as typed. Values are checked later.
std::map<std::string, std::string> read_tokens(std::vector<std::string> arguments) {
    namespace style = po::command_line_style;
    const int any_dashes =
        (style::default_style & ~style::allow_guessing) | style::allow_long_disguise;
    const po::options_description all = description();
    std::map<std::string, std::string> given;
    const std::vector<std::string> words = take_words(arguments);
    try {
        const po::parsed_options parsed =
            po::command_line_parser(arguments).options(all).style(any_dashes).run();
        for (const po::option& option : parsed.options) {
            const std::string token =
                option.original_tokens.empty() ? option.string_key : option.original_tokens[0];
            const std::string value = option.value.empty() ? std::string() : option.value[0];
            if (!given.emplace(option.string_key, value).second)
                throw UsageError(token + ": given more than once");
        }
    } catch (const po::error& error) {
        throw UsageError(error.what());
    }
    for (const std::string& word : words) take_scene(word, given);
    return given;
}

void apply(const Flag& flag, const std::map<std::string, std::string>& given, Options& options) {
    const auto found = given.find(flag.name);
    if (found == given.end()) return;
    try {
        flag.apply(options, found->second);
    } catch (const UsageError& error) {
        throw UsageError(first_spelling(flag) + "=" + found->second + ": " + error.what());
    }
}

/// Answers that the tile tracer gives itself.
constexpr const char* kSerialAnswers[] = {"midpoint", "costs", "max-objects", "leaves",
                                          "walk",     "step",  "precision",   "bias"};

/// Several threads are the tile tracer's, whose picture is the exact profile's: they bring it where
/// nothing speaks for the other.
void take_tracer_of_threads(const std::map<std::string, std::string>& given, Options& options) {
    const auto is_given = [&given](const char* name) { return given.count(name) != 0; };
    if (options.threads == 1 || is_given("tracer") || options.show_octree || options.study) return;
    if (options.profile.precision != Precision::kExact || options.profile_name == "thesis") return;
    if (std::any_of(std::begin(kSerialAnswers), std::end(kSerialAnswers), is_given)) return;
    options.profile.tracer = TracerChoice::kTiles;
}

/// What has no meaning with the tile tracer, or none without it.
void check_tile_tracer(const Options& options, const std::map<std::string, std::string>& given) {
    const auto as_typed = [&given](const char* name) {
        return "--" + std::string(name) + "=" + given.at(name);
    };
    if (options.profile.tracer == TracerChoice::kSerial) {
        for (const char* own : {"threads", "isa"})
            if (given.count(own) != 0 && given.at(own) != "1")
                throw UsageError(as_typed(own) +
                                 ": the serial tracer has no choice of it (add --profile=fast)");
        return;
    }
    const std::string cause = as_typed(given.count("tracer") != 0    ? "tracer"
                                       : given.count("profile") != 0 ? "profile"
                                                                     : "threads");
    for (const char* fixed : kSerialAnswers)
        if (given.count(fixed) != 0)
            throw UsageError(as_typed(fixed) + " and " + cause +
                             " cannot be combined: the tile tracer answers that itself");
    if (options.profile.precision != Precision::kExact)
        throw UsageError("--profile=" + options.profile_name + " and " + cause +
                         " cannot be combined: the tile tracer knows no numbers but right ones");
    if (options.show_octree)
        throw UsageError("-showoctree and " + cause +
                         " cannot be combined: the tile tracer's voxels have no names to print "
                         "(add --tracer=serial)");
}

/// Planes, heat maps and octrees belong to pictures; a pixel is told of without one.
void check_looking(const Options& options, const std::map<std::string, std::string>& given) {
    const auto is_given = [&given](const char* name) { return given.count(name) != 0; };
    const auto refuse = [&](const char* flag, std::initializer_list<const char*> others) {
        for (const char* other : others)
            if (is_given(flag) && is_given(other))
                throw UsageError("--" + std::string(flag) + " and --" + other +
                                 " cannot be combined");
    };
    for (const char* flag : {"heatmap", "planes", "octree", "pixel"})
        refuse(flag, {"rays", "study", "describe"});
    refuse("pixel", {"compare", "heatmap", "planes", "error", "showoctree", "out", "counters"});
    if (options.heatmap_max && !options.heatmap)
        throw UsageError("--heatmap-max=" + given.at("heatmap-max") +
                         ": there is no heat map (add --heatmap=tests)");
    if (options.heatmap_max && options.heatmap == HeatmapOf::kStage)
        throw UsageError("--heatmap=stage has one scale: leave --heatmap-max out");
    if (options.heatmap == HeatmapOf::kStage && options.profile.precision != Precision::kExact)
        throw UsageError(
            "--heatmap=stage: tests in float or double have one stage only (add "
            "--precision=exact)");
}

/// Standard input and output are there once each.
void check_streams(const Options& options) {
    const auto is_stream = [](const std::optional<std::string>& name) {
        return name == kStandardStream;
    };
    if (options.file == kStandardStream && is_stream(options.rays))
        throw UsageError("--file=- and --rays=- cannot both be standard input");
    const bool bare_answers = options.rays && !options.out;
    if (is_stream(options.json) && (is_stream(options.out) || bare_answers))
        throw UsageError("--json=-: standard output is taken by " +
                         std::string(options.rays ? "the answers" : "the picture") +
                         " (name a file for one of them)");
    if (options.compare && is_stream(options.out))
        throw UsageError(
            "-compare writes two pictures, which standard output cannot take (give --out=FILE)");
    if (options.heatmap && is_stream(options.out))
        throw UsageError(
            "--heatmap is written beside the picture, and standard output has no place (give "
            "--out=FILE)");
    if (options.show_octree && options.standard_output_taken())
        throw UsageError("-showoctree prints to standard output, which is taken by other bytes");
}

void check_samples(const Options& options, const std::map<std::string, std::string>& given) {
    if (given.count("samples") == 0) return;
    for (const char* other : {"heatmap", "planes", "pixel"})
        if (given.count(other) != 0)
            throw UsageError("--samples=" + given.at("samples") +
                             ": a pixel is several rays, of "
                             "which --" +
                             other + " cannot tell (leave one out)");
    if (options.rays || options.study || options.describe)
        throw UsageError("--samples=" + given.at("samples") + " is about one picture: leave " +
                         (options.rays    ? "--rays"
                          : options.study ? "--study"
                                          : "--describe") +
                         " out");
    const Resolution traced = options.traced_resolution();
    if (traced.width > options.max_side_pixels || traced.height > options.max_side_pixels)
        throw UsageError("--samples=" + given.at("samples") + ": " + std::to_string(traced.width) +
                         " x " + std::to_string(traced.height) +
                         " pixels to trace, each side may be up to " +
                         std::to_string(options.max_side_pixels) + " (--max-side)");
}

void check_combinations(const Options& options, const std::map<std::string, std::string>& given) {
    const auto is_given = [&given](const char* name) { return given.count(name) != 0; };
    if (options.compare && is_given("type"))
        throw UsageError("-compare renders every type: leave --type out");
    if (options.compare && options.rays) throw UsageError("-compare and --rays cannot be combined");
    if (options.error && (options.compare || options.rays || options.describe))
        throw UsageError("--error is about one picture: leave " +
                         std::string(options.compare ? "-compare"
                                     : options.rays  ? "--rays"
                                                     : "--describe") +
                         " out");
    if (options.show_octree && options.rays)
        throw UsageError("-showoctree and --rays cannot be combined");
    if (options.study)
        for (const char* other : {"compare", "rays", "showoctree", "profile", "costs", "leaves",
                                  "walk", "step", "precision", "bias", "tracer", "threads", "isa",
                                  "samples", "out", "json", "counters", "error"})
            if (is_given(other))
                throw UsageError(
                    std::string("--study chooses the answers and the outputs: leave --") + other +
                    " out");
    if (options.describe)
        for (const char* other : {"compare", "rays", "showoctree", "out", "json"})
            if (is_given(other))
                throw UsageError(std::string("--describe draws nothing: leave ") + other + " out");
    if (is_given("answers") && !options.rays)
        throw UsageError("--answers=" + given.at("answers") +
                         ": there are no rays to answer (add --rays=FILE)");
    check_streams(options);
    check_samples(options, given);
    if (options.out && !options.rays && !image::picture_format(*options.out))
        throw UsageError("--out=" + *options.out + ": pictures are .bmp or .png");
    check_looking(options, given);
    check_tile_tracer(options, given);
    if (is_given("midpoint") && !options.compare && !options.study &&
        options.profile.type == OctreeType::kUniform)
        throw UsageError("--midpoint=" + given.at("midpoint") +
                         ": a uniform octree has no choice of midpoint (add --type=nonuniform)");
    if (is_given("max-objects") && is_given("costs"))
        throw UsageError("--max-objects replaces the costs: leave --costs out");
}

}  // namespace

bool Options::standard_output_taken() const {
    return out == kStandardStream || json == kStandardStream || study_json == kStandardStream ||
           (rays && !out);
}

int Options::thread_count() const {
    return threads > 0 ? threads
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Resolution Options::traced_resolution() const {
    return {resolution.width * samples, resolution.height * samples};
}

Options parse(const std::vector<std::string>& arguments) {
    const std::map<std::string, std::string> given = read_tokens(arguments);
    Options options;
    options.arguments = arguments;
    options.profile = exact_profile();
    options.help = given.count("help") != 0;
    options.version = given.count("version") != 0;
    if (options.help || options.version) return options;
    // In the table's order, so that a profile precedes its parts; but first what --res is held to.
    for (const bool first : {true, false})
        for (const Flag& flag : flags())
            if ((flag.name == "max-side") == first) apply(flag, given, options);
    take_tracer_of_threads(given, options);
    const bool draws = !options.rays && !options.study && !options.describe && !options.pixel;
    if (options.file == kStandardStream && !options.out && draws) options.out = kStandardStream;
    check_combinations(options, given);
    return options;
}

}  // namespace nuvo::app
