#include "fast/light/wanted_items.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <random>

#include "fast/frame/frame.h"
#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/geometry/shape.h"
#include "property/test_scenes.h"

namespace nuvo {
namespace {

using testing::uniform;
using testing::uniform_point;

bool blocks_light(const Scene& scene, const FastScene& fast, Slot slot, const Point3& from,
                  const Light& light) {
    StageCounts counts;
    const bool endless = light.kind == Light::Kind::kDirectional;
    const ExactRay way =
        endless ? ExactRay(Ray{from, -light.direction}) : ExactRay::between(from, light.location);
    const double end = endless ? std::numeric_limits<double>::infinity() : 1;
    const PrimitiveSource& source = fast.source(slot);
    const Object& object = scene.objects[source.object];
    if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
        return nuvo::blocks(way, end, 0, mesh->triangle(source.triangle), counts, Sides::kBoth);
    if (const auto* sphere = std::get_if<Sphere>(&object.shape))
        return nuvo::blocks(way, end, 0, *sphere, false, counts, Sides::kBoth);
    return false;
}

/// A tile of points in a small part of the scene, each off by up to its error.
struct WantedTile {
    WantedTile(std::mt19937_64& random, const FastScene& fast) {
        const Point3 middle = uniform_point(random, 0.4);
        for (int lane = 0; lane < kTileLanes; ++lane) {
            const Point3 local = middle + uniform_point(random, 0.05);
            const double error = std::exp2(uniform(random, -24, -14));
            points[lane] = local * (1 / fast.frame().scale) + fast.frame().center;
            const Point3 off = local + uniform_point(random, 0.9 * error);
            for (int axis = 0; axis < 3; ++axis)
                tile.point[axis][lane] = static_cast<float>(off[axis]);
            tile.point_error[lane] = static_cast<float>(error);
        }
        std::fill(std::begin(wanted), std::end(wanted), std::uint16_t{0xffff});
    }

    Tile tile;
    TileMask wanted;
    Point3 points[kTileLanes];
};

/// Lights around, among and far from the scene.
std::vector<Light> some_lights(std::mt19937_64& random) {
    std::vector<Light> lights(8);
    for (std::size_t i = 0; i < 3; ++i) lights[i].direction = normalized(uniform_point(random, 1));
    lights[0].direction = {0, 0, -1};
    for (std::size_t i = 3; i < lights.size(); ++i) {
        lights[i].kind = Light::Kind::kPoint;
        lights[i].radius = std::numeric_limits<double>::infinity();
        lights[i].location = uniform_point(random, i < 6 ? 9 : std::pow(10.0, i - 3));
    }
    return lights;
}

TEST(WantedItems, HoldWhateverBlocksAWantedPoint) {
    int blocking = 0;
    int left_out = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        std::mt19937_64 random(seed);
        Scene scene = testing::random_scene(seed, 300);
        scene.lights = some_lights(random);
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
        const auto tile = std::make_unique<WantedTile>(random, fast);
        BigVector<LocalSphere> quadrics;
        for (Slot slot = fast.triangle_end(); slot < fast.slot_end(); ++slot) {
            const Bounds3 box = bounds(fast.object(fast.id(slot)).shape);
            const Point3 center = fast.frame().local(box.center());
            const double radius = length(box.widths()) * fast.frame().scale;  // and more
            quadrics.push_back({{static_cast<float>(center.x), static_cast<float>(center.y),
                                 static_cast<float>(center.z)},
                                static_cast<float>(radius)});
        }
        for (const InstructionSet isa : supported_instruction_sets())
            for (const Light& light : scene.lights) {
                const LightPoint place(light, fast.frame());
                std::optional<WantedDepths> depths = WantedDepths::of(fast, place, isa);
                ASSERT_TRUE(depths);
                depths->add(tile->tile, tile->wanted);
                depths->finish();
                const LightItems all{fast, quadrics, 0x1p-20};
                const BigVector<Slot> items = wanted_items(all, *depths, isa, 2);
                ASSERT_TRUE(std::is_sorted(items.begin(), items.end()));
                left_out += static_cast<int>(fast.slot_end() - items.size());
                // Points close to a light are not looked up.
                const double least = 0x1p-4;
                for (const Point3& point : tile->points) {
                    const Vector3 way = place.toward - fast.frame().local(point) * place.weight;
                    if (max_norm(way) < least) continue;
                    for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
                        if (!blocks_light(scene, fast, slot, point, light)) continue;
                        ++blocking;
                        ASSERT_TRUE(std::binary_search(items.begin(), items.end(), slot))
                            << "seed " << seed << ", slot " << slot;
                    }
                }
            }
    }
    const int sets = static_cast<int>(supported_instruction_sets().size());
    EXPECT_GT(blocking, 3000 * sets);
    EXPECT_GT(left_out, 300 * sets);
}

