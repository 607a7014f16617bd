#include <gtest/gtest.h>

#include "nuvo/geometry/predicates.h"
#include "random.h"

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

}  // namespace
}  // namespace nuvo::hard
