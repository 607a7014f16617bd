#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

using nlohmann::json;

class Look : public ProgramTest {
  protected:
    static std::string testfile(const std::string& name) {
        return std::string(NUVO_SOURCE_DIR) + "/testfiles/" + name + ".x3d";
    }
    json read_json(const std::string& name) const { return json::parse(content(name)); }

    /// The numbers of an array file, which must hold those of this type for each pixel.
    template <typename T>
    std::vector<T> plane(const std::string& name, const std::string& type, int width,
                         int height) const {
        const std::string bytes = content(name);
        EXPECT_NE(bytes.find("'descr': '" + type + "', 'fortran_order': False, 'shape': (" +
                             std::to_string(height) + ", " + std::to_string(width) + ")"),
                  std::string::npos)
            << name;
        std::vector<T> values(static_cast<std::size_t>(width * height));
        const std::size_t size = values.size() * sizeof(T);
        EXPECT_GT(bytes.size(), size) << name;
        if (bytes.size() > size)
            std::memcpy(values.data(), bytes.data() + bytes.size() - size, size);
        return values;
    }
};

std::uint64_t sum(const std::vector<std::uint32_t>& values) {
    return std::accumulate(values.begin(), values.end(), std::uint64_t{0});
}

TEST_F(Look, PlanesAddUpToTheCountersAndTheVoxelsAreThoseOfTheReport) {
    const std::vector<std::vector<std::string>> cases = {
        {"--profile=exact"},    {"--profile=exact", "--type=nonuniform", "--walk=descent"},
        {"--profile=thesis"},   {"--profile=thesis", "--type=nonuniform"},
        {"--precision=double"}, {"--precision=float", "--step=0.01"},
        {"--profile=fast"},     {"--profile=fast", "--type=nonuniform"},
        {"--tracer=tiles"}};
    for (const std::vector<std::string>& answers : cases) {
        std::vector<std::string> arguments = {"--file=" + testfile("both"),
                                              "--res=97,61",
                                              "--rep=1",
                                              "--out=a.png",
                                              "--heatmap=tests",
                                              "--planes=a",
                                              "--json=a.json",
                                              "--octree=o.x3d"};
        arguments.insert(arguments.end(), answers.begin(), answers.end());
        SCOPED_TRACE(answers[0]);
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(files(), (std::set<std::string>{"a.png", "a-tests.png", "a.json", "o.x3d",
                                                  "a-tests.npy", "a-searches.npy", "a-t.npy",
                                                  "a-shape.npy", "a-triangle.npy", "a-stage.npy"}));
        const json report = read_json("a.json");
        EXPECT_EQ(sum(plane<std::uint32_t>("a-tests.npy", "<u4", 97, 61)),
                  report["counts"]["intersection_tests"]);
        EXPECT_EQ(sum(plane<std::uint32_t>("a-searches.npy", "<u4", 97, 61)),
                  report["counts"]["voxel_searches"]);
        const std::string octree = content("o.x3d");
        std::size_t lines = 0;
        for (std::size_t i = 0; (i = octree.find(" -1\n", i)) != std::string::npos; ++i) ++lines;
        EXPECT_EQ(lines, report["tree"]["voxels"]);
        const auto shapes = plane<std::int32_t>("a-shape.npy", "<i4", 97, 61);
        const auto triangles = plane<std::int32_t>("a-triangle.npy", "<i4", 97, 61);
        const auto t = plane<double>("a-t.npy", "<f8", 97, 61);
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            EXPECT_EQ(shapes[i] < 0, triangles[i] < 0);
            EXPECT_EQ(shapes[i] < 0, std::isinf(t[i]));
        }
        plane<std::uint8_t>("a-stage.npy", "|u1", 97, 61);
        // The counters of the same command without looking.
        arguments.erase(arguments.begin() + 4, arguments.begin() + 6);
        ASSERT_EQ(run(arguments).exit_code, 0);
        for (const char* count : {"primary_rays", "shadow_rays"})
            EXPECT_EQ(read_json("a.json")["counts"][count], report["counts"][count]);
        if (report.contains("tiles")) continue;  // of which alone no tests are counted
        EXPECT_EQ(read_json("a.json")["counts"], report["counts"]);
    }
}

