#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "nuvo/geometry/predicates.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"
#include "parts.h"

// Surfaces that lie in each other, and rays that start or end where many meet: the picture is that
// of brute force, and what one ray has found is not found again by all others.
namespace nuvo::hard {
namespace {

constexpr Resolution kSmall{32, 20};
constexpr std::uint64_t kPixels = 640;

Scene read(const std::string& nodes) {
    return x3d::read_text("<X3D><Scene>" + nodes + "</Scene></X3D>", "test");
}

/// The picture is that of brute force; returns what it took.
TraceCounts counts_of(const Scene& scene, MidpointChoice midpoint) {
    Profile profile = exact_profile();
    profile.type = OctreeType::kNonuniform;
    profile.midpoint = midpoint;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    EXPECT_EQ(render(scene, primitives, octree, profile, kSmall),
              render_brute_force(scene, primitives, profile, kSmall));
    return count_events(scene, primitives, octree, profile, kSmall);
}

using Nudge = double (*)(double x, int triangle, int coordinate);

/// `count` copies of one triangle, each coordinate passed through `nudge`.
Scene crowd(int count, Nudge nudge) {
    constexpr double kCorners[9] = {-1.5, -1.2, 0.3, 1.5, -1.1, 0.7, 0.1, 1.4, 0.1};
    Scene scene = read(
        "<Viewpoint position='0 0 4'/><DirectionalLight direction='-.2 -.3 -1'/>"
        "<PointLight location='1 2 3' radius='100'/><Shape><Appearance><Material/></Appearance>"
        "<Box size='.1 .1 .1'/></Shape>");
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            Point3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = nudge(kCorners[3 * corner + axis], i, 3 * corner + axis);
            mesh.positions.push_back(p);
        }
        const auto first = static_cast<std::uint32_t>(3 * i);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    Object object = scene.objects[0];
    object.shape = mesh;
    scene.objects.push_back(object);
    return scene;
}

double same(double x, int, int) { return x; }
double one_place_further(double x, int triangle, int coordinate) {
    return coordinate % 3 == 2 ? x + triangle * 0x1p-52 : x;
}
double last_bit(double x, int triangle, int coordinate) {
    const unsigned mixed = static_cast<unsigned>(9 * triangle + coordinate) * 2654435761U;
    return mixed >> 30 == 0   ? std::nextafter(x, 9.0)
           : mixed >> 30 == 1 ? std::nextafter(x, -9.0)
                              : x;
}

// Every ray tested every triangle, and compared those it met in big integers.
TEST(Crowds, TrianglesThatLieInEachOtherCostAFewTestsARay) {
    constexpr int kCount = 300;
    for (const Nudge nudge : {same, one_place_further, last_bit}) {
        const TraceCounts counts = counts_of(crowd(kCount, nudge), MidpointChoice::kSpatial);
        const std::uint64_t rays = counts.primary_rays + counts.shadow_rays;
        EXPECT_GT(counts.shadow_rays, 100U);
        EXPECT_LT(counts.predicates->tests, rays * kCount / 4);
        EXPECT_LT(counts.predicates->exact, 40U * kCount);
    }
}

// The cone of 98 triangles, seen from its tip: 4,900 big-integer signs a pixel.
TEST(Crowds, TheTipOfAConeCostsNoBigIntegers) {
    const std::string cone =
        "<Shape><Appearance><Material diffuseColor='.7 .7 .7'/></Appearance><IndexedFaceSet "
        "solid='false' coordIndex='0 1 2 3 -1'><Coordinate point='-6 0 6 6 0 6 6 0 -6 -6 0 -6'/>"
        "</IndexedFaceSet></Shape><Transform translation='0 1 0'><Shape><Appearance><Material "
        "diffuseColor='1 .5 0'/></Appearance><Cone bottomRadius='1' height='2'/></Shape>"
        "</Transform>";
    for (const char* const eye_and_light :
         {"<Viewpoint position='0 2 0' orientation='1 0 0 -1'/><PointLight location='3 5 0'/>",
          "<Viewpoint position='0 3 9' orientation='1 0 0 -.2'/><PointLight location='0 2 0'/>"})
        for (const MidpointChoice midpoint : {MidpointChoice::kSpatial, MidpointChoice::kSweep}) {
            const TraceCounts counts = counts_of(read(eye_and_light + cone), midpoint);
            EXPECT_LT(counts.predicates->exact, kPixels / 10);
            // No ray tests a triangle twice.
            EXPECT_LE(counts.predicates->tests, (counts.primary_rays + counts.shadow_rays) * 100);
        }
}

// Pages around one edge, on which the eye or the light lies between the corners.
TEST(Crowds, AnEyeOrALightOnASharedEdgeAsksOnceForEachTriangle) {
    std::string pages;
    constexpr int kPages = 40;
    for (int i = 0; i < kPages; ++i) {
        const double angle = 0.07 * i;
        pages +=
            "<Shape><Appearance><Material/></Appearance><IndexedTriangleSet solid='false' "
            "index='0 1 2'><Coordinate point='0.25 -1 0.25 0.5 1.5 -0.25 " +
            std::to_string(2 * std::cos(angle)) + " 0.1 " + std::to_string(2 * std::sin(angle)) +
            "'/></IndexedTriangleSet></Shape>";
    }
    // (0.375, 0.25, 0) is the middle of the edge.
    for (const char* const eye_and_light :
         {"<Viewpoint position='0.5 1.5 -0.25'/><PointLight location='3 5 9'/>",
          "<Viewpoint position='0.375 0.25 0'/><PointLight location='3 5 9'/>",
          "<Viewpoint position='0 0 7'/><PointLight location='0.375 0.25 0'/>",
          "<Viewpoint position='0 0 7'/><PointLight location='0.25 -1 0.25'/>"}) {
        const TraceCounts counts = counts_of(read(eye_and_light + pages), MidpointChoice::kSpatial);
        EXPECT_LT(counts.predicates->exact, kPixels + 4 * kPages);
    }
}

// Against rays: what is said of all of them holds for each.
TEST(Crowds, WhatIsSaidOfAllRaysHoldsForEach) {
    constexpr unsigned kSeed = 21;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed, Coordinates::kDouble);
    StageCounts counts;
    int hidden = 0;
    int free_ways = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto corner = [&] { return random.unit(); };
        const Triangle front{corner(), corner(), corner()};
        Triangle other{corner(), corner(), corner()};
        if (i % 2 == 0)  // nearly the same
            other = {front.a * (1 + (i % 5 - 2) * 0x1p-52), front.b * (1 + (i % 7 - 3) * 0x1p-52),
                     front.c * (1 + (i % 3 - 1) * 0x1p-52)};
        if (has_zero_area(front) || has_zero_area(other)) continue;
        const Point3 eye = corner() * 3;
        const Point3 light = corner() * 2;
        const bool hides_it = hides(front, eye, other, false, counts);
        const bool leaves_it = leaves_in_light(other, front, {light, false}, counts);
        hidden += hides_it;
        free_ways += leaves_it;
        for (int k = 0; k < 8; ++k) {
            const double u = k / 8.0;
            const Point3 aim =
                front.a + (front.b - front.a) * (u * 0.5) + (front.c - front.a) * (0.5 - u * 0.25);
            const ExactRay ray(Ray{eye, aim - eye});
            const auto first = hit(ray, front, counts);
            const auto second = hit(ray, other, counts);
            if (!first) continue;
            if (hides_it && second) {
                EXPECT_LT(compare_roots(ray, {&front}, {&other}, counts), 0) << i;
            }
            if (!leaves_it) continue;
            const SurfacePoint p = surface_point(ray, front);
            EXPECT_FALSE(blocks(ExactRay::between(p.point, light), 1, p.error, other, counts)) << i;
        }
    }
    EXPECT_GT(hidden, 300);
    EXPECT_GT(free_ways, 300);
}

}  // namespace
}  // namespace nuvo::hard
