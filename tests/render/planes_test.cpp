#include "nuvo/render/planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "property/test_scenes.h"

namespace nuvo {
namespace {

constexpr Resolution kSmall{37, 29};

// Each walk, each arithmetic, each kind of leaf.
std::vector<Profile> all_profiles() {
    std::vector<Profile> profiles;
    for (const OctreeType type : {OctreeType::kUniform, OctreeType::kNonuniform})
        for (const Precision precision : {Precision::kExact, Precision::kDouble, Precision::kFloat})
            for (const WalkChoice walk : {WalkChoice::kHash, WalkChoice::kDescent})
                for (const bool nudged : {false, true}) {
                    Profile profile = exact_profile();
                    profile.type = type;
                    profile.precision = precision;
                    profile.walk = walk;
                    if (nudged) profile.step = 0.01;
                    profiles.push_back(profile);
                }
    profiles.push_back(exact_profile());
    profiles.back().max_objects = 1'000'000;  // of large leaves, what rays have found is kept
    profiles.push_back(thesis_profile());
    return profiles;
}

std::uint64_t sum(const std::vector<std::uint32_t>& plane) {
    return std::accumulate(plane.begin(), plane.end(), std::uint64_t{0});
}

void expect_same(const TraceCounts& a, const TraceCounts& b) {
    EXPECT_EQ(a.primary_rays, b.primary_rays);
    EXPECT_EQ(a.shadow_rays, b.shadow_rays);
    EXPECT_EQ(a.intersection_tests, b.intersection_tests);
    EXPECT_EQ(a.voxel_searches, b.voxel_searches);
    ASSERT_EQ(a.predicates.has_value(), b.predicates.has_value());
    if (!a.predicates) return;
    EXPECT_EQ(a.predicates->tests, b.predicates->tests);
    EXPECT_EQ(a.predicates->wider, b.predicates->wider);
    EXPECT_EQ(a.predicates->exact, b.predicates->exact);
}

TEST(Planes, SumsAreTheCountersOfAnotherRun) {
    for (const Scene& scene : {testing::grid_scene(), testing::random_scene(7, 60)}) {
        for (const Profile& profile : all_profiles()) {
            const Primitives primitives = flatten(scene, profile.leaves);
            const Octree octree = build_tree(scene, primitives, profile);
            const PixelPlanes planes = record_planes(scene, primitives, &octree, profile, kSmall);
            ASSERT_EQ(planes.tests.size(), 37u * 29u);
            expect_same(planes.counts, count_events(scene, primitives, octree, profile, kSmall));
            EXPECT_EQ(sum(planes.tests), planes.counts.intersection_tests);
            EXPECT_EQ(sum(planes.searches), planes.counts.voxel_searches);
            EXPECT_GT(sum(planes.tests), 0u);
        }
    }
}

TEST(Planes, ShowWhatTheRaysOfTheirPixelsMeet) {
    const Scene scene = testing::random_scene(11, 60);
    const Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    std::vector<Ray> rays;
    const RayGenerator generator(scene.camera, kSmall);
    for (int y = 0; y < kSmall.height; ++y)
        for (int x = 0; x < kSmall.width; ++x) rays.push_back(generator.ray(x, y));
    const std::vector<RayAnswer> answers = closest_hits(scene, primitives, nullptr, profile, rays);
    for (const Octree* tree : {&octree, static_cast<const Octree*>(nullptr)}) {
        const PixelPlanes planes = record_planes(scene, primitives, tree, profile, kSmall);
        int hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            hits += answers[i].hit ? 1 : 0;
            EXPECT_EQ(planes.t[i], answers[i].t);
            EXPECT_EQ(planes.shape[i], answers[i].shape);
            EXPECT_EQ(planes.triangle[i], answers[i].triangle);
        }
        EXPECT_GT(hits, 100);
    }
}

TEST(Planes, BruteForceTestsAllItemsAgainstEachRay) {
    const Scene scene = testing::random_scene(3, 40);
    for (const Precision precision : {Precision::kExact, Precision::kDouble, Precision::kFloat}) {
        Profile profile = exact_profile();
        profile.precision = precision;
        const Primitives primitives = flatten(scene, profile.leaves);
        const PixelPlanes planes = record_planes(scene, primitives, nullptr, profile, kSmall);
        EXPECT_EQ(sum(planes.searches), 0u);
        for (const std::uint32_t tests : planes.tests) {
            EXPECT_EQ(tests % primitives.item_count(), 0u);
            EXPECT_GE(tests, primitives.item_count());
        }
        EXPECT_EQ(sum(planes.tests), primitives.item_count() *
                                         (planes.counts.primary_rays + planes.counts.shadow_rays));
    }
}

// Seen from the front by parallel rays at x, y = +-0.25, +-0.75: the lower left half of a square,
// its diagonal through four of them included.
Scene half_square() {
    Scene scene;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    scene.objects.push_back({mesh});
    scene.objects[0].shape_index = 4;
    scene.materials = {Material{}};
    Light sun;
    sun.direction = {0, 0, -1};
    scene.lights = {sun};
    scene.camera.position = {0, 0, 5};
    scene.camera.window = OrthoWindow{{-1, -1}, {1, 1}};
    return scene;
}

TEST(Planes, OneTriangleInOneVoxelCostsWhatCountingByHandSays) {
    const Scene scene = half_square();
    const Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    Node root;
    root.voxel = Voxel::centered({{-1, -1, -1}, {1, 1, 1}});
    root.item_count = 1;
    const Octree octree({root}, {0});
    const PixelPlanes planes = record_planes(scene, primitives, &octree, profile, {4, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const std::size_t i = static_cast<std::size_t>(y * 4 + x);
            const bool hit = x <= y;
            // A hit: its own test, and that of the shadow ray. A miss: its own.
            EXPECT_EQ(planes.tests[i], hit ? 2u : 1u) << x << ' ' << y;
            // The primary ray that misses, and each shadow ray, asks for a voxel after the only
            // one.
            EXPECT_EQ(planes.searches[i], 1u) << x << ' ' << y;
            EXPECT_EQ(planes.t[i], hit ? 5 : std::numeric_limits<double>::infinity());
            EXPECT_EQ(planes.shape[i], hit ? 4 : -1);
            EXPECT_EQ(planes.triangle[i], hit ? 0 : -1);
            // The cheap test leaves a ray through the diagonal open.
            EXPECT_EQ(planes.stage[i] == Stage::kCheap, x != y) << x << ' ' << y;
        }
}

TEST(Planes, PlainArithmeticHasOneStage) {
    const Scene scene = half_square();
    Profile profile = exact_profile();
    profile.precision = Precision::kDouble;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    for (const Stage stage : record_planes(scene, primitives, &octree, profile, {4, 4}).stage)
        EXPECT_EQ(stage, Stage::kCheap);
}

}  // namespace
}  // namespace nuvo