TEST_F(Look, ComparedPassesHaveTheirOwnPlanesThatAddUpAndOneScale) {
    put("a.x3d", grid_scene(3));
    for (const char* profile : {"--profile=exact", "--profile=fast", "--precision=float"}) {
        SCOPED_TRACE(profile);
        const Outcome outcome =
            run({"--file=a", "-compare=brute", "--res=40,30", profile, "--heatmap=tests",
                 "--planes=p", "--octree=o.json", "--json=r.json"});
        ASSERT_LE(outcome.exit_code, 1) << outcome.err;
        const json report = read_json("r.json");
        double largest = 0;
        for (const json& pass : report["passes"])
            largest = std::max(largest, pass["heatmap"]["largest"].get<double>());
        for (const json& pass : report["passes"]) {
            EXPECT_EQ(pass["heatmap"]["scale_max"], largest);
            EXPECT_TRUE(exists(pass["heatmap"]["file"]));
            std::string prefix = pass["planes"][0];
            prefix.resize(prefix.size() - std::string("tests.npy").size());
            EXPECT_EQ(sum(plane<std::uint32_t>(prefix + "tests.npy", "<u4", 40, 30)),
                      pass["counts"]["intersection_tests"])
                << prefix;
            EXPECT_EQ(sum(plane<std::uint32_t>(prefix + "searches.npy", "<u4", 40, 30)),
                      pass["counts"]["voxel_searches"])
                << prefix;
            if (pass["name"] == "brute force") {
                EXPECT_EQ(pass["counts"]["intersection_tests"],
                          27 * (pass["counts"]["primary_rays"].get<std::uint64_t>() +
                                pass["counts"]["shadow_rays"].get<std::uint64_t>()));
                continue;
            }
            const json octree = read_json(pass["octree_file"]);
            EXPECT_EQ(octree["leaves"].size(), pass["tree"]["voxels"]);
        }
        EXPECT_TRUE(exists("p-brute-force-stage.npy"));
    }
}

TEST_F(Look, LookingLeavesThePictureAlone) {
    put("a.x3d", kSmallScene);
    for (const char* profile : {"--profile=exact", "--profile=fast", "--profile=thesis"}) {
        ASSERT_EQ(run({"--file=a", "--res=40,30", "--rep=1", profile, "--out=plain.bmp"}).exit_code,
                  0);
        ASSERT_EQ(run({"--file=a", "--res=40,30", "--rep=1", profile, "--out=seen.bmp",
                       "--heatmap=searches", "--planes=p", "--octree=o.json"})
                      .exit_code,
                  0);
        EXPECT_TRUE(content("plain.bmp") == content("seen.bmp")) << profile;
    }
}

TEST_F(Look, AnOctreeFileIsASceneThatCanBeRead) {
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"--file=a", "--res=8,8", "--rep=1", "--octree=o.x3d"}).exit_code, 0);
    const Outcome again = run({"--file=o", "--res=8,8", "--rep=1"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.err.find("IndexedLineSet"), std::string::npos);
}

// The bytes of a pixel of a BMP of that size.
std::vector<int> bmp_pixel(const std::string& bmp, int width, int height, int x, int y) {
    const std::size_t row = static_cast<std::size_t>((3 * width + 3) / 4 * 4);
    const std::size_t at =
        54 + static_cast<std::size_t>(height - 1 - y) * row + 3 * static_cast<std::size_t>(x);
    const auto byte = [&](std::size_t i) { return int{static_cast<unsigned char>(bmp[at + i])}; };
    return {byte(2), byte(1), byte(0)};
}

