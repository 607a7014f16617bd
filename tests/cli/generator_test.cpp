// How the generator is used: lists, files, misuse.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "cli/generator_runner.h"

namespace nuvo::generator_test {
namespace {

TEST(Generator, ListsTheScenesOfTheThesisAndTheShowcase) {
    const std::vector<std::string> names = scene_names();
    const std::set<std::string> expected{
        "trianglemesh", "both",     "concentric", "clumped",   "teapot",    "figure19",
        "figure20",     "figure22", "appendixE",  "figure25",  "appendixF", "figure27",
        "figure28",     "figure29", "appendixG",  "icosphere", "showcase"};
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), expected);
    EXPECT_EQ(names.size(), expected.size());
}

TEST(Generator, WritesEveryTestFileAgainByteForByte) {
    for (const std::string& name : scene_names()) {
        const Outcome outcome = generate(name);
        EXPECT_EQ(outcome.exit_code, 0) << name;
        EXPECT_TRUE(outcome.text == test_file(name)) << name << " differs from testfiles/";
    }
}

TEST(Generator, AllWritesTheSameFilesIntoAFolderItMakes) {
    const TemporaryFolder folder;
    const fs::path made = folder.path() / "made" / "here";
    ASSERT_EQ(generate("--all --out=" + made.string()).exit_code, 0);
    for (const std::string& name : scene_names()) {
        EXPECT_TRUE(read(made / (name + ".x3d")) == test_file(name)) << name;
    }
    const auto files = fs::directory_iterator(made);
    EXPECT_EQ(std::distance(begin(files), end(files)), 17);
}

TEST(Generator, NeedsNoFileAndNoParticularFolder) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "pot.x3d";
    const std::string command =
        "cd / && " + std::string(NUVO_GENERATOR) + " teapot --out=" + file.string();
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(read(file) == test_file("teapot"));
}

TEST(Generator, RefusesMisuseWithTwoAndOneLineThatSaysWhy) {
    const TemporaryFolder folder;
    const std::string out = " --out=" + (folder.path() / "never").string();
    const std::map<std::string, std::string> wrong{
        {"", "the name of one scene"},
        {"nosuch" + out, "no scene is called nosuch"},
        {"Both" + out, "no scene is called Both"},
        {"trianglemesh both" + out, "two scenes: trianglemesh and both"},
        {"--all", "--all needs --out"},
        {"--all trianglemesh" + out, "the name of one scene"},
        {"--list" + out, "--list takes no --out"},
        {"trianglemesh --out=", "--out= needs a name"},
        {"both --seed=" + out, "--seed=: not a whole number"},
        {"both --seed=-1" + out, "--seed=-1: not a whole number"},
        {"both --seed=1.5" + out, "--seed=1.5: not a whole number"},
        {"both --seed=18446744073709551616" + out, "not a whole number"},
        {"both --sed=1" + out, "unknown option --sed=1"},
        {"both --camera=middle" + out, "--camera=middle: neither far nor near"},
        {"both --count=2" + out, "both takes no --count"},
        {"appendixE --camera=far" + out, "appendixE takes no --camera"},
        {"spheres" + out, "spheres needs --count=N"},
        {"octahedra --count=1e6" + out, "--count=1e6: not a whole number"},
        {"--all --camera=far" + out, "--all takes no --camera"}};
    for (const auto& [arguments, message] : wrong) {
        const Outcome outcome = generate(arguments + " 2>&1 >/dev/null");
        EXPECT_EQ(outcome.exit_code, 2) << arguments;
        const std::string first_line = outcome.text.substr(0, outcome.text.find('\n'));
        EXPECT_EQ(occurrences(first_line, message), 1U) << arguments << ": " << first_line;
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Generator, SaysWhichFileItCannotWrite) {
    const TemporaryFolder folder;
    const std::string missing = (folder.path() / "no" / "such.x3d").string();
    const Outcome no_folder = generate("trianglemesh --out=" + missing + " 2>&1");
    EXPECT_EQ(no_folder.exit_code, 4);
    EXPECT_EQ(occurrences(no_folder.text, missing), 1U) << no_folder.text;
    if (fs::exists("/dev/full")) {
        EXPECT_EQ(generate("trianglemesh --out=/dev/full 2>/dev/null").exit_code, 4);
        EXPECT_EQ(generate("trianglemesh 2>/dev/null >/dev/full").exit_code, 4);
        EXPECT_EQ(generate("--all --out=/dev/full 2>/dev/null").exit_code, 4);
    }
}

TEST(Generator, ExplainsItselfOnRequest) {
    const Outcome outcome = generate("-h");
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* option : {"--list", "--all", "--seed=N", "--out=", "--camera=", "--count=N"}) {
        EXPECT_GE(occurrences(outcome.text, option), 1U) << option;
    }
}

}  // namespace
}  // namespace nuvo::generator_test
