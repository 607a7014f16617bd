#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program_runner.h"

// The tables of scripts/bench_peers.sh, from small results whose figures are known.

namespace nuvo::cli_test {
namespace {

class PeersReport : public ProgramTest {
  protected:
    int shell(const std::string& command) const {
        const std::string out = (base_ / "out").string();
        const int status = std::system(
            ("cd '" + folder_.string() + "' && " + command + " >'" + out + "' 2>&1").c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string said() const { return file_text(base_ / "out"); }

    int report(const std::string& arguments) const {
        return shell("python3 '" NUVO_SOURCE_DIR "/scripts/report/peers.py' " + arguments);
    }
};

nlohmann::json figure(double a, double b, double c) {
    return {{"median", b}, {"low", a}, {"high", c}, {"least", a}, {"samples", {a, b, c}}};
}

/// Embree always twice as slow in a frame, three times with the build, and 50 bytes a triangle.
nlohmann::json result() {
    const nlohmann::json zero = figure(0, 0, 0);
    nlohmann::json ours{{"type", "uniform"},
                        {"build", figure(0.001, 0.002, 0.003)},
                        {"scratch", figure(0.011, 0.012, 0.013)},
                        {"frame", figure(0.010, 0.011, 0.012)},
                        {"tables", zero},
                        {"primary", figure(0.004, 0.005, 0.006)},
                        {"shadow", figure(0.003, 0.003, 0.003)},
                        {"shading", figure(0.002, 0.002, 0.002)},
                        {"structure_bytes", 40000},
                        {"table_bytes", 8000}};
    nlohmann::json embree{{"convert", zero},
                          {"build", figure(0.004, 0.005, 0.006)},
                          {"scratch", figure(0.033, 0.036, 0.039)},
                          {"primary", figure(0.008, 0.009, 0.010)},
                          {"trace", figure(0.015, 0.016, 0.017)},
                          {"frame", figure(0.020, 0.022, 0.024)},
                          {"structure_bytes", 50000},
                          {"peak_bytes", 70000}};
    nlohmann::json survey{{"primary_width", 16},
                          {"primary_coherent", true},
                          {"shadow_width", 1},
                          {"shadow_coherent", false},
                          {"user_spheres", true}};
    survey["version"] = "4.4.0";
    survey["least_seconds"] = {{"primary: 16 rays, coherent", 0.0085},
                               {"build, quality low", 0.003},
                               {"build, quality high", 0.03}};
    return {{"triangles", 1000},
            {"spheres", 0},
            {"embree_survey", survey},
            {"ours", nlohmann::json::array({ours})},
            {"embree", embree},
            {"differing_pixels", 12},
            {"visibly_differing_pixels", 3},
            {"pixels_unlike_exact", 0}};
}

TEST_F(PeersReport, SaysHowManyTimesAsFastAndPutsItIntoTheDocument) {
    fs::create_directories(folder_ / "results/raw");
    put("results/raw/frame-trianglemesh-far.json", result().dump());
    put("doc.md", "before\n<!-- table frames -->\nold\n<!-- end -->\nafter\n");
    ASSERT_EQ(report("results --type=uniform --docs doc.md"), 0) << said();
    const std::string doc = content("doc.md");
    EXPECT_EQ(doc.find("before\n<!-- table frames -->\n| scene |"), 0U) << doc;
    EXPECT_NE(doc.find("\n<!-- end -->\nafter\n"), std::string::npos) << doc;
    EXPECT_EQ(doc.find("old"), std::string::npos);
    const std::string row =
        "| test 1, 5,824 triangles | far | 16 coherent / 1 | 22.0 (20.0 .. 24.0) | "
        "11.0 (10.0 .. 12.0) | **2.00** (2.00 .. 2.00) | **3.00** (3.00 .. 3.00) | 12 / 3 | 0 |";
    EXPECT_NE(doc.find(row), std::string::npos) << doc;
    // 50,000 and 40,000 bytes for 1,000 triangles, 8,000 of tables; no other octree was measured.
    EXPECT_NE(said().find("| 50.0 | 40.0 | - | 8.0 |"), std::string::npos) << said();
    // Embree's stages are differences: 9, 16 - 9 and 22 - 16. Ours are shares of 11 as 5 : 3 : 2.
    EXPECT_NE(said().find("| far | 9.0 | 7.0 | 6.0 | 0.0 | 5.5 | 3.3 | 2.2 |"), std::string::npos)
        << said();
    EXPECT_NE(said().find("\n- embree: 4.4.0\n"), std::string::npos) << said();
    const auto merged = nlohmann::json::parse(content("results/peers.json"));
    EXPECT_EQ(merged["results"]["frame-trianglemesh-far"], result());
}

TEST_F(PeersReport, TellsWhatTheFirstPictureTakesAfterTheBuild) {
    fs::create_directories(folder_ / "results/raw");
    nlohmann::json people = result();
    people["ours"][0]["type"] = "measured";
    put("results/raw/people-terrain.json", people.dump());
    ASSERT_EQ(report("results"), 0) << said();
    // Frame 2, with the build 3; first pictures 29 to 33 ms against 10.
    EXPECT_NE(said().find("| **2.00** (2.00 .. 2.00) | **3.00** (3.00 .. 3.00) | **3.10** (2.90 .. "
                          "3.30) | - | - | 8 | 0 |"),
              std::string::npos)
        << said();
}

TEST_F(PeersReport, ToleratesWhatWasNotMeasured) {
    fs::create_directories(folder_ / "results/raw");
    nlohmann::json only_survey = result();
    only_survey.erase("ours");
    only_survey.erase("embree");
    put("results/raw/frame-both-near.json", only_survey.dump());
    ASSERT_EQ(report("results"), 0) << said();
    EXPECT_NE(said().find("## frames\n\nNot measured."), std::string::npos) << said();
    EXPECT_NE(said().find("| test 2, 8,000 triangles | near | 8.5 |"), std::string::npos) << said();
    fs::remove(folder_ / "results/raw/frame-both-near.json");
    EXPECT_EQ(report("results"), 1);
    EXPECT_NE(said().find("no results"), std::string::npos) << said();
}

TEST_F(PeersReport, TimesCommandsInTurn) {
    const std::string tool = "python3 '" NUVO_SOURCE_DIR "/scripts/report/time_commands.py' ";
    ASSERT_EQ(shell(tool + "--rounds=3 --json=t.json --command none true --command nap sleep 0.1"),
              0)
        << said();
    const auto samples = nlohmann::json::parse(content("t.json"));
    ASSERT_EQ(samples["nap"]["wall"].size(), 3U);
    ASSERT_EQ(samples["none"]["cpu"].size(), 3U);
    for (const double wall : samples["nap"]["wall"]) EXPECT_GE(wall, 0.1);
    for (const double cpu : samples["nap"]["cpu"]) EXPECT_LT(cpu, 0.1);
    EXPECT_NE(shell(tool + "--json=u.json --command bad false"), 0);
    EXPECT_FALSE(exists("u.json"));
}

TEST_F(PeersReport, TheScriptRefusesWhatItDoesNotKnow) {
    const std::string script = "bash '" NUVO_SOURCE_DIR "/scripts/bench_peers.sh' ";
    EXPECT_EQ(shell(script + "--fast"), 2);
    EXPECT_NE(said().find("unknown flag --fast"), std::string::npos) << said();
    EXPECT_EQ(shell(script + "--rounds=0"), 2);
    EXPECT_EQ(shell(script + "--help"), 0);
    for (const char* part : {"--scenes", "--large", "--growth", "--isa", "--povray", "--kernels"})
        EXPECT_NE(said().find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace nuvo::cli_test