TEST_F(Look, AnExplainedPixelHasThePicturesBytes) {
    std::mt19937 random(20);
    for (const char* scene : {"showcase", "x3d/blender_scene_full", "both"})
        for (const char* profile : {"--profile=exact", "--profile=fast", "--profile=thesis"}) {
            ASSERT_EQ(
                run({"--file=" + testfile(scene), profile, "--res=64,48", "--rep=1", "--out=a.bmp"})
                    .exit_code,
                0);
            const std::string bmp = content("a.bmp");
            for (int i = 0; i < 5; ++i) {
                const int x = static_cast<int>(random() % 64);
                const int y = static_cast<int>(random() % 48);
                const std::string pixel = std::to_string(x) + "," + std::to_string(y);
                const Outcome outcome = run({"--file=" + testfile(scene), profile, "--res=64,48",
                                             "--pixel=" + pixel, "--json=p.json"});
                ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
                const std::vector<int> bytes = bmp_pixel(bmp, 64, 48, x, y);
                const json told = read_json("p.json");
                EXPECT_EQ(told["bytes"], bytes) << scene << ' ' << profile << ' ' << pixel;
                EXPECT_NE(outcome.out.find("bytes      " + std::to_string(bytes[0]) + " " +
                                           std::to_string(bytes[1]) + " " +
                                           std::to_string(bytes[2]) + "\n"),
                          std::string::npos)
                    << outcome.out;
                for (const json& voxel : told["ray"]["voxels"]) {
                    EXPECT_LE(voxel["t_in"], voxel["t_out"]);
                    EXPECT_LE(voxel["tests"].size(), profile == std::string("--profile=thesis")
                                                         ? std::size_t{10000}
                                                         : voxel["items"].get<std::size_t>());
                }
            }
        }
}

TEST_F(Look, APixelDrawsNothing) {
    put("a.x3d", kSmallScene);
    const Outcome outcome = run({"--file=a", "--res=9,9", "--pixel=4,4"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(files(), std::set<std::string>{"a.x3d"});
    for (const char* part : {"pixel      4,4 of 9 x 9", "hit        sphere, shape 0 at t = 9",
                             "voxel ", "light 0, directional: lit", "shadow ray from"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
    EXPECT_EQ(run({"--file=a", "--res=9,9", "--pixel=4,4", "--quiet"}).out, "");
}

TEST_F(Look, WhatCannotBeShownIsRefused) {
    put("a.x3d", kSmallScene);
    const auto refused = [&](std::vector<std::string> arguments, const char* part) {
        arguments.insert(arguments.begin(), "--file=a");
        expect_refused(arguments, 2, {part});
    };
    refused({"--heatmap=time"}, "tests|searches|stage");
    refused({"--heatmap"}, "heatmap");
    refused({"--heatmap=stage", "--precision=double"}, "one stage only");
    refused({"--heatmap=stage", "--profile=thesis"}, "one stage only");
    refused({"--heatmap=stage", "--heatmap-max=2"}, "one scale");
    refused({"--heatmap-max=5"}, "add --heatmap=tests");
    refused({"--heatmap=tests", "--heatmap-max=0"}, "a number > 0");
    refused({"--heatmap=tests", "--heatmap-max=nan"}, "a number > 0");
    refused({"--octree=o.obj"}, ".x3d, .json or .bin");
    refused({"--planes="}, "--planes");
    refused({"--res=8,6", "--pixel=8,0"}, "within the picture");
    refused({"--res=8,6", "--pixel=0,6"}, "within the picture");
    refused({"--res=8,6", "--pixel=-1,0"}, "within the picture");
    refused({"--res=8,6", "--pixel=3"}, "within the picture");
    refused({"--pixel=1,1", "--heatmap=tests"}, "cannot be combined");
    refused({"--pixel=1,1", "-compare"}, "cannot be combined");
    refused({"--heatmap=tests", "--describe"}, "cannot be combined");
    refused({"--octree=a.x3d"}, "would be overwritten");
    refused({"--octree=o.json", "--json=o.json"}, "written twice");
    expect_refused({"--file=a", "--res=8,8", "--planes=missing/p"}, 4, {"missing"});
}

}  // namespace
}  // namespace nuvo::cli_test
