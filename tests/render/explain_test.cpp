#include "nuvo/render/explain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "nuvo/scene/x3d.h"
#include "property/test_scenes.h"

namespace nuvo {
namespace {

constexpr Resolution kSmall{41, 31};

void add_tests(const RayStory& ray, std::uint64_t& tests, std::uint64_t& searches) {
    tests += ray.intersection_tests();
    searches += ray.searches;
    for (const VoxelStory& voxel : ray.voxels) EXPECT_LE(voxel.t_in, voxel.t_out);
}

std::vector<Profile> some_profiles() {
    Profile nonuniform = exact_profile();
    nonuniform.type = OctreeType::kNonuniform;
    Profile descent = exact_profile();
    descent.walk = WalkChoice::kDescent;
    Profile plain = exact_profile();
    plain.precision = Precision::kDouble;
    Profile nudged = plain;
    nudged.step = 0.5;
    nudged.bias = 0.001;
    Profile one_leaf = exact_profile();  // of many items, what rays have found is kept
    one_leaf.max_objects = 1'000'000;
    return {exact_profile(), nonuniform, descent, plain, nudged, one_leaf, thesis_profile()};
}

// The pixel's color, its costs and its sums are those of the picture and its planes.
void expect_pixels_explained(const Scene& scene, unsigned seed, int pixels) {
    std::mt19937_64 random(seed);
    for (const Profile& profile : some_profiles()) {
        const Primitives primitives = flatten(scene, profile.leaves);
        const Octree octree = build_tree(scene, primitives, profile);
        const Image picture = render(scene, primitives, octree, profile, kSmall);
        const PixelPlanes planes = record_planes(scene, primitives, &octree, profile, kSmall);
        for (int i = 0; i < pixels; ++i) {
            const int x = static_cast<int>(random() % static_cast<unsigned>(kSmall.width));
            const int y = static_cast<int>(random() % static_cast<unsigned>(kSmall.height));
            SCOPED_TRACE(std::to_string(seed) + ": " + std::to_string(x) + "," + std::to_string(y));
            const PixelStory story =
                explain_pixel(scene, primitives, octree, profile, kSmall, x, y);
            EXPECT_EQ(story.bytes, picture.at(x, y));
            std::uint64_t tests = 0;
            std::uint64_t searches = 0;
            add_tests(story.primary, tests, searches);
            const auto index = static_cast<std::size_t>(y * kSmall.width + x);
            if (story.surface) {
                Color total = story.surface->material.emissive_color;
                for (const LightStory& light : story.surface->lights) {
                    if (light.shadow) add_tests(*light.shadow, tests, searches);
                    if (light.end == LightStory::End::kLit) total += light.adds;
                }
                EXPECT_EQ(total, story.color);
                EXPECT_EQ(story.surface->t, planes.t[index]);
                EXPECT_EQ(story.surface->shape, planes.shape[index]);
                EXPECT_EQ(story.surface->triangle, planes.triangle[index]);
            } else {
                EXPECT_EQ(planes.shape[index], -1);
                EXPECT_EQ(story.color, scene.background.color(story.primary.ray.direction));
            }
            EXPECT_EQ(tests, planes.tests[index]);
            EXPECT_EQ(searches, planes.searches[index]);
        }
    }
}

TEST(Explain, PixelsOfRandomScenesAreThePicturesAndCostWhatItsPlanesSay) {
    for (unsigned seed = 1; seed <= 6; ++seed)
        expect_pixels_explained(testing::random_scene(seed, 20 * static_cast<int>(seed)), seed, 40);
    expect_pixels_explained(testing::grid_scene(), 9, 60);
}

TEST(Explain, PixelsOfFilesAreThePictures) {
    for (const char* name : {"showcase", "both", "teapot", "x3d/blender_scene_full"}) {
        const std::string path = std::string(NUVO_SOURCE_DIR) + "/testfiles/" + name + ".x3d";
        expect_pixels_explained(x3d::read_file(path), 77, 12);
    }
}

// A root of [-1, 1]^3 cut in its middle, the triangle listed in the lower four octants of z.
Octree known_octree() {
    std::vector<Node> nodes(9);
    nodes[0].voxel = Voxel::centered({{-1, -1, -1}, {1, 1, 1}});
    nodes[0].first_child = 1;
    std::vector<ItemId> items;
    for (int digit = 1; digit <= 8; ++digit) {
        Node& leaf = nodes[static_cast<std::size_t>(digit)];
        leaf.voxel = Voxel::centered(nodes[0].voxel.octant(digit));
        leaf.label = child_label(0, digit);
        leaf.first_item = static_cast<std::uint32_t>(items.size());
        if ((octant_bits(digit) & 4) != 0) continue;
        leaf.item_count = 1;
        items.push_back(0);
    }
    return {nodes, items};
}

TEST(Explain, OneTriangleInAKnownOctreeByHand) {
    Scene scene;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, -0.5}, {1, -1, -0.5}, {-1, 1, -0.5}};
    mesh.triangles = {{0, 1, 2}};
    scene.objects.push_back({mesh});
    scene.materials = {Material{}};
    scene.materials[0].diffuse_color = {1, 0.5, 0};
    scene.materials[0].ambient_intensity = 0.5;
    scene.materials[0].emissive_color = {0, 0, 0.25};
    Light sun;
    sun.direction = {0, 0, -1};
    sun.intensity = 0.5;
    sun.ambient_intensity = 0.25;
    Light other = sun;
    other.scope = {1, 2};  // of another shape
    Light far;
    far.kind = Light::Kind::kPoint;
    far.location = {0, 0, 200};
    scene.lights = {sun, other, far};
    scene.camera.position = {0, 0, 5};
    scene.camera.window = OrthoWindow{{-1, -1}, {1, 1}};
    const Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = known_octree();
    constexpr double kEndless = std::numeric_limits<double>::infinity();