// Points that a picture did not show may be shown by the next, and walk the octree; triangles of
// which something is seen from the back, or that have interpolated normals, are shaded anew.
TEST(KeptTables, ServePicturesOfOtherCameras) {
    constexpr Resolution kSizes[] = {{96, 64}, {96, 64}, {60, 40}, {96, 64}};
    enum Kind : unsigned { kSolid, kTwoSided, kSmooth, kKinds };
    for (unsigned seed = 0; seed < kKinds; ++seed) {
        std::mt19937_64 random(seed);
        Scene scene = testing::random_scene(seed, 300);
        scene.lights = some_lights(random);
        for (Object& object : scene.objects) {
            object.solid = seed != kTwoSided;
            auto* const mesh = std::get_if<TriangleMesh>(&object.shape);
            if (mesh == nullptr || seed != kSmooth) continue;
            while (mesh->normals.size() < mesh->positions.size())
                mesh->normals.push_back(normalized(uniform_point(random, 1)));
        }
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
        SerialTree serial(fast);
        for (const InstructionSet isa : supported_instruction_sets())
            for (const ShadowListing listing : {ShadowListing::kAll, ShadowListing::kKept}) {
                const FastOptions options{OctreeType::kUniform, 2, isa};
                KeptTables kept;
                const std::vector<Light> lights = scene.lights;
                for (int picture = 0; picture < 6; ++picture) {
                    const Resolution size = kSizes[picture % 4];
                    const Point3 eye = uniform_point(random, 1) + Vector3{0, 0, 2};
                    // Once nothing is another, and once only the picture's size.
                    if (picture != 1 && picture != 2)
                        scene.camera = testing::camera_along(eye, Point3{} - eye);
                    if (picture == 4) scene.lights.pop_back();
                    const Image expected = testing::exact_picture(scene, primitives, size);
                    Frame frame(serial, options, size, nullptr, kept, listing);
                    EXPECT_EQ(testing::difference(expected, frame.render()), "")
                        << "kind " << seed << ", picture " << picture;
                    ASSERT_NE(kept.shadows(), nullptr);
                    EXPECT_EQ(kept.shadows()->complete(), listing == ShadowListing::kAll);
                }
                scene.lights = lights;
                kept.begin(fast, 1);
                EXPECT_EQ(kept.shadows(), nullptr);
            }
    }
}

// Where a picture shows most of a large scene, tables are made of all of it for a light that
// reaches all, and of a few items for one that reaches little.
TEST(KeptTables, ListFewItemsForALightThatReachesLittle) {
    constexpr Resolution kSize{160, 120};
    constexpr int kSide = 240;
    constexpr unsigned kSeed = 20261191;
    std::mt19937_64 random(kSeed);
    Scene scene;
    scene.materials.emplace_back();
    TriangleMesh ground;
    for (int i = 0; i <= kSide; ++i)
        for (int k = 0; k <= kSide; ++k)
            ground.positions.push_back(
                {i * 2.0 / kSide - 1, uniform(random, 0, 0.02), k * 2.0 / kSide - 1});
    for (std::uint32_t i = 0; i < kSide; ++i)
        for (std::uint32_t k = 0; k < kSide; ++k) {
            const std::uint32_t at = i * (kSide + 1) + k;
            ground.triangles.push_back({at, at + 1, at + kSide + 1});
            ground.triangles.push_back({at + 1, at + kSide + 2, at + kSide + 1});
        }
    scene.objects.push_back({ground, 0, 0});
    scene.lights.resize(2);
    scene.lights[0].direction = normalized(Vector3{-1, -0.2, -0.3});
    Light& spot = scene.lights[1];
    spot.kind = Light::Kind::kSpot;
    spot.location = {0.4, 0.3, 0.4};
    spot.direction = {0, -1, 0};
    spot.cut_off_angle = spot.beam_width = 0.4;
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    SerialTree serial(fast);
    KeptTables kept;
    for (const double x : {0.0, 0.3}) {
        scene.camera = testing::camera_along({x, 1.6, 0}, {0, -1, 0.01});
        Frame frame(serial, {OctreeType::kUniform, 2}, kSize, nullptr, kept);
        EXPECT_EQ(
            testing::difference(testing::exact_picture(scene, primitives, kSize), frame.render()),
            "")
            << "seed " << kSeed;
        ASSERT_NE(kept.shadows(), nullptr);
        EXPECT_TRUE(kept.shadows()->table(0).complete());
        EXPECT_TRUE(kept.shadows()->table(0).buffer.usable());
        EXPECT_FALSE(kept.shadows()->table(1).complete());
        EXPECT_LT(kept.shadows()->table(1).slots.size(), fast.slot_end() / 4);
    }
}

