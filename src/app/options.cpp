#include "nuvo/app/options.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <map>
#include <numeric>

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

/// Flag name to value, as typed. Values are checked later.
std::map<std::string, std::string> read_tokens(const std::vector<std::string>& arguments) {
    namespace style = po::command_line_style;
    const int any_dashes =
        (style::default_style & ~style::allow_guessing) | style::allow_long_disguise;
    const po::options_description all = description();
    std::map<std::string, std::string> given;
    try {
        const po::parsed_options parsed = po::command_line_parser(arguments)
                                              .options(all)
                                              .style(any_dashes)
                                              .allow_unregistered()
                                              .run();
        for (const po::option& option : parsed.options) {
            const std::string token =
                option.original_tokens.empty() ? option.string_key : option.original_tokens[0];
            if (option.position_key != -1)
                throw UsageError(token + ": not a flag (a scene is given as --file=" + token + ")");
            if (option.unregistered) fail_unknown(token);
            const std::string value = option.value.empty() ? std::string() : option.value[0];
            if (!given.emplace(option.string_key, value).second)
                throw UsageError(token + ": given more than once");
        }
    } catch (const po::error& error) {
        throw UsageError(error.what());
    }
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

/// What has no meaning with the tile tracer, or none without it.
void check_tile_tracer(const Options& options, const std::map<std::string, std::string>& given) {
    const auto as_typed = [&given](const char* name) {
        return "--" + std::string(name) + "=" + given.at(name);
    };
    if (options.profile.tracer == TracerChoice::kSerial) {
        for (const char* own : {"threads", "isa"})
            if (given.count(own) != 0)
                throw UsageError(as_typed(own) +
                                 ": the serial tracer has no choice of it (add --profile=fast)");
        return;
    }
    const std::string cause = as_typed(given.count("tracer") != 0 ? "tracer" : "profile");
    for (const char* fixed :
         {"midpoint", "costs", "max-objects", "leaves", "walk", "step", "precision", "bias"})
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
        for (const char* other :
             {"compare", "rays", "showoctree", "profile", "costs", "leaves", "walk", "step",
              "precision", "bias", "tracer", "threads", "isa", "out", "json", "counters", "error"})
            if (is_given(other))
                throw UsageError(
                    std::string("--study chooses the answers and the outputs: leave --") + other +
                    " out");
    if (options.describe)
        for (const char* other : {"compare", "rays", "showoctree", "out", "json"})
            if (is_given(other))
                throw UsageError(std::string("--describe draws nothing: leave ") + other + " out");
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

Options parse(const std::vector<std::string>& arguments) {
    const std::map<std::string, std::string> given = read_tokens(arguments);
    Options options;
    options.profile = exact_profile();
    options.help = given.count("help") != 0;
    options.version = given.count("version") != 0;
    if (options.help || options.version) return options;
    // In the table's order, so that a profile precedes its parts; but first what --res is held to.
    for (const bool first : {true, false})
        for (const Flag& flag : flags())
            if ((flag.name == "max-side") == first) apply(flag, given, options);
    check_combinations(options, given);
    return options;
}

}  // namespace nuvo::app