    // x = -0.75, y = -0.25: octants 7 (-x, -y, +z), which is empty, then 5.
    const PixelStory hit = explain_pixel(scene, primitives, octree, profile, {4, 4}, 0, 2);
    EXPECT_EQ(hit.primary.ray.origin, (Point3{-0.75, -0.25, 5}));
    ASSERT_EQ(hit.primary.voxels.size(), 2u);
    const VoxelStory& first = hit.primary.voxels[0];
    EXPECT_EQ(first.name, 7u);
    EXPECT_EQ(first.box.min, (Point3{-1, -1, 0}));
    EXPECT_EQ(first.box.max, (Point3{0, 0, 1}));
    EXPECT_EQ(first.t_in, 4);
    EXPECT_EQ(first.t_out, 5);
    EXPECT_EQ(first.items, 0u);
    EXPECT_TRUE(first.tests.empty());
    const VoxelStory& second = hit.primary.voxels[1];
    EXPECT_EQ(second.name, 5u);
    EXPECT_EQ(second.t_in, 5);
    EXPECT_EQ(second.t_out, 6);
    ASSERT_EQ(second.tests.size(), 1u);
    EXPECT_TRUE(second.tests[0].hit);
    EXPECT_EQ(second.tests[0].t, 5.5);
    EXPECT_EQ(second.tests[0].stage, Stage::kCheap);
    EXPECT_EQ(hit.primary.searches, 2u);  // for the first voxel and for the second
    ASSERT_TRUE(hit.surface);
    EXPECT_EQ(hit.surface->t, 5.5);
    EXPECT_EQ(hit.surface->point, (Point3{-0.75, -0.25, -0.5}));
    EXPECT_EQ(hit.surface->normal, (Vector3{0, 0, 1}));
    ASSERT_EQ(hit.surface->lights.size(), 3u);
    const LightStory& lit = hit.surface->lights[0];
    EXPECT_EQ(lit.end, LightStory::End::kLit);
    ASSERT_TRUE(lit.shadow);
    EXPECT_EQ(lit.shadow->t_end, kEndless);
    ASSERT_EQ(lit.shadow->voxels.size(), 2u);
    EXPECT_EQ(lit.shadow->voxels[0].name, 5u);
    EXPECT_EQ(lit.shadow->voxels[0].t_in, 0);
    EXPECT_EQ(lit.shadow->voxels[0].t_out, 0.5);
    EXPECT_EQ(lit.shadow->voxels[1].name, 7u);
    // Ambient 0.25 x 0.5, diffuse 0.5 x 1, times the material's color.
    EXPECT_EQ(lit.terms.ambient, (Color{0.125, 0.0625, 0}));
    EXPECT_EQ(lit.terms.diffuse, (Color{0.5, 0.25, 0}));
    EXPECT_EQ(lit.terms.specular, Color{});
    EXPECT_EQ(lit.adds, (Color{0.625, 0.3125, 0}));
    EXPECT_EQ(hit.surface->lights[1].end, LightStory::End::kOutOfScope);
    EXPECT_EQ(hit.surface->lights[2].end, LightStory::End::kTooFar);
    EXPECT_EQ(hit.color, (Color{0.625, 0.3125, 0.25}));
    EXPECT_EQ(hit.bytes, (Rgb8{159, 80, 64}));  // 159.375, 79.6875, 63.75

    // x = 0.75, y = 0.75: octants 4 and 2; the triangle is missed.
    const PixelStory miss = explain_pixel(scene, primitives, octree, profile, {4, 4}, 3, 0);
    EXPECT_FALSE(miss.surface);
    ASSERT_EQ(miss.primary.voxels.size(), 2u);
    EXPECT_EQ(miss.primary.voxels[0].name, 4u);
    EXPECT_EQ(miss.primary.voxels[1].name, 2u);
    ASSERT_EQ(miss.primary.voxels[1].tests.size(), 1u);
    EXPECT_FALSE(miss.primary.voxels[1].tests[0].hit);
    EXPECT_EQ(miss.primary.searches, 3u);
    EXPECT_EQ(miss.bytes, (Rgb8{0, 0, 0}));
}

}  // namespace
}  // namespace nuvo