TEST(KeptTables, CountWhatTheirThreadsKnow) {
    Scene scene;
    scene.materials.emplace_back();
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 2}, {0, 1, 3}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    scene.objects.push_back({mesh, 0, 0});
    scene.lights.emplace_back().location = {1, 2, 9};
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    KeptTables kept;
    kept.begin(fast, 2);
    EXPECT_EQ(kept.thread_bytes(), 0u);
    // Far apart: no sign is kept.
    constexpr std::size_t kPairs = 1024 * 16;
    kept.of_thread(0).pairs.of(0, 1, 0);
    EXPECT_EQ(kept.thread_bytes(), kPairs);
    kept.of_thread(1).pairs.of(0, 1, 0);
    EXPECT_EQ(kept.thread_bytes(), 2 * kPairs);
    // In the plane, which only exact arithmetic tells: triangle, point, kind and sign.
    constexpr std::size_t kSides = 4096 * (9 + 3 + 1) * sizeof(double);
    const Triangle plane{{0, 0, 0}, {1.0 / 3, 1.0 / 7, 1.0 / 11}, {1.0 / 5, 1.0 / 13, 1.0 / 17}};
    StageCounts& stages = kept.of_thread(1).stages;
    EXPECT_EQ(stages.sides.side(plane, plane.b * 0.5, stages.exact), 0);
    EXPECT_EQ(stages.exact, 1u);
    EXPECT_EQ(kept.thread_bytes(), 2 * kPairs + kSides);
    scene.lights.clear();
    kept.begin(fast, 2);
    EXPECT_EQ(kept.thread_bytes(), 0u);
}

TEST(WantedDepths, CoverThePointsThatTheyCount) {
    int covered = 0;
    int all = 0;
    std::mt19937_64 random(7);
    Scene scene = testing::random_scene(7, 300);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const auto some = std::make_unique<WantedTile>(random, fast);
    const auto others = std::make_unique<WantedTile>(random, fast);
    for (const InstructionSet isa : supported_instruction_sets())
        for (const Light& light : some_lights(random)) {
            std::optional<WantedDepths> depths =
                WantedDepths::of(fast, LightPoint(light, fast.frame()), isa);
            ASSERT_TRUE(depths);
            const auto count = [&](const WantedTile& tile) {
                TileMask lanes = tile.wanted;
                depths->keep_covered(tile.tile, lanes);
                int lanes_left = 0;
                for (const std::uint16_t block : lanes) lanes_left += std::popcount(block);
                return lanes_left;
            };
            EXPECT_EQ(count(*some), 0);
            depths->add(some->tile, some->wanted);
            depths->finish();
            const int known = count(*some);
            covered += known;
            EXPECT_LT(count(*others), kTileLanes);
            depths->add(others->tile, others->wanted);
            EXPECT_GE(count(*some), known);
            all += kTileLanes;
        }
    EXPECT_GT(covered, all / 2);
}

TEST(WantedItems, AreNoneWhereNoPointIsWanted) {
    Scene scene = testing::random_scene(3, 100);
    scene.lights.resize(1);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    BigVector<LocalSphere> quadrics;
    quadrics.resize(fast.slot_end() - fast.triangle_end());
    std::fill(quadrics.begin(), quadrics.end(), LocalSphere{{0, 0, 0}, 1});
    const InstructionSet isa = resolved(InstructionSet::kBest);
    const LightPoint place(scene.lights[0], fast.frame());
    std::optional<WantedDepths> depths = WantedDepths::of(fast, place, isa);
    ASSERT_TRUE(depths);
    depths->finish();
    EXPECT_TRUE(wanted_items({fast, quadrics, 0x1p-20}, *depths, isa, 1).empty());
}

}  // namespace
}  // namespace nuvo
