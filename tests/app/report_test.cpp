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
    pass.tree->node_bytes = 1'000'000;
    pass.tree->reference_bytes = 200'000;
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

TEST(Report, AShortTimeIsTakenByTheFineClock) {
    Report report = example();
    report.passes[0].process.user_seconds = 0;
    report.passes[0].build_seconds = {0.0005, 0.0007};
    report.passes[0].trace_seconds = {0.001, 0.002};
    const std::string text = report_text(Options(), report);
    EXPECT_TRUE(contains(text, "average    0.002100 s to build and trace once")) << text;
    EXPECT_TRUE(contains(text, "steps by 10 ms")) << text;
}

TEST(Report, BeginsWithWhatTheUserWaitedFor) {
    Report report = example();
    report.parse_wall_seconds = 0.5;
    report.write_wall_seconds = 0.25;
    report.passes[0].build_wall_seconds = {1, 2};
    report.passes[0].trace_wall_seconds = {4, 4};
    Options options;
    options.resolution = {1000, 500};
    options.samples = 2;  // 2 pictures of 2000 x 1000 rays in 8 s
    EXPECT_EQ(report_text(options, report)
                  .find("waited     11.8 s: read 0.5, build 3, trace 8, write 0.25 s "
                        "(2 times built and traced); 0.5 million primary rays a second\n"),
              0u)
        << report_text(options, report);
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

// A root of 4 x 4 x 8 with one child in the corner cut again: by hand.
TEST(Report, TheLeavesAreToldByDepthAndByItems) {
    const auto node = [](Bounds3 box, Label label) {
        Node result;
        result.voxel = Voxel::centered(box);
        result.label = label;
        return result;
    };
    const Bounds3 box{{0, 0, 0}, {4, 4, 8}};
    std::vector<Node> nodes{node(box, 0)};
    nodes[0].first_child = 1;
    for (int digit = 1; digit <= 8; ++digit)
        nodes.push_back(node(nodes[0].voxel.octant(digit), child_label(0, digit)));
    nodes[3].first_child = 9;
    for (int digit = 1; digit <= 8; ++digit)
        nodes.push_back(node(nodes[3].voxel.octant(digit), child_label(nodes[3].label, digit)));
    nodes[1].first_item = 0;
    nodes[1].item_count = 1;
    nodes[10].first_item = 1;
    nodes[10].item_count = 4;
    nodes[11].first_item = 5;
    nodes[11].item_count = 7;
    const Octree octree(std::move(nodes), std::vector<ItemId>(12, ItemId{0}));
    Report report = example();
    report.passes[0].tree = figures(octree);
    // Interior areas 160 and 40, leaf areas 7 x 40 and 8 x 10, and 40 + 10 x (4 + 7) with items.
    report.passes[0].tree->sah = final_sah(octree, {6, 2, 1});
    const auto tree = nlohmann::json::parse(report_json(Options(), report))["tree"];
    EXPECT_EQ(tree["leaf_depths"],
              (nlohmann::json{{{"depth", 0}, {"leaves", 0}, {"volume_share", 0}},
                              {{"depth", 1}, {"leaves", 7}, {"volume_share", 0.875}},
                              {{"depth", 2}, {"leaves", 8}, {"volume_share", 0.125}}}));
    EXPECT_EQ(tree["leaf_items"], (nlohmann::json{{{"from", 0}, {"to", 0}, {"leaves", 12}},
                                                  {{"from", 1}, {"to", 1}, {"leaves", 1}},
                                                  {{"from", 2}, {"to", 3}, {"leaves", 0}},
                                                  {{"from", 4}, {"to", 7}, {"leaves", 2}}}));
    EXPECT_DOUBLE_EQ(tree["sah"]["cost"], (6.0 * 200 + 2.0 * 360 + 150) / 160);
    EXPECT_EQ(tree["sah"]["leaf"], 2);
    EXPECT_EQ(tree["bytes"]["nodes"], 17 * sizeof(Node));
    EXPECT_EQ(tree["bytes"]["references"], 12 * sizeof(ItemId));
    EXPECT_EQ(17 * sizeof(Node) + 12 * sizeof(ItemId) + tree["bytes"]["names"].get<std::size_t>(),
              octree.memory_bytes());
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

TEST(Report, TheErrorIsToldInTextAndJson) {
    Report report = example();
    Options options;
    EXPECT_FALSE(contains(report_text(options, report), "exact profile"));
    EXPECT_FALSE(nlohmann::json::parse(report_json(options, report)).contains("error"));
    report.error = image::Difference{3, 1, 2, 0.5, 54.15, 17};
    EXPECT_TRUE(contains(report_text(options, report),
                         "error      from the exact profile's picture: 17 differing pixels, "
                         "maximum difference 3 at pixel 1,2, RMS 0.5, PSNR 54.15 dB\n"));
    const auto json = nlohmann::json::parse(report_json(options, report));
    EXPECT_EQ(json["error"]["differing_pixels"], 17);
    EXPECT_EQ(json["error"]["rms"], 0.5);
}

TEST(Report, ProfileAnswersAreTheFlagsThatGiveThem) {
    const std::vector<std::string> arguments{
        "--profile=thesis",   "--tracer=serial", "--type=nonuniform",  "--midpoint=sweep",
        "--costs=thesis",     "--leaves=shapes", "--walk=descent",     "--step=0.25",
        "--precision=double", "--bias=0.5",      "--back-faces=solid", "--defaults=thesis"};
    std::string expected;
    for (const std::string& argument : arguments)
        expected += (expected.empty() ? "" : " ") + argument;
    EXPECT_EQ(profile_flags_text(parse(arguments)), expected);
}

TEST(Report, TheAnswersOfTheTileTracerAreItsOwn) {
    EXPECT_EQ(profile_flags_text(parse({"--profile=fast", "--type=nonuniform"})),
              "--profile=fast --tracer=tiles --type=nonuniform --back-faces=solid");
}

Report tile_example() {
    Report report = example();
    Pass& pass = report.passes[0];
    pass.tree.reset();
    pass.counts.reset();
    pass.tiles =
        TileFigures{2, InstructionSet::kAvx2, 5, 70, 90, 110, {2'500'000, 300'000}, {}, {}, {}};
    pass.tiles->counts = RayCounts{100, 50};
    pass.tiles->stage_seconds = FastTimes{0.125, 0.25, 0.5, 0.75};
    pass.build_wall_seconds = {0.25, 0.25};
    pass.trace_wall_seconds = {0.5, 1.5};
    return report;
}

TEST(Report, PrintsWhatTheTileTracerTells) {
    const std::string text = report_text(parse({"--profile=fast"}), tile_example());
    for (const char* part :
         {"--profile=fast --tracer=tiles", "as measured on the scene (--type chooses)",
          "depth 5, 70 voxels with items, 90 nodes, 110 references, 2.5 MB",
          "2 threads, avx2, 0.3 MB of tables", "100 primary and 50 shadow rays\n",
          "tables 0.125000 s, primary rays 0.250000 s, shadow rays 0.500000 s, shading 0.750000 s",
          "wall       build 0.250000 s, trace 1.000000 s"})
        EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
    for (const char* part : {"intersection tests", "voxel searches", "none: uniform"})
        EXPECT_FALSE(contains(text, part)) << part << "\n" << text;
    EXPECT_FALSE(contains(report_text(parse({"--profile=fast", "--type=uniform"}), tile_example()),
                          "measured"));
}

TEST(Report, JsonOfTheTileTracerLeavesOutWhatHasNoMeaning) {
    const auto json = nlohmann::json::parse(report_json(parse({"--profile=fast"}), tile_example()));
    EXPECT_EQ(json["tiles"]["threads"], 2);
    EXPECT_EQ(json["tiles"]["isa"], "avx2");
    EXPECT_EQ(json["tiles"]["structure_bytes"], 2'500'000);
    EXPECT_EQ(json["tiles"]["table_bytes"], 300'000);
    EXPECT_EQ(json["counts"]["shadow_rays"], 50);
    EXPECT_FALSE(json["counts"].contains("voxel_searches"));
    EXPECT_FALSE(json.contains("tree"));
    EXPECT_EQ(json["stage_seconds"]["shading"], 0.75);
    EXPECT_EQ(json["trace_wall_seconds"], (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(json["profile"]["tracer"], "tiles");
    EXPECT_TRUE(json["profile"]["walk"].is_null());
}

TEST(Paths, ThePictureStandsBesideTheScene) {
    EXPECT_EQ(picture_beside("a/b.x3d"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/b.c.x3d"), "a/b.c.bmp");
    EXPECT_EQ(picture_beside("a/b"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/b.xml"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/b.x3dz"), "a/b.bmp");
    EXPECT_EQ(picture_beside("a/B.X3D"), "a/B.bmp");
    EXPECT_EQ(picture_beside("a/b.txt"), "a/b.txt.bmp");
    EXPECT_EQ(picture_beside("b.x3d"), "b.bmp");
}

TEST(Paths, TheDifferencePictureStandsBesideThePicture) {
    EXPECT_EQ(difference_beside("a/b.bmp"), "a/b-difference.bmp");
    EXPECT_EQ(difference_beside("a/b.png"), "a/b-difference.png");
    EXPECT_EQ(difference_beside("a/b"), "a/b-difference.bmp");
    EXPECT_EQ(difference_beside("/dev/full"), "/dev/full");
}

}  // namespace
}  // namespace nuvo::app
