// The thesis profile against the published figures [thesis 5.6, 5.8]: trees, counts and pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

constexpr Resolution kPublishedSize{1920, 1080};

Scene published_scene(const std::string& name) {
    x3d::ReadOptions options;
    options.defaults = x3d::thesis_defaults();
    return x3d::read_file(std::filesystem::path(NUVO_SOURCE_DIR) / "testfiles" / (name + ".x3d"),
                          options);
}

struct TypeFigures {
    double leaves;
    int depth;
    double tests;
    double searches;
};

struct PublishedTest {
    const char* scene;
    TypeFigures uniform;
    TypeFigures nonuniform;
    double shadow_rays;
    double
        shadow_slack;  // where float decides whether a ray hits, the program's own rounding counts
};

// Thesis 5.8.2 to 5.8.5; the shadow rays are those of the program.
constexpr PublishedTest kTests[]{
    {"trianglemesh", {8653, 9, 21843910, 27018572}, {5552, 6, 21789021, 26713679}, 334824, 0},
    {"both", {9381, 9, 17183358, 46117742}, {7064, 8, 11235896, 45362845}, 406862, 0},
    {"concentric", {9178, 8, 33225320, 25603151}, {8422, 8, 24876977, 25089438}, 312862, 90},
    {"clumped", {22807, 9, 5954439, 23818331}, {15401, 9, 6190599, 21231578}, 174298, 7}};

double percent(double from, double to) { return 100 * (to - from) / from; }

class Published : public testing::TestWithParam<PublishedTest> {};

// What is counted for one type.
TypeFigures measured(const Scene& scene, OctreeType type, std::uint64_t& shadow_rays) {
    Profile profile = thesis_profile();
    profile.type = type;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const TraceCounts counts = count_events(scene, primitives, octree, profile, kPublishedSize);
    shadow_rays = counts.shadow_rays;
    return {static_cast<double>(octree.leaf_count()), octree.depth_tried().value_or(-1),
            static_cast<double>(counts.intersection_tests),
            static_cast<double>(counts.voxel_searches)};
}

TEST_P(Published, TreesAndCountsComeOut) {
    const PublishedTest& published = GetParam();
    const Scene scene = published_scene(published.scene);
    std::uint64_t shadow_rays = 0;
    const TypeFigures uniform = measured(scene, OctreeType::kUniform, shadow_rays);
    EXPECT_NEAR(static_cast<double>(shadow_rays), published.shadow_rays, published.shadow_slack);
    const TypeFigures nonuniform = measured(scene, OctreeType::kNonuniform, shadow_rays);

    EXPECT_EQ(uniform.leaves, published.uniform.leaves);
    // The search is NLopt's, whose versions differ.
    EXPECT_LE(std::abs(percent(published.nonuniform.leaves, nonuniform.leaves)), 0.5);
    const auto near = [](const TypeFigures& ours, const TypeFigures& theirs) {
        EXPECT_EQ(ours.depth, theirs.depth);
        EXPECT_LE(std::abs(percent(theirs.tests, ours.tests)), 1.7) << ours.tests;
        EXPECT_LE(std::abs(percent(theirs.searches, ours.searches)), 1.7) << ours.searches;
    };
    near(uniform, published.uniform);
    near(nonuniform, published.nonuniform);
    const double tests_change = percent(uniform.tests, nonuniform.tests);
    EXPECT_NEAR(tests_change, percent(published.uniform.tests, published.nonuniform.tests), 1.2);
    EXPECT_NEAR(percent(uniform.searches, nonuniform.searches),
                percent(published.uniform.searches, published.nonuniform.searches), 1.2);
    // The one scene whose tests rise. [5.8.5]
    if (published.scene == std::string("clumped")) {
        EXPECT_NEAR(tests_change, 4, 0.1);
    }
}

INSTANTIATE_TEST_SUITE_P(Tests, Published, testing::ValuesIn(kTests),
                         [](const auto& test) { return std::string(test.param.scene); });

struct Probe {
    int x;
    int y;
    int color[3];
};

// Pixels of figures 24 to 30, by scene.
std::map<std::string, std::vector<Probe>> read_probes() {
    std::ifstream file(std::filesystem::path(NUVO_SOURCE_DIR) / "tests/data/thesis-figures.tsv");
    std::map<std::string, std::vector<Probe>> probes;
    std::string line;
    std::getline(file, line);  // the heading
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        std::string scene;
        Probe p{};
        fields >> scene >> p.x >> p.y >> p.color[0] >> p.color[1] >> p.color[2];
        EXPECT_TRUE(fields) << line;
        probes[scene].push_back(p);
    }
    return probes;
}

TEST(PublishedFigures, ComeOutWithinOneOf255) {
    const auto probes = read_probes();
    ASSERT_EQ(probes.size(), 7U);
    for (const auto& [name, points] : probes) {
        const Scene scene = published_scene(name);
        const Profile profile = thesis_profile();
        const Primitives primitives = flatten(scene, profile.leaves);
        const Image picture = render(scene, primitives, build_tree(scene, primitives, profile),
                                     profile, kPublishedSize);
        for (const Probe& p : points) {
            const Rgb8 pixel = picture.at(p.x, p.y);
            EXPECT_LE(std::abs(pixel.r - p.color[0]), 1) << name << " " << p.x << "," << p.y;
            EXPECT_LE(std::abs(pixel.g - p.color[1]), 1) << name << " " << p.x << "," << p.y;
            EXPECT_LE(std::abs(pixel.b - p.color[2]), 1) << name << " " << p.x << "," << p.y;
        }
    }
}

}  // namespace
}  // namespace nuvo
