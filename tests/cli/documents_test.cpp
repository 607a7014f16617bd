#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/program_runner.h"
#include "nuvo/image/image.h"
#include "png_decoder.h"

namespace nuvo::cli_test {
namespace {

fs::path in_source(const std::string& name) { return fs::path(NUVO_SOURCE_DIR) / name; }

// The documents' commands, run where they write their files.
class Documents : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        fs::create_directories(folder_ / "testfiles" / "x3d");
        for (const char* scene : {"testfiles/both.x3d", "testfiles/x3d/blender_scene_full.x3d"})
            fs::copy_file(in_source(scene), folder_ / scene);
    }

    /// The arguments of each line of the document that runs the program and holds `part`.
    static std::vector<std::vector<std::string>> commands(const std::string& document,
                                                          const std::string& part) {
        constexpr const char* kProgram = "    build/native/nuvo ";
        std::vector<std::vector<std::string>> found;
        std::istringstream lines(file_text(in_source(document)));
        for (std::string line; std::getline(lines, line);) {
            if (line.rfind(kProgram, 0) != 0 || line.find(part) == std::string::npos) continue;
            std::istringstream words(line.substr(std::string(kProgram).size()));
            found.emplace_back(std::istream_iterator<std::string>(words),
                               std::istream_iterator<std::string>());
        }
        return found;
    }
    /// The lines of a document's blocks of commands that begin with `start`, without comments.
    static std::vector<std::string> lines_of(const std::string& document,
                                             const std::string& start) {
        std::vector<std::string> found;
        std::istringstream lines(file_text(in_source(document)));
        for (std::string line; std::getline(lines, line);)
            if (line.rfind("    " + start, 0) == 0)
                found.push_back(line.substr(4, line.find(" # ") - 4));
        return found;
    }
    /// A project that is installed and built already, with one scene of the user's.
    void plant_built_project() const {
        fs::copy(in_source("scripts"), folder_ / "scripts", fs::copy_options::recursive);
        std::ofstream(folder_ / "scripts/setup.sh", std::ios::app)
            << "\nnuvo_install() { :; }\nnuvo_build() { :; }\n";
        for (const char* build : {"build/native", "build/release"}) {
            fs::create_directories(folder_ / build);
            fs::create_symlink(NUVO_PROGRAM, folder_ / build / "nuvo");
        }
        put("build/release/CMakeCache.txt", "CMAKE_CXX_COMPILER:FILEPATH=/bin/true\n");
        for (const auto& scene : fs::directory_iterator(in_source("testfiles")))
            if (const fs::path to = folder_ / "testfiles" / scene.path().filename();
                scene.is_regular_file() && !fs::exists(to))
                fs::create_symlink(scene.path(), to);
        fs::create_directory(folder_ / "scenes");
        fs::copy_file(in_source("testfiles/appendixE.x3d"), folder_ / "my.x3d");
        for (const char* name : {"scenes/one.x3d", "scenes/two.x3d"})
            fs::copy_file(in_source("testfiles/appendixE.x3d"), folder_ / name);
        put("rays.txt", "0 0 800 0 0 -1\n");
    }
    /// The exit code of a line of bash in the folder; what it said goes into `said`.
    int bash(const std::string& line, std::string* said = nullptr) const {
        put("line.sh", line + "\n");
        const std::string log = (base_ / "log").string();
        const int status = std::system(
            ("cd '" + folder_.string() + "' && bash line.sh >'" + log + "' 2>&1 </dev/null")
                .c_str());
        if (said != nullptr) *said = file_text(log);
        return WEXITSTATUS(status);
    }
    Image picture(const std::string& name) const { return image::decoded(content(name)); }
    static Image shown(const std::string& name) {
        return image::decoded(file_text(in_source("docs/images/" + name)));
    }
};

