#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

Scene scene_of(const std::string& name) {
    return x3d::read_file(NUVO_SOURCE_DIR "/tests/render/budget/" + name + ".x3d");
}

Profile exact(OctreeType type) {
    Profile profile = exact_profile();
    profile.type = type;
    profile.walk = WalkChoice::kDescent;
    return profile;
}

struct PerRay {
    double tests;
    double searches;
};

PerRay counted(const Scene& scene, OctreeType type) {
    const Profile profile = exact(type);
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const TraceCounts counts = count_events(scene, primitives, octree, profile, {64, 48});
    const auto rays = static_cast<double>(counts.primary_rays + counts.shadow_rays);
    return {static_cast<double>(counts.intersection_tests) / rays,
            static_cast<double>(counts.voxel_searches) / rays};
}

constexpr OctreeType kTypes[] = {OctreeType::kUniform, OctreeType::kNonuniform};

// Depth first the budget was spent in the first octants: 1,685 to 8,837 tests a ray.
TEST(OctreeBudget, CrowdedScenesTakeFewTestsARay) {
    for (const char* name : {"long-cylinders", "molecule", "rough-terrain"})
        for (const OctreeType type : kTypes)
            EXPECT_LT(counted(scene_of(name), type).tests, 200) << name;
}

TEST(OctreeBudget, CrowdedScenesAreThePicturesOfBruteForce) {
    const Resolution size{8, 6};
    for (const char* name : {"long-cylinders", "molecule", "rough-terrain", "stadium"}) {
        const Scene scene = scene_of(name);
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const Image brute = render_brute_force(scene, primitives, exact_profile(), size);
        for (const OctreeType type : kTypes) {
            const Profile profile = exact(type);
            const Octree octree = build_tree(scene, primitives, profile);
            EXPECT_EQ(render(scene, primitives, octree, profile, size), brute) << name;
        }
    }
}

// 4,096 triangles in one place, which no cut parts, cost no references.
TEST(OctreeBudget, CoincidentTrianglesAreNotCopied) {
    const Scene scene = scene_of("coincident");
    for (const OctreeType type : kTypes) {
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const Octree octree = build_tree(scene, primitives, exact(type));
        EXPECT_LE(octree.reference_count(), 2 * primitives.item_count());
        EXPECT_FALSE(octree.out_of_budget());
    }
}

// The ground's width is the only 1000000 of the file.
TEST(OctreeBudget, AWideGroundCostsLittle) {
    std::ifstream in(NUVO_SOURCE_DIR "/tests/render/budget/stadium.x3d");
    const std::string wide((std::istreambuf_iterator<char>(in)), {});
    const auto on_ground = [&](const std::string& width) {
        std::string text = wide;
        for (std::size_t at = 0; (at = text.find("1000000", at)) != std::string::npos;
             at += width.size())
            text.replace(at, 7, width);
        return x3d::read_text(text, "stadium.x3d");
    };
    for (const OctreeType type : kTypes) {
        const PerRay narrow = counted(on_ground("10"), type);
        for (const char* width : {"100", "10000", "1000000"}) {
            const PerRay here = counted(on_ground(width), type);
            EXPECT_LT(here.tests, 4 * narrow.tests) << width;
            EXPECT_LT(here.searches, 4 * narrow.searches) << width;
        }
    }
}

double tests_per_ray_of_whole_shapes(OctreeType type, CostChoice costs) {
    const Scene scene = x3d::read_file(NUVO_SOURCE_DIR "/testfiles/trianglemesh.x3d");
    Profile profile = exact_profile();
    profile.type = type;
    profile.costs = costs;
    profile.leaves = LeafContent::kShapes;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const TraceCounts counts = count_events(scene, primitives, octree, profile, {192, 108});
    return static_cast<double>(counts.intersection_tests) /
           static_cast<double>(counts.primary_rays);
}

// The planes of test 1's grid are there to be found.
TEST(Sweep, PartsTheGridOfTest1) {
    EXPECT_GT(tests_per_ray_of_whole_shapes(OctreeType::kUniform, CostChoice::kThesis), 8);
    EXPECT_LT(tests_per_ray_of_whole_shapes(OctreeType::kNonuniform, CostChoice::kThesis), 1.1);
}

// An octahedron costs eight tests: 91 of them were tested a ray where it was priced as one.
TEST(CalibratedCosts, PriceAWholeShapeByItsPrimitives) {
    EXPECT_LT(tests_per_ray_of_whole_shapes(OctreeType::kUniform, CostChoice::kCalibrated), 20);
    EXPECT_LT(tests_per_ray_of_whole_shapes(OctreeType::kNonuniform, CostChoice::kCalibrated), 8);
}

// Planes on faces list an object on both sides (14.4 tests a ray); planes a few ulp beside them
// make voxels so thin that the published step no longer moves, and objects are lost.
TEST(Sweep, KeepsClearOfFacesUnderThePublishedWalk) {
    const Scene scene = x3d::read_file(NUVO_SOURCE_DIR "/testfiles/trianglemesh.x3d");
    Profile profile = thesis_profile();
    profile.type = OctreeType::kNonuniform;
    profile.midpoint = MidpointChoice::kSweep;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const TraceCounts nudged = count_events(scene, primitives, octree, profile, {96, 54});
    profile.step.reset();
    const Octree wide = build_tree(scene, primitives, profile);
    const TraceCounts exact = count_events(scene, primitives, wide, profile, {96, 54});
    EXPECT_EQ(nudged.shadow_rays, exact.shadow_rays);  // they meet the same objects
    EXPECT_LT(nudged.intersection_tests, 5 * exact.intersection_tests / 4);
}

}  // namespace
}  // namespace nuvo
