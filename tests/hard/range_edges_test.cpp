#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "nuvo/geometry/overlap.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"
#include "parts.h"

// Scenes and rays at the edges of double's range, and surfaces flat to nothing: every octree and
// walk against brute force.
namespace nuvo::hard {
namespace {

constexpr Resolution kSmall{30, 20};

// A strategy of each kind, each walk, also where a cut does not pay.
std::vector<Profile> profiles() {
    std::vector<Profile> all;
    for (const MidpointChoice midpoint :
         {MidpointChoice::kSpatial, MidpointChoice::kSweep, MidpointChoice::kPublished})
        for (const bool cut_all : {false, true}) {
            Profile profile = exact_profile();
            profile.type = OctreeType::kNonuniform;
            profile.midpoint = midpoint;
            profile.walk = cut_all ? WalkChoice::kDescent : WalkChoice::kHash;
            if (cut_all) profile.max_objects = 1;
            all.push_back(profile);
        }
    return all;
}

void expect_brute_force(const Scene& scene) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const Image expected = render_brute_force(scene, primitives, exact_profile(), kSmall);
    int index = 0;
    for (const Profile& profile : profiles()) {
        const Octree octree = build_tree(scene, primitives, profile);
        EXPECT_EQ(render(scene, primitives, octree, profile, kSmall), expected)
            << "profile " << index;
        ++index;
    }
}

Scene read(const std::string& nodes) {
    return x3d::read_text("<X3D><Scene>" + nodes + "</Scene></X3D>", "test");
}

// What the rounding of the lit point can add to the equation of a surface 1e-20 thick is more than
// the equation's values anywhere in its plane: points beside it were said to touch it, and touching
// to block.
TEST(RangeEdges, WhatLiesInTheRoundingOfAFlatEllipsoidDoesNotBlock) {
    expect_brute_force(
        read("<Viewpoint position='0 0 10'/><Shape><Cylinder radius='0.5' height='0'/></Shape>"
             "<Transform translation='1 0 0' scale='1 1 1e-20'><Shape><Sphere radius='2'/></Shape>"
             "<Shape><Appearance><Material/></Appearance><IndexedTriangleSet index='0 1 2'>"
             "<Coordinate point='0 0 0 0 -3 0 -4 0 0'/></IndexedTriangleSet></Shape></Transform>"
             "<DirectionalLight direction='-2 0 1'/>"));
    const Ellipsoid flat{{1, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1e-20}}}, 2};
    StageCounts counts;
    constexpr double kError = 1e-14;
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    // Beside it in its plane: the way down leads past it, the way through the plane into it.
    const Point3 beside{-2.5, -0.125, 0};
    EXPECT_FALSE(blocks(ExactRay(Ray{beside, {2, 0, -1}}), kEndless, kError, flat, false, counts));
    EXPECT_TRUE(blocks(ExactRay(Ray{beside, {2, 0, 0}}), kEndless, kError, flat, false, counts));
    // A way that ends before it is not blocked, though its end lies outside.
    EXPECT_FALSE(blocks(ExactRay(Ray{beside, {2, 0, 0}}), 0.5, kError, flat, false, counts));
    EXPECT_TRUE(blocks(ExactRay(Ray{beside, {2, 0, 0}}), 4, kError, flat, false, counts));
}

TEST(RangeEdges, FlatEllipsoidsAreTheSameInEveryOctree) {
    for (const std::string thickness : {"1e-320", "1e-200", "1e-30", "1e-16", "1e-12", "1e-8"})
        expect_brute_force(read(
            "<Viewpoint position='0 0 10'/><DirectionalLight direction='-2 0.5 1'/>"
            "<PointLight location='-3 2 1'/><Transform rotation='1 2 3 0.5'>"
            "<Transform translation='1 0 0' scale='1 0.5 " +
            thickness +
            "'><Shape><Sphere radius='2'/></Shape><Transform translation='-3 0 0'><Shape>"
            "<Sphere/></Shape></Transform></Transform></Transform>"
            "<Transform translation='1 1 -1'><Shape><Box size='5 5 0.1'/></Shape></Transform>"));
}