// 1908751 as "1,908,751".
std::string with_commas(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

TEST_F(Documents, ReadmesHeatMapsAreThoseOfTheCommandsBesideThem) {
    const auto both = commands("README.md", "--heatmap");
    ASSERT_EQ(both.size(), 2u);
    const std::string readme = file_text(in_source("README.md"));
    for (std::vector<std::string> arguments : both) {
        arguments.push_back("--json=figures.json");
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const auto figures = nlohmann::json::parse(content("figures.json"));
        const std::string map = figures["heatmap"]["file"];
        EXPECT_TRUE(picture(map) == shown(map)) << map;
        EXPECT_NE(readme.find("](docs/images/" + map + ")"), std::string::npos) << map;
        const std::string tests = with_commas(figures["counts"]["intersection_tests"]);
        EXPECT_NE(readme.find(": " + tests), std::string::npos) << tests;
    }
}

TEST_F(Documents, TheTutorialsCommandsDoWhatItSays) {
    const auto all = commands("docs/tutorial.md", "");
    EXPECT_EQ(all.size(), 10u);
    for (const std::vector<std::string>& arguments : all) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << arguments.back() << '\n' << outcome.err;
        EXPECT_NE(outcome.out, "");
    }
    EXPECT_TRUE(picture("scene.png") == picture("scene-exact.png"));
    EXPECT_TRUE(picture("scene.png") == shown("tutorial-scene.png"));
    for (const char* map : {"uniform-tests.png", "nonuniform-tests.png"})
        EXPECT_TRUE(picture(map) == shown(std::string("tutorial-") + map)) << map;
    for (const char* file : {"pixel.json", "octree.x3d", "compared.json", "compared-difference.png",
                             "uniform-tests.npy", "nonuniform-tests.npy"})
        EXPECT_TRUE(exists(file)) << file;
    EXPECT_FALSE(nlohmann::json::parse(content("pixel.json"))["hit"].is_null());
}

// All but the heat maps, which have a test above: as they stand, only smaller and once.
TEST_F(Documents, TheReadmesOtherCommandsRun) {
    plant_built_project();
    int ran = 0;
    for (std::string line : lines_of("README.md", "")) {
        if (line.find("--heatmap") != std::string::npos) continue;
        if (line.rfind("scripts/alltests.sh", 0) == 0) {
            line += " --rep=1 --res=48,27 --no-look";
        } else {
            line = std::regex_replace(line, std::regex(" --(res|rep)=[^ ]*"), "");
            line += line.find("--rays") != std::string::npos ? "" : " --res=48,27 --rep=1";
        }
        std::string said;
        EXPECT_EQ(bash(line, &said), 0) << line << '\n' << said;
        ++ran;
    }
    EXPECT_EQ(ran, 8);
    for (const char* file :
         {"testfiles/showcase.bmp", "my.bmp", "hits.txt", "results/results.json"})
        EXPECT_TRUE(exists(file)) << file;
}

TEST_F(Documents, ManyScenesAreRenderedByGnuParallelASlurmArrayAndSnakemake) {
    plant_built_project();
    const std::string page = "docs/many-scenes.md";
    const auto reports = [this](const std::string& how) {
        for (const char* file : {"results/one.png", "results/one.json", "results/two.json"})
            EXPECT_TRUE(exists(file)) << how << ": " << file;
        fs::remove_all(folder_ / "results");
    };
    std::string array;  // Slurm's: the block from its first line to its last
    for (const char* start : {"scenes=(", "scene=$", "name=$", "mkdir -p", "build/native/nuvo"})
        array += lines_of(page, start).back() + '\n';
    std::string said;
    for (const char* task : {"0", "1"})
        EXPECT_EQ(bash(std::string("SLURM_ARRAY_TASK_ID=") + task + '\n' + array, &said), 0)
            << said;
    reports("Slurm");
    if (bash("command -v parallel") == 0) {
        EXPECT_EQ(bash("mkdir -p results\n" + lines_of(page, "ls scenes").front(), &said), 0)
            << said;
        reports("GNU parallel");
    }
    if (bash("command -v snakemake") == 0) {
        EXPECT_EQ(bash(lines_of(page, "snakemake").front(), &said), 0) << said;
        EXPECT_NE(content("results/table.csv").find("scenes/two.x3d"), std::string::npos);
        reports("Snakemake");
    }
}

}  // namespace
}  // namespace nuvo::cli_test
