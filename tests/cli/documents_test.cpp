#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
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
        constexpr const char* kProgram = "    build/release/nuvo ";
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

}  // namespace
}  // namespace nuvo::cli_test
