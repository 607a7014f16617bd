#include "nuvo/app/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "nuvo/app/commands.h"
#include "nuvo/app/options.h"

namespace nuvo::app {
namespace {

Report example() {
    Report report;
    report.file = "s\xff.x3d";  // not UTF-8
    report.picture = "s.bmp";
    report.scene = {4, 3, 24, 0, 2, 1};
    Pass pass;
    pass.name = "uniform";
    pass.tree = TreeFigures{2, 8, 9, 30, 1'500'000, std::numeric_limits<double>::infinity()};
    pass.counts = TraceCounts{100, 50, 1053, 1303};
    pass.build_seconds = {0.25, 0.75};
    pass.trace_seconds = {1, 3};
    pass.process = {5, 0.5, 6};
    report.passes = {pass};
    return report;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Report, PrintsWhatTheThesisPrints) {
    const std::string text = report_text(Options(), example());
    EXPECT_TRUE(contains(text, "depth 2, 8 voxels")) << text;
    EXPECT_TRUE(contains(text, "1053 intersection tests (10.53 a primary ray)")) << text;
    EXPECT_TRUE(contains(text, "0.500000 s (mean of 2, 0.250000 to 0.750000)")) << text;
    EXPECT_TRUE(contains(text, "2.500000 s to build and trace once")) << text;  // 5 s of 2
    EXPECT_TRUE(contains(text, "4 shapes, 24 triangles, 0 spheres, 2 lights")) << text;
    EXPECT_TRUE(contains(text, "picture    s.bmp")) << text;
    EXPECT_FALSE(contains(text, "steps by")) << text;
}

TEST(Report, SaysThatAShortTimeIsCoarse) {
    Report report = example();
    report.passes[0].process.user_seconds = 0.99;
    EXPECT_TRUE(contains(report_text(Options(), report), "steps by 10 ms"));
}

TEST(Report, JsonIsCleanAndHasTheRawTimes) {
    const auto json = nlohmann::json::parse(report_json(Options(), example()));
    EXPECT_EQ(json["build_seconds"], (std::vector<double>{0.25, 0.75}));
    EXPECT_EQ(json["trace_seconds"], (std::vector<double>{1, 3}));
    EXPECT_EQ(json["repetitions"], 2);
    EXPECT_EQ(json["user_seconds"], 5);
    EXPECT_EQ(json["tree"]["voxels"], 8);
    EXPECT_TRUE(json["tree"]["smallest_width"].is_null());  // infinity has no place in JSON
    EXPECT_EQ(json["counts"]["voxel_searches"], 1303);
    EXPECT_EQ(json["scene"]["triangles"], 24);
    EXPECT_EQ(json["profile"]["type"], "uniform");
    EXPECT_EQ(json["resolution"]["width"], 1920);
}

TEST(Report, PsnrOfEqualPicturesIsNullInJsonAndInfInText) {
    Report report = example();
    report.passes.push_back(report.passes[0]);
    image::Difference equal;
    equal.psnr_db = std::numeric_limits<double>::infinity();
    report.pairs = {{"uniform", "nonuniform", equal}};
    Options options;
    options.compare = true;
    EXPECT_TRUE(contains(report_text(options, report), "0 differing pixels"));
    const auto json = nlohmann::json::parse(report_json(options, report));
    EXPECT_TRUE(json["pairs"][0]["psnr_db"].is_null());
    EXPECT_EQ(json["pairs"][0]["differing_pixels"], 0);
    EXPECT_EQ(json["passes"].size(), 2u);
}

TEST(Report, ProfileAnswersAreTheFlagsThatGiveThem) {
    const std::vector<std::string> arguments{
        "--profile=thesis",  "--type=nonuniform",  "--midpoint=sweep",
        "--costs=thesis:12", "--leaves=shapes",    "--walk=descent",
        "--step=0.25",       "--precision=double", "--bias=0.5"};
    std::string expected;
    for (const std::string& argument : arguments)
        expected += (expected.empty() ? "" : " ") + argument;
    EXPECT_EQ(profile_flags_text(parse(arguments)), expected);
}

TEST(Paths, ThePictureStandsBesideTheScene) {
    EXPECT_EQ(picture_beside("a/b.x3d"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/b.c.x3d"), "a/b.c.bmp");
    EXPECT_EQ(picture_beside("a/b"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/b.xml"), "a/b.xml.bmp");
    EXPECT_EQ(picture_beside("b.x3d"), "b.bmp");
}

TEST(Paths, TheDifferencePictureStandsBesideThePicture) {
    EXPECT_EQ(difference_beside("a/b.bmp"), "a/b-difference.bmp");
    EXPECT_EQ(difference_beside("/dev/full"), "/dev/full");
}

}  // namespace
}  // namespace nuvo::app