// The squares of 3e-162 are subnormal: 0.0 or a few units.
TEST(RangeEdges, OverlapTestsCountWhatUnderflows) {
    for (const double scale : {0x1p-1074, 0x1p-1060, 3e-162, 1e-154, 0x1p-341, 0x1p-540}) {
        const auto at = [&](double x, double y, double z) {
            return Point3{x * scale, y * scale, z * scale};
        };
        // The plane x + y + z = 24 touches the cube at (8, 8, 8), the sphere at (8, 0, 0).
        const Bounds3 cube{at(0, 0, 0), at(8, 8, 8)};
        EXPECT_TRUE(overlaps(Triangle{at(24, 0, 0), at(0, 24, 0), at(0, 0, 24)}, cube)) << scale;
        EXPECT_TRUE(overlaps(Sphere{at(12, 4, 4), 4 * scale}, cube)) << scale;
        EXPECT_TRUE(overlaps(Sphere{at(11, 12, 4), 5 * scale}, cube)) << scale;  // 3, 4, 5
        EXPECT_TRUE(overlaps(Sphere{at(4, 4, 4), 6 * scale}, cube)) << scale;  // corners stick out
    }
    EXPECT_FALSE(overlaps(Sphere{{3e-150, 3e-150, 0}, 4e-150}, {{}, {1e-151, 1e-151, 1e-151}}));
}

// At 3e-162 the non-uniform octree lost a pixel; at 1e-307 its search threw NLopt's own words.
TEST(RangeEdges, ScenesOfAnyScaleAreTheSameInEveryOctree) {
    for (const double scale :
         {0x1p-1070, 3e-318, 1e-307, 3e-162, 1e-154, 1e-77, 1e77, 1e150, 1e200, 1e300}) {
        SCOPED_TRACE(::testing::Message() << "scale " << scale);
        Random random(5, Coordinates::kDouble);
        Scene scene = mixed_scene(random, 12);
        place(scene, random, scale, {});
        scene.camera.position = {0, 0, 20 * scale};
        Light sun;
        sun.kind = Light::Kind::kDirectional;
        sun.direction = {-0.6, 0, -0.8};
        Light lamp;
        lamp.location = {9 * scale, 9 * scale, 9 * scale};
        lamp.radius = std::numeric_limits<double>::max();
        scene.lights = {sun, lamp};
        expect_brute_force(scene);
    }
}

// A hit whose t lies beyond double is a hit, given with the largest double, and one whose t lies
// below it with the least: whatever leads to it.
TEST(RangeEdges, RaysOfAnyLengthHaveOneAnswer) {
    Random random(8, Coordinates::kDouble);
    Scene scene = lattice_scene(random);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    std::vector<Ray> rays;
    for (const Point3& from : {Point3{9, 7, 5}, Point3{-8, 6, 7}, Point3{0.25, -9, 3}})
        for (const Vector3& to :
             {Vector3{-9, -7, -5}, Vector3{8, -5.5, -7.25}, Vector3{0, 9.25, -3}})
            for (const double length :
                 {0x1p-1074, 7e-310, 0x1p-1022, 1e-200, 1.0, 1e200, 0x1p1019}) {
                const Ray ray{from, to * length};
                if (!(ray.direction == Vector3{})) rays.push_back(ray);
            }
    const auto expected = closest_hits(scene, primitives, nullptr, exact_profile(), rays);
    int index = 0;
    int hits = 0;
    for (const Profile& profile : profiles()) {
        const Octree octree = build_tree(scene, primitives, profile);
        const auto found = closest_hits(scene, primitives, &octree, profile, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            hits += expected[i].hit;
            EXPECT_EQ(found[i].hit, expected[i].hit) << "profile " << index << ", ray " << i;
            EXPECT_EQ(found[i].shape, expected[i].shape) << "profile " << index << ", ray " << i;
            EXPECT_EQ(found[i].t, expected[i].t) << "profile " << index << ", ray " << i;
        }
        ++index;
    }
    EXPECT_GT(hits, 100);
    // A sphere of radius 1 seen from 9: t = 8 / |d|.
    Scene one;
    add(one, Sphere{{0, 0, 0}, 1});
    const Ray slow{{0, 0, 9}, {0, 0, -7e-310}};
    const Primitives sphere = flatten(one, LeafContent::kPrimitives);
    const auto answer = closest_hits(one, sphere, nullptr, exact_profile(), {&slow, 1});
    EXPECT_TRUE(answer[0].hit);
    EXPECT_EQ(answer[0].t, std::numeric_limits<double>::max());
}

}  // namespace
}  // namespace nuvo::hard
