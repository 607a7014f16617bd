#include <gtest/gtest.h>

#include <set>

#include "exact_kernel.h"
#include "fast/shadow/segment_walk.h"
#include "fast_cases.h"

// The walk of a single shadow ray in double, against brute force by the exact predicates, in scenes
// so wide that floats cannot tell their small things apart.

namespace nuvo::testing {
namespace {

Object triangle_of(const Point3& a, const Vector3& u, const Vector3& v) {
    TriangleMesh mesh;
    mesh.positions = {a, a + u, a + v};
    mesh.triangles = {{0, 1, 2}};
    return {mesh, 0, 0};
}

// Small triangles and spheres in a cube of side 2, on a floor of this half width.
Scene cluster_on_a_floor(std::mt19937_64& random, double width, int count) {
    Scene scene;
    scene.camera = camera_along({0.3, 1.5, 5}, {0, -0.2, -1});
    scene.materials.emplace_back();
    scene.objects.push_back(
        triangle_of({-width, -1.5, -width}, {0, 0, 2.5 * width}, {3 * width, 0, 0}));
    for (int i = 0; i < count; ++i) {
        const Point3 at = uniform_point(random, 1);
        if (i % 4 == 0) {
            scene.objects.push_back({Sphere{at, uniform(random, 0.01, 0.1)}, 0, 0});
        } else {
            const Vector3 e1 = uniform_point(random, 0.1);
            scene.objects.push_back(triangle_of(at, e1, uniform_point(random, 0.1)));
        }
    }
    for (Object& object : scene.objects) object.solid = false;
    Light lamp;
    lamp.location = {1, 4, 2};
    Light sun;
    sun.kind = Light::Kind::kDirectional;
    sun.direction = normalized(Vector3{0.5, -1, -0.25});
    scene.lights = {lamp, sun};
    return scene;
}

TEST(SegmentWalk, LeavesOutNothingThatTheRayMeets) {
    constexpr unsigned kSeed = 20;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    long met = 0;
    for (const double width : {1.0, 1e3, 1e6})
        for (const OctreeType type : kTypes) {
            const Scene scene = cluster_on_a_floor(random, width, 400);
            const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
            const FastScene fast(scene, primitives, type, 1);
            const ExactKernelOf<SceneStore> kernel(scene, primitives, std::nullopt);
            std::size_t visited_in_all = 0;
            for (int i = 0; i < 200; ++i) {
                Ray ray{uniform_point(random, 2), uniform_point(random, 1)};
                if (i % 5 == 0) ray.direction[i % 3] = 0;
                if (i % 7 == 0) ray.direction = {0, i % 2 == 0 ? -1.0 : 1.0, 0};
                const double end = i % 2 == 0 ? std::numeric_limits<double>::infinity() : 1;
                const auto prepared = kernel.prepare(ray);
                std::set<Slot> visited;
                SegmentWalk(prepared, end, fast.frame())
                    .any(fast.octree(), [&](const std::uint32_t* items, std::uint32_t count) {
                        visited.insert(items, items + count);
                        return false;
                    });
                visited_in_all += visited.size();
                for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
                    const auto hit = kernel.hit_of(prepared, fast.id(slot));
                    if (!hit || hit->root.t > end) continue;
                    ++met;
                    EXPECT_TRUE(visited.contains(slot)) << width << " ray " << i;
                }
            }
            EXPECT_LT(visited_in_all, 200U * 400 / 3) << width;
        }
    EXPECT_GT(met, 200);
}

TEST(SegmentWalk, StopsWhereItIsTold) {
    std::mt19937_64 random(21);
    const Scene scene = cluster_on_a_floor(random, 10, 400);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    int leaves = 0;
    SegmentWalk walk(ExactRay(Ray{{-3, 0, 0}, {1, 0, 0}}), 10, fast.frame());
    EXPECT_TRUE(walk.any(fast.octree(),
                         [&](const std::uint32_t*, std::uint32_t) { return ++leaves == 2; }));
    EXPECT_EQ(leaves, 2);
}

TEST(SegmentWalk, SmallThingsOnVeryWideFloorsCastTheirShadows) {
    std::mt19937_64 random(22);
    for (const double width : {1e4, 1e6, 1e9})
        expect_identical(cluster_on_a_floor(random, width, 1000), {{32, 24}});
}

// Of 700 triangles that differ in the last bits of their corners no cut parts any.
TEST(SegmentWalk, ManyNearlyCoincidentTrianglesKeepTheirColorsAndShadows) {
    constexpr unsigned kSeed = 23;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    Scene scene = cluster_on_a_floor(random, 4, 0);
    const auto nearly = [&](double x) { return x * (1 + uniform(random, -0x1p-51, 0x1p-51)); };
    for (int i = 0; i < 700; ++i) {
        TriangleMesh mesh;
        for (const Point3& p :
             {Point3{-1.1, -1.03, 0.1}, Point3{1.2, -0.97, -0.2}, Point3{0.13, 1.07, 0.3}})
            mesh.positions.push_back({nearly(p.x), nearly(p.y), nearly(p.z)});
        mesh.triangles = {{0, 1, 2}};
        scene.objects.push_back({mesh, 0, 0});
        scene.objects.back().solid = false;
    }
    expect_identical(scene, {{24, 18}});
}

}  // namespace
}  // namespace nuvo::testing
