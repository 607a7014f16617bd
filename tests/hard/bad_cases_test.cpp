#include <gtest/gtest.h>

#include "nuvo/geometry/predicates.h"
#include "nuvo/render/render.h"
#include "parts.h"

// What once was wrong, in numbers.
namespace nuvo::hard {
namespace {

// The lit sphere's other root was compared with the light's place. Where the light touches that
// sphere they are one, and the rounding of the lit point decided: every other point lost the light.
TEST(BadCases, ALightOnTheLitSphereIsNotBlockedByIt) {
    const Sphere sphere{{-2, 1, 0}, 1};
    const Point3 light{-2, 2, 0};
    StageCounts counts;
    for (const Point3& target : {Point3{-2.5, 1.25, 0.75}, Point3{-1.7, 0.9, 0.8},
                                 Point3{-2.2, 0.3, 0.6}, Point3{-1.5, 1.5, 0.5}}) {
        const ExactRay ray(Ray{{0, 3, 9}, target - Point3{0, 3, 9}});
        const auto found = hit(ray, sphere, counts);
        ASSERT_TRUE(found);
        const SurfacePoint lit = surface_point(ray, sphere, found->which);
        const ExactRay shadow = ExactRay::between(lit.point, light);
        EXPECT_FALSE(blocks(shadow, 1, lit.error, sphere, true, counts));
        EXPECT_FALSE(blocks(shadow, 1, lit.error, sphere, false, counts));
        // Beyond the surface the sphere is in the way, before it not.
        const ExactRay beyond = ExactRay::between(lit.point, {-2, std::nextafter(2.0, 3.0), 0});
        EXPECT_TRUE(blocks(beyond, 1, lit.error, sphere, true, counts));
        const ExactRay before = ExactRay::between(lit.point, {-2, std::nextafter(2.0, 1.0), 0});
        EXPECT_FALSE(blocks(before, 1, lit.error, sphere, true, counts));
    }
}

// The same on an ellipsoid, and on the sphere at the other end of random chords.
TEST(BadCases, ALightOnTheLitEllipsoidIsNotBlockedByIt) {
    constexpr unsigned kSeed = 11;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed, Coordinates::kDouble);
    const Ellipsoid ellipsoid{{3, 1, -2}, {{{2, 0, 0}, {0, 0.5, 0}, {0, 0, -1}}}, 1};
    StageCounts counts;
    int lit_points = 0;
    for (int i = 0; i < 2000; ++i) {
        const ExactRay ray(Ray{{0, 3, 9}, Point3{3, 1, -2} + random.unit() - Point3{0, 3, 9}});
        const auto found = hit(ray, ellipsoid, counts);
        if (!found) continue;
        ++lit_points;
        const SurfacePoint lit = surface_point(ray, ellipsoid, found->which);
        const Point3 lights[] = {{5, 1, -2}, {1, 1, -2}, {3, 1.5, -2}, {3, 1, -1}};
        for (const Point3& light : lights) {
            const ExactRay shadow = ExactRay::between(lit.point, light);
            EXPECT_FALSE(blocks(shadow, 1, lit.error, ellipsoid, true, counts)) << i;
        }
    }
    EXPECT_GT(lit_points, 500);
}

// Beyond some 1e15 scene widths one rounded step ends far from the root, and the path from there
// strayed from the ray by more than the margin.
TEST(BadCases, AnOriginThatIsVeryFarAwayMissesNothing) {
    Scene scene;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) add(scene, Sphere{{x * 1.0, y * 1.0, z * 1.0}, 0.125});
    Profile profile = exact_profile();
    profile.max_objects = 1;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    std::vector<Ray> rays;
    for (const Vector3& d :
         {Vector3{-0x1.8p+107, -0x1p+103, 0x1.5p+107}, Vector3{-0x1p+112, -0x1p+111, 0x1.ap+112},
          Vector3{0x1.bp+106, -0x1.8p+104, -0x1p+106}, Vector3{0x1p+200, 0x1.1p+200, 0x1.3p+199},
          Vector3{0x1.3p+100, 0x1.7p+100, 0x1.fp+100}, Vector3{0x1.1p+64, 0x1.9p+65, 0x1.3p+60}})
        rays.push_back({-d, d});
    const auto found = closest_hits(scene, primitives, &octree, profile, rays);
    const auto expected = closest_hits(scene, primitives, nullptr, profile, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_TRUE(expected[i].hit);  // at least the sphere in the middle
        EXPECT_EQ(found[i].shape, expected[i].shape) << i;
        EXPECT_EQ(found[i].t, expected[i].t) << i;
    }
}

}  // namespace
}  // namespace nuvo::hard
