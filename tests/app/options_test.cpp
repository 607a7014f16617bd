#include "nuvo/app/options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "nuvo/app/choices.h"

namespace nuvo::app {
namespace {

std::string usage_error(const std::vector<std::string>& arguments) {
    try {
        parse(arguments);
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// False for "--isa=NAME" of an instruction set that this machine lacks.
bool supported(const std::string& argument) {
    for (const auto& choice : kInstructionSets) {
        if (argument != "--isa=" + std::string(choice.name)) continue;
        const auto sets = supported_instruction_sets();
        return std::find(sets.begin(), sets.end(), choice.value) != sets.end();
    }
    return true;
}

std::string text_of(const std::string& name) {
    std::ifstream file(std::string(NUVO_SOURCE_DIR) + "/" + name);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Thesis appendix C: ./main --file=testfiles/trianglemesh --rep=5 --type=uniform --res=1920,1080
TEST(Options, DefaultsAreTheThesis) {
    const Options options = parse({});
    EXPECT_EQ(options.file, "testfiles/trianglemesh");
    EXPECT_EQ(options.repetitions, 5);
    EXPECT_EQ(options.profile.type, OctreeType::kUniform);
    EXPECT_EQ(options.resolution, (Resolution{1920, 1080}));
    EXPECT_EQ(options.profile_name, "exact");
    EXPECT_FALSE(options.compare || options.show_octree || options.help || options.quiet);
    EXPECT_FALSE(options.out || options.rays || options.json);
}

// Of every flag that takes a value: a flag behind it is none.
TEST(Options, AForgottenValueIsAUsageError) {
    for (const Flag& flag : flags()) {
        if (flag.value.empty() || flag.may_stand_alone()) continue;
        for (const std::string& given : {"--" + flag.name, "-" + flag.name})
            for (const std::string next :
                 {"--quiet", "--nosuch", "--rep=1", "-compare", "-quiet", "-h", "--", "-res=2,2"}) {
                const std::string message = usage_error({given, next});
                EXPECT_TRUE(contains(message, given + ": needs a value, and " + next)) << message;
            }
        EXPECT_FALSE(usage_error({"--" + flag.name}).empty());
    }
    EXPECT_EQ(parse({"--out", "-"}).out, "-");
    EXPECT_EQ(parse({"--from", "-1,2,3"}).from, (Point3{-1, 2, 3}));
    EXPECT_EQ(parse({"--planes", "-x"}).planes, "-x");
    EXPECT_EQ(parse({"--planes=--quiet"}).planes, "--quiet");
}

TEST(Options, ThesisFlagsAreReadInAnyOrder) {
    std::vector<std::string> arguments{"--file=a b",        "--rep=15",    "--res=840,350",
                                       "--type=nonuniform", "-showoctree", "--midpoint=sweep"};
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int i = 0; i < 50; ++i) {
        std::shuffle(arguments.begin(), arguments.end(), random);
        const Options options = parse(arguments);
        EXPECT_EQ(options.file, "a b");
        EXPECT_EQ(options.repetitions, 15);
        EXPECT_EQ(options.resolution, (Resolution{840, 350}));
        EXPECT_EQ(options.profile.type, OctreeType::kNonuniform);
        EXPECT_EQ(options.profile.midpoint, MidpointChoice::kSweep);
        EXPECT_TRUE(options.show_octree);
    }
}

TEST(Options, OneDashOrTwoAndABlankForTheEqualSignWork) {
    const Options options =
        parse({"-file=a", "--compare", "--showoctree", "--rep", "3", "-res", "4,5"});
    EXPECT_EQ(options.file, "a");
    EXPECT_EQ(options.repetitions, 3);
    EXPECT_EQ(options.resolution, (Resolution{4, 5}));
    EXPECT_TRUE(options.compare && options.show_octree);
}

TEST(Options, HelpWinsHoweverItIsSpelled) {
    for (const char* help : {"-h", "--help", "-help"}) {
        EXPECT_TRUE(parse({help}).help) << help;
        EXPECT_TRUE(parse({"--file=a", "--rep=5", "-compare", help}).help) << help;
    }
    EXPECT_TRUE(parse({"--version"}).version);
}

TEST(Options, AProfileIsChangedByItsSingleAnswersWhateverTheOrder) {
    for (const auto& arguments :
         {std::vector<std::string>{"--bias=exact", "--step=0.5", "--type=nonuniform",
                                   "--profile=thesis", "--walk=descent"},
          std::vector<std::string>{"--profile=thesis", "--walk=descent", "--type=nonuniform",
                                   "--step=0.5", "--bias=exact"}}) {
        const Options options = parse(arguments);
        EXPECT_EQ(options.profile_name, "thesis");
        EXPECT_FALSE(options.profile.bias.has_value());
        EXPECT_EQ(options.profile.step, 0.5);
        EXPECT_EQ(options.profile.walk, WalkChoice::kDescent);
        EXPECT_EQ(options.profile.type, OctreeType::kNonuniform);
        // Not given, so as the thesis has them:
        EXPECT_EQ(options.profile.costs, CostChoice::kThesis);
        EXPECT_EQ(options.profile.leaves, LeafContent::kShapes);
        EXPECT_EQ(options.profile.precision, Precision::kFloat);
    }
}

TEST(Options, EveryAnswerOfAProfileHasAFlag) {
    const Options options =
        parse({"--costs=thesis", "--leaves=shapes", "--precision=double", "--bias=0.04"});
    EXPECT_EQ(options.profile.costs, CostChoice::kThesis);
    EXPECT_EQ(options.profile.leaves, LeafContent::kShapes);
    EXPECT_EQ(options.profile.precision, Precision::kDouble);
    EXPECT_EQ(options.profile.bias, 0.04);
    EXPECT_EQ(parse({"--max-objects=3"}).profile.max_objects, std::size_t{3});
    EXPECT_EQ(parse({"--bias=0"}).profile.bias, 0.0);
}

TEST(Options, TheTypeIsTakenInAnyLetterCase) {
    EXPECT_EQ(parse({"--type=NonUniform"}).profile.type, OctreeType::kNonuniform);
    EXPECT_EQ(parse({"--type=UNIFORM", "--profile=thesis"}).profile.type, OctreeType::kUniform);
}

TEST(Options, TheThesisProfileBringsItsDefaultsUnlessOthersAreAskedFor) {
    EXPECT_EQ(parse({}).defaults, &x3d::standard_defaults);
    EXPECT_EQ(parse({"--profile=fast"}).defaults, &x3d::standard_defaults);
    EXPECT_EQ(parse({"--profile=thesis"}).defaults, &x3d::thesis_defaults);
    EXPECT_EQ(parse({"--defaults=x3d", "--profile=thesis"}).defaults, &x3d::standard_defaults);
    EXPECT_EQ(parse({"--profile=thesis", "--defaults=thesis"}).defaults, &x3d::thesis_defaults);
    EXPECT_EQ(parse({"--defaults=thesis"}).defaults, &x3d::thesis_defaults);
}

TEST(Options, CompareMayAskForBruteForce) {
    EXPECT_TRUE(parse({"-compare"}).compare);
    EXPECT_FALSE(parse({"-compare"}).compare_brute_force);
    EXPECT_TRUE(parse({"--compare=brute"}).compare_brute_force);
    EXPECT_TRUE(parse({"--error"}).error);
    for (const char* other : {"-compare", "--rays=r", "--describe"})
        EXPECT_TRUE(contains(usage_error({"--error", other}), "--error")) << other;
}

TEST(Options, EveryListedWordIsTaken) {
    for (const Flag& flag : flags()) {
        if (!contains(flag.value, "|") || contains(flag.value, "exact|") ||
            contains(flag.value, "["))
            continue;  // those with a number among the words have tests of their own
        for (std::size_t at = 0; at < flag.value.size();) {
            const std::size_t end = std::min(flag.value.find('|', at), flag.value.size());
            std::vector<std::string> arguments{"--" + flag.name + "=" +
                                               flag.value.substr(at, end - at)};
            if (flag.name == "midpoint") arguments.push_back("--type=nonuniform");
            if (flag.name == "answers") arguments.push_back("--rays=r");
            if (flag.name == "isa") arguments.push_back("--profile=fast");
            if (!supported(arguments[0])) {
                EXPECT_TRUE(contains(usage_error(arguments), "this machine has"));
            } else {
                EXPECT_EQ(usage_error(arguments), "");
            }
            at = end + 1;
        }
    }
}

TEST(Options, TheFastProfileIsTheTileTracerOnTheOctreeThatWasMeasuredFaster) {
    const Options options = parse({"--profile=fast"});
    EXPECT_EQ(options.profile.tracer, TracerChoice::kTiles);
    EXPECT_EQ(options.profile.type, fast_profile().type);
    EXPECT_FALSE(options.type_given);
    EXPECT_EQ(options.threads, 1);
    EXPECT_EQ(options.isa, InstructionSet::kBest);
    for (const auto& type : kOctreeTypes) {
        const Options chosen = parse({"--profile=fast", "--type=" + std::string(type.name)});
        EXPECT_EQ(chosen.profile.type, type.value);
        EXPECT_TRUE(chosen.type_given);
    }
    EXPECT_EQ(parse({"--tracer=tiles"}).profile.tracer, TracerChoice::kTiles);
    EXPECT_EQ(parse({"--tracer=tiles"}).profile.type, OctreeType::kUniform);
    EXPECT_EQ(parse({"--tracer=serial", "--profile=fast"}).profile.tracer, TracerChoice::kSerial);
    EXPECT_EQ(parse({}).profile.tracer, TracerChoice::kSerial);
}

TEST(Options, ThreadsAndInstructionSetsAreTheTileTracers) {
    EXPECT_EQ(parse({"--profile=fast", "--threads=7"}).threads, 7);
    EXPECT_EQ(parse({"--tracer=tiles", "--threads=0"}).threads, 0);
    EXPECT_EQ(parse({"--profile=fast", "--threads=1024"}).threads, 1024);
    EXPECT_TRUE(contains(usage_error({"--profile=fast", "--threads=1025"}), "1024"));
    for (const char* own : {"--threads=2", "--threads=0", "--isa=sse2"})
        for (const char* profile : {"--profile=thesis", "--tracer=serial", "--walk=hash"}) {
            EXPECT_TRUE(contains(usage_error({own, profile}), own));
            EXPECT_TRUE(contains(usage_error({own, profile}), "--profile=fast"));
        }
    for (const InstructionSet isa : supported_instruction_sets())
        EXPECT_EQ(
            parse({"--profile=fast", "--isa=" + std::string(name_of(kInstructionSets, isa))}).isa,
            isa);
}

TEST(Options, WhatTheTileTracerDecidesItselfIsRefusedBesideIt) {
    for (const char* cause : {"--profile=fast", "--tracer=tiles"})
        for (const char* fixed :
             {"--midpoint=sweep", "--costs=calibrated", "--max-objects=3", "--leaves=primitives",
              "--walk=hash", "--step=exact", "--precision=exact", "--bias=0", "-showoctree"}) {
            const std::string error = usage_error({cause, "--type=nonuniform", fixed});
            EXPECT_TRUE(contains(error, fixed)) << cause << " " << fixed << ": " << error;
            EXPECT_TRUE(contains(error, cause)) << cause << " " << fixed << ": " << error;
            EXPECT_EQ(
                usage_error({"--profile=fast", "--tracer=serial", "--type=nonuniform", fixed}), "");
        }
    const std::string error = usage_error({"--profile=thesis", "--tracer=tiles"});
    EXPECT_TRUE(contains(error, "--profile=thesis") && contains(error, "--tracer=tiles")) << error;
}

TEST(Options, LimitsHoldAtTheLimitAndOneBesideIt) {
    EXPECT_EQ(parse({"--res=16384,1"}).resolution, (Resolution{16384, 1}));
    EXPECT_EQ(parse({"--rep=1000000"}).repetitions, 1000000);
    EXPECT_TRUE(contains(usage_error({"--res=16385,1"}), "16384"));
    EXPECT_TRUE(contains(usage_error({"--res=1,16385"}), "16384"));
    EXPECT_TRUE(contains(usage_error({"--res=0,1"}), "16384"));
    EXPECT_TRUE(contains(usage_error({"--rep=1000001"}), "1000000"));
    EXPECT_TRUE(contains(usage_error({"--rep=0"}), "1000000"));
}

TEST(Options, BadValuesAreNamedWithTheirFlag) {
    for (const char* bad :
         {"--res=0,0",        "--res=99999999,1", "--res=4",        "--res=4,",
          "--res=,4",         "--res=4,5,6",      "--res=4x5x6",    "--res=-4,5",
          "--res=4 5",        "--res=4x",         "--samples=0",    "--samples=65",
          "--samples=2x2",    "--from=1,2",       "--from=1,2,z",   "--at=1,2,3,4",
          "--at=1,2,nan",     "--fov=0",          "--fov=180",      "--fov=wide",
          "--res= 4,5",       "--res=4.0,5",      "--rep=0",        "--rep=-1",
          "--rep=five",       "--rep=1e3",        "--rep=5 ",       "--rep=99999999999999999999",
          "--type=octree",    "--profile=quick",  "--costs=cheap",  "--costs=thesis:12",
          "--defaults=vrml",  "-compare=1",       "-compare=Brute", "--costs=calibrated:3",
          "--step=0",         "--step=-1",        "--step=nan",     "--step=inf",
          "--bias=-0.1",      "--bias=nan",       "--bias=0.1m",    "--max-objects=0",
          "--max-objects=-1", "--leaves=trees",   "--walk=run",     "--precision=half",
          "--tracer=ray",     "--threads=-1",     "--threads=two",  "--isa=mmx",
          "--headlight=dim",  "--midpoint=middle"}) {
        const std::string error = usage_error({bad});
        EXPECT_TRUE(contains(error, bad)) << bad << " gave: " << error;
        EXPECT_FALSE(contains(error, "\n"));
    }
}

TEST(Options, MissingAndSuperfluousValuesAreRefused) {
    for (const char* bad : {"--file", "--file=", "--rep=", "--quiet=yes", "-compare=1"})
        EXPECT_NE(usage_error({bad}), "") << bad;
}

TEST(Options, AMistypedFlagIsAnsweredWithTheNearest) {
    const std::pair<std::string, std::string> cases[] = {{"--fiel=a", "--file"},
                                                         {"--typ=uniform", "--type"},
                                                         {"-compere", "-compare"},
                                                         {"-showoctre", "-showoctree"},
                                                         {"--headlght=on", "--headlight"},
                                                         {"--max-object=3", "--max-objects"},
                                                         {"--hepl", "-h"}};
    for (const auto& [typed, meant] : cases)
        EXPECT_EQ(usage_error({typed}), typed + ": unknown flag, did you mean " + meant + "?");
}

TEST(Options, AnUnknownFlagFarFromAllIsNotGuessedAt) {
    const std::string error = usage_error({"--xyzzyplugh"});
    EXPECT_TRUE(contains(error, "--xyzzyplugh: unknown flag"));
    EXPECT_FALSE(contains(error, "did you mean"));
}

// Boost's message about a value that is missing would go round without end.
TEST(Options, AnUnknownFlagMayHoldAPlaceholderOfMessages) {
    for (const std::string flag : {"--t%canonical_option%=", "-%canonical_option%=", "--%option%="})
        EXPECT_TRUE(contains(usage_error({flag}), flag + ": unknown flag")) << flag;
}

TEST(Options, AbbreviationsAreNotGuessed) {
    EXPECT_TRUE(contains(usage_error({"--prof=exact"}), "did you mean --profile?"));
    EXPECT_NE(usage_error({"--comp"}), "");
}

TEST(Options, AFlagGivenTwiceIsRefused) {
    EXPECT_TRUE(contains(usage_error({"--rep=1", "--rep=1"}), "--rep"));
    EXPECT_TRUE(contains(usage_error({"-compare", "--compare"}), "compare"));
    EXPECT_TRUE(contains(usage_error({"--quiet", "--file=a", "--quiet"}), "--quiet"));
}

TEST(Options, AWordWithoutAFlagIsTheScene) {
    EXPECT_EQ(parse({"scene.x3d"}).file, "scene.x3d");
    EXPECT_EQ(parse({"--rep=2", "a b", "-compare"}).file, "a b");
    EXPECT_EQ(parse({"-compare", "scene.x3d"}).file, "scene.x3d");  // not -compare=scene.x3d
    EXPECT_EQ(parse({"--study", "scene.x3d"}).file, "scene.x3d");
    for (const auto& two : {std::vector<std::string>{"a.x3d", "b.x3d"},
                            std::vector<std::string>{"--file=a.x3d", "b.x3d"},
                            std::vector<std::string>{"b.x3d", "--file=a.x3d"}}) {
        EXPECT_TRUE(contains(usage_error(two), "a second scene")) << usage_error(two);
        EXPECT_TRUE(contains(usage_error(two), "a.x3d")) << usage_error(two);
        EXPECT_TRUE(contains(usage_error(two), "b.x3d")) << usage_error(two);
    }
    EXPECT_TRUE(contains(usage_error({"rep=5"}), "did you mean --rep=5?"));
    EXPECT_EQ(parse({"x=y.x3d"}).file, "x=y.x3d");
}

TEST(Options, ADashIsStandardInputOrOutput) {
    EXPECT_EQ(parse({"-"}).file, "-");
    EXPECT_EQ(parse({"-"}).out, "-");  // there is no place beside it
    EXPECT_TRUE(parse({"-"}).standard_output_taken());
    EXPECT_EQ(parse({"-", "--out=a.png"}).out, "a.png");
    EXPECT_FALSE(parse({"-", "--out=a.png"}).standard_output_taken());
    EXPECT_FALSE(parse({"-", "--describe"}).out);
    EXPECT_EQ(parse({"a", "--out=-"}).out, "-");
    EXPECT_TRUE(parse({"a", "--json=-"}).standard_output_taken());
    EXPECT_TRUE(contains(usage_error({"-", "--rays=-"}), "--rays=-"));
    EXPECT_TRUE(contains(usage_error({"a", "--out=-", "--json=-"}), "--json=-"));
    EXPECT_TRUE(contains(usage_error({"a", "--rays=r", "--json=-"}), "--json=-"));
    EXPECT_TRUE(contains(usage_error({"a", "-compare", "--out=-"}), "-compare"));
    EXPECT_TRUE(contains(usage_error({"a", "-showoctree", "--out=-"}), "-showoctree"));
    EXPECT_TRUE(contains(usage_error({"a", "--heatmap=tests", "--out=-"}), "--heatmap"));
    EXPECT_TRUE(contains(usage_error({"-", "--heatmap=tests"}), "--heatmap"));
    EXPECT_EQ(parse({"-", "--heatmap=tests", "--out=p.png"}).out, "p.png");
}

TEST(Options, ResolutionsAreWrittenWithACommaOrAnX) {
    for (const char* typed : {"--res=640,480", "--res=640x480", "--res=640X480"})
        EXPECT_EQ(parse({typed}).resolution, (Resolution{640, 480})) << typed;
}

TEST(Options, ThreadsBringTheTilesWhereNothingSpeaksForTheSerialTracer) {
    EXPECT_EQ(parse({"--threads=2"}).profile.tracer, TracerChoice::kTiles);
    EXPECT_EQ(parse({"--threads=0", "-compare"}).profile.tracer, TracerChoice::kTiles);
    for (const char* profile : {"--profile=exact", "--profile=thesis", "--tracer=serial"})
        EXPECT_EQ(parse({"--threads=1", profile}).profile.tracer, TracerChoice::kSerial);
    EXPECT_EQ(usage_error({"--threads=1", "--walk=descent"}), "");
    EXPECT_TRUE(contains(usage_error({"--threads=2", "-showoctree"}), "--threads=2"));
}

TEST(Options, SamplesAreHeldToTheLargestSide) {
    EXPECT_EQ(parse({}).samples, 1);
    const Options options = parse({"--samples=3", "--res=40,30"});
    EXPECT_EQ(options.samples, 3);
    EXPECT_EQ(options.traced_resolution(), (Resolution{120, 90}));
    EXPECT_EQ(usage_error({"--samples=4", "--res=4096,1"}), "");
    const std::string error = usage_error({"--samples=4", "--res=1,4097"});
    EXPECT_TRUE(contains(error, "--samples=4") && contains(error, "16384")) << error;
    for (const char* other :
         {"--rays=r", "--study", "--describe", "--heatmap=tests", "--planes=p", "--pixel=0,0"})
        EXPECT_TRUE(contains(usage_error({"--samples=2", "--res=9,9", other}), "--samples"))
            << other;
}

TEST(Options, TheCameraIsTakenInNumbers) {
    const Options options = parse({"--from=1,-2.5,3e2", "--at=0, 0, -1", "--fov=40"});
    EXPECT_EQ(options.from, (Point3{1, -2.5, 300}));
    EXPECT_EQ(options.at, (Point3{0, 0, -1}));
    EXPECT_EQ(options.fov_degrees, 40.0);
}

TEST(Options, FlagsThatContradictEachOtherAreRefused) {
    EXPECT_TRUE(contains(usage_error({"--midpoint=sweep"}), "--midpoint=sweep"));
    EXPECT_TRUE(contains(usage_error({"--midpoint=sweep", "--type=uniform"}), "uniform"));
    EXPECT_EQ(usage_error({"--midpoint=sweep", "-compare"}), "");
    EXPECT_NE(usage_error({"--type=uniform", "-compare"}), "");
    EXPECT_NE(usage_error({"--rays=r", "-compare"}), "");
    EXPECT_NE(usage_error({"--rays=r", "-showoctree"}), "");
    EXPECT_NE(usage_error({"--max-objects=3", "--costs=thesis"}), "");
    EXPECT_EQ(usage_error({"--study", "--midpoint=sweep", "--type=uniform"}), "");
    for (const char* chosen : {"--bias=0", "--tracer=tiles", "--threads=2", "--isa=sse2"})
        EXPECT_TRUE(contains(usage_error({"--study", chosen}), "--study")) << chosen;
}

TEST(Options, AStudyMayHaveAFile) {
    EXPECT_FALSE(parse({}).study);
    EXPECT_TRUE(parse({"--study", "--res=4,5"}).study);
    EXPECT_FALSE(parse({"--study", "--res=4,5"}).study_json.has_value());
    EXPECT_EQ(parse({"-study=s.json", "--res=4,5"}).study_json, "s.json");
}

TEST(Flags, NamesAreUniqueAndEveryRowIsComplete) {
    std::set<std::string> names;
    for (const Flag& flag : flags()) {
        EXPECT_TRUE(names.insert(flag.name).second) << flag.name;
        EXPECT_TRUE(contains(flag.spelling, flag.name)) << flag.name;
        EXPECT_FALSE(flag.help.empty()) << flag.name;
        EXPECT_NE(flag.apply, nullptr) << flag.name;
    }
}

TEST(Flags, StandardValuesInTheTableAreTheDefaultsOfTheParser) {
    const Options untouched = parse({});
    for (const Flag& flag : flags()) {
        if (flag.standard.empty() || flag.standard == "by profile") continue;
        std::vector<std::string> arguments{"--" + flag.name + "=" + flag.standard};
        if (flag.name == "midpoint") arguments.push_back("-compare");
        if (flag.name == "threads") arguments.push_back("--tracer=tiles");
        const Options given = parse(arguments);
        EXPECT_EQ(given.file, untouched.file) << flag.name;
        EXPECT_EQ(given.repetitions, untouched.repetitions) << flag.name;
        EXPECT_EQ(given.resolution, untouched.resolution) << flag.name;
        EXPECT_EQ(given.profile.type, untouched.profile.type) << flag.name;
        EXPECT_EQ(given.profile.midpoint, untouched.profile.midpoint) << flag.name;
        EXPECT_EQ(given.profile.precision, untouched.profile.precision) << flag.name;
        EXPECT_EQ(given.headlight, untouched.headlight) << flag.name;
        EXPECT_EQ(given.threads, untouched.threads) << flag.name;
    }
}

TEST(Flags, HelpListsEveryRowWithinEightyColumns) {
    const std::string help = help_text();
    for (const Flag& flag : flags()) EXPECT_TRUE(contains(help, "\n  " + flag.spelling));
    std::size_t column = 0;
    for (const char c : help) {
        column = c == '\n' ? 0 : column + 1;
        EXPECT_LE(column, 80u);
    }
}

TEST(Flags, TheDocumentationHoldsTheTable) {
    EXPECT_TRUE(contains(text_of("docs/command-line.md"), help_markdown()))
        << "docs/command-line.md must hold this table:\n"
        << help_markdown();
    const std::string readme = text_of("README.md");
    if (contains(readme, "| flag |")) {
        EXPECT_TRUE(contains(readme, help_markdown())) << "README.md must hold this table:\n"
                                                       << help_markdown();
    }
}

}  // namespace
}  // namespace nuvo::app
