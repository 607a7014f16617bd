#include "fast/scene/triangle_chunk.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <random>

#include "fast/camera/camera_tables.h"
#include "fast/shading/shading_tables.h"
#include "fast/shadow/shadow_tables.h"
#include "fast/simd/dispatch.h"

namespace nuvo {
namespace {

// Meshes of one to five triangles and some of hundreds, in no order, and spheres between them.
Scene scene_of_many_meshes(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    const auto point = [&] { return Point3{place(engine), place(engine), place(engine)}; };
    Scene scene;
    scene.materials.emplace_back();
    for (int i = 0; i < 300; ++i) {
        if (i % 7 == 3) {
            scene.objects.push_back({Sphere{point(), 0.1}});
            scene.objects.back().solid = i % 2 == 0;
            continue;
        }
        TriangleMesh mesh;
        const std::size_t count = i % 50 == 0 ? 300 : 1 + engine() % 5;
        for (std::size_t k = 0; k < count + 2; ++k) mesh.positions.push_back(point());
        for (std::uint32_t k = 0; k < count; ++k) mesh.triangles.push_back({k + 2, k, k + 1});
        scene.objects.push_back({mesh});
        scene.objects.back().solid = i % 2 == 0;
    }
    Light sun;
    sun.direction = {0.6, 0, -0.8};
    Light lamp;
    lamp.kind = Light::Kind::kPoint;
    lamp.location = {0.2, 0.3, 0.1};  // within the scene: shapes are on both sides
    for (Light* light : {&sun, &lamp}) {
        light->casts_shadow = true;
        scene.lights.push_back(*light);
    }
    scene.camera.position = {0, 0, 3};
    return scene;
}

class TriangleChunkTest : public testing::Test {
  protected:
    static constexpr unsigned kSeed = 5;
    Scene scene_ = scene_of_many_meshes(kSeed);
    Primitives primitives_ = flatten(scene_, LeafContent::kPrimitives);
    FastScene fast_{scene_, primitives_, OctreeType::kUniform, 1};
};

TEST_F(TriangleChunkTest, BringsEveryTriangleOnceInItsPlace) {
    for (const int threads : {1, 2, 7}) {
        std::vector<std::atomic<int>> met(fast_.triangle_end());
        std::atomic<int> wrong = 0;
        for_each_chunk(fast_, {}, fast_.triangle_end(), threads, [&](const TriangleChunk& chunk) {
            chunk.for_each_batch([&](const TriangleBatch& batch, Slot first, std::size_t count) {
                for (std::size_t i = 0; i < TriangleBatch::kSize; ++i) {
                    // Beyond the last one the first one again.
                    const Slot slot = first + static_cast<Slot>(i < count ? i : 0);
                    const PrimitiveSource& source = fast_.source(slot);
                    const auto& mesh = std::get<TriangleMesh>(scene_.objects[source.object].shape);
                    const Triangle expected = mesh.triangle(source.triangle);
                    const Triangle found = batch.triangle(i);
                    wrong += found.a == expected.a && found.b == expected.b && found.c == expected.c
                                 ? 0
                                 : 1;
                    if (i < count) ++met[slot];
                }
            });
        });
        EXPECT_EQ(wrong, 0) << "seed " << kSeed << ", threads " << threads;
        for (const auto& times : met) ASSERT_EQ(times, 1) << "seed " << kSeed;
    }
}

TEST_F(TriangleChunkTest, EveryQuadricHasASlotOfItsOwn) {
    std::vector<int> met(fast_.slot_end());
    for (const QuadricSlot& quadric : fast_.quadrics()) ++met[quadric.slot];
    for (Slot slot = 0; slot < fast_.slot_end(); ++slot)
        ASSERT_EQ(met[slot], slot < fast_.triangle_end() ? 0 : 1);
}

template <typename Table>
bool same_bytes(const Table& a, const Table& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

TEST_F(TriangleChunkTest, TablesDoNotDependOnWhenAndByHowManyTheyAreFilled) {
    const CameraRays rays(scene_.camera, {64, 48}, fast_.frame());
    const InstructionSet isa = resolved(InstructionSet::kBest);
    CameraTables camera(fast_, rays, isa);
    ShadowTables shadow(fast_, isa);
    ShadingTables shading(fast_, rays, camera, isa);
    shading.fill_all(1);
    for (const int threads : {1, 2, 7}) {
        CameraTables camera_later(fast_, rays, isa, threads);
        ShadowTables shadow_later(fast_, isa, threads);
        ShadingTables shading_later(fast_, rays, camera_later, isa);
        shading_later.fill_all(threads);
        ASSERT_EQ(camera.spheres.size(), camera_later.spheres.size());
        for (std::size_t i = 0; i < camera.spheres.size(); ++i) {
            EXPECT_EQ(camera.spheres[i].radius, camera_later.spheres[i].radius);
            EXPECT_EQ(camera.spheres[i].inverse_power, camera_later.spheres[i].inverse_power);
        }
        for (std::size_t light = 0; light < scene_.lights.size(); ++light) {
            EXPECT_TRUE(same_bytes(shadow.table(light).hides, shadow_later.table(light).hides));
            for (Slot slot = 0; slot < fast_.triangle_end(); ++slot) {
                if ((shadow.table(light).hides[slot / 8] >> slot % 8 & 1) == 0) continue;
                ASSERT_EQ(
                    std::memcmp(&shadow.table(light).planes[slot],
                                &shadow_later.table(light).planes[slot], sizeof(ShadowPlanes)),
                    0);
            }
            EXPECT_TRUE(same_bytes(shading.triangles.cosines[light],
                                   shading_later.triangles.cosines[light]));
        }
    }
}

TEST_F(TriangleChunkTest, SidesOfALightAreKnownWhereItStandsWithinTheScene) {
    ShadowTables tables(fast_, resolved(InstructionSet::kBest));
    EXPECT_TRUE(tables.table(0).quadric_sides.empty());  // a direction is outside of all
    const Point3& lamp = scene_.lights[1].location;
    for (Slot slot = fast_.triangle_end(); slot < fast_.slot_end(); ++slot) {
        const auto& sphere = std::get<Sphere>(scene_.objects[fast_.source(slot).object].shape);
        const double gap = length(sphere.center - lamp) - sphere.radius;
        if (std::fabs(gap) < 1e-3) continue;  // may be unknown
        const auto& sides = tables.table(1).quadric_sides;
        const LightSide side =
            sides.empty() ? LightSide::kOutside : sides[slot - fast_.triangle_end()];
        const LightSide within = scene_.objects[fast_.source(slot).object].solid
                                     ? LightSide::kNoShadow
                                     : LightSide::kInside;
        EXPECT_EQ(side, gap > 0 ? LightSide::kOutside : within);
    }
}

TEST_F(TriangleChunkTest, ALightWithinASphereIsInsideOfIt) {
    scene_.lights[1].location = std::get<Sphere>(scene_.objects[3].shape).center;
    for (const bool solid : {false, true}) {
        scene_.objects[3].solid = solid;
        ShadowTables tables(fast_, resolved(InstructionSet::kBest));
        ASSERT_FALSE(tables.table(1).quadric_sides.empty());
        EXPECT_EQ(tables.table(1).quadric_sides[0],
                  solid ? LightSide::kNoShadow : LightSide::kInside);
    }
}

TEST_F(TriangleChunkTest, NothingThatCastsNoShadowHidesAnything) {
    for (Object& object : scene_.objects) object.casts_shadow = false;
    const Primitives primitives = flatten(scene_, LeafContent::kPrimitives);
    const FastScene fast(scene_, primitives, OctreeType::kUniform, 1);
    ShadowTables tables(fast, resolved(InstructionSet::kBest));
    for (std::size_t light = 0; light < scene_.lights.size(); ++light) {
        for (Slot slot = 0; slot < fast.triangle_end(); ++slot)
            ASSERT_EQ(tables.table(light).hides[slot / 8] >> slot % 8 & 1, 0);
        for (const LightSide side : tables.table(light).quadric_sides)
            ASSERT_EQ(side, LightSide::kNoShadow);
        EXPECT_EQ(tables.table(light).quadric_sides.size(), fast.slot_end() - fast.triangle_end());
    }
}

}  // namespace
}  // namespace nuvo
