#include "nuvo/geometry/overlap.h"

#include <gtest/gtest.h>

#include <random>

namespace nuvo {
namespace {

const Bounds3 kUnit{{0, 0, 0}, {1, 1, 1}};

TEST(TriangleOverlap, TouchingCountsAndPassingByDoesNot) {
    EXPECT_TRUE(overlaps(Triangle{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}, kUnit));     // one corner
    EXPECT_TRUE(overlaps(Triangle{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}}, kUnit));  // covers a face
    EXPECT_TRUE(overlaps(Triangle{{.2, .2, .2}, {.3, .2, .2}, {.2, .3, .2}}, kUnit));  // inside
    // Its box overlaps the cube, but it cuts past the corner (1, 1, 1).
    EXPECT_FALSE(overlaps(Triangle{{3.2, 0, 0}, {0, 3.2, 0}, {0, 0, 3.2}}, kUnit));
    EXPECT_TRUE(overlaps(Triangle{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, kUnit));  // through it
    // Passes the edge x = y = 1: at z = 0 it is at x + y = 2.17, and further out above.
    EXPECT_FALSE(overlaps(Triangle{{1.2, 0.5, -1.5}, {0.5, 1.2, -1.5}, {1.4, 1.4, 2}}, kUnit));
}

TEST(SphereOverlap, IsThatOfTheSurface) {
    EXPECT_TRUE(overlaps(Sphere{{0.5, 0.5, 0.5}, 0.25}, kUnit));  // wholly inside the box
    EXPECT_FALSE(overlaps(Sphere{{0.5, 0.5, 0.5}, 1}, kUnit));    // the box wholly inside it
    EXPECT_TRUE(overlaps(Sphere{{0.5, 0.5, 0.5}, 0.8}, kUnit));   // corners stick out
    EXPECT_TRUE(overlaps(Sphere{{2, 0.5, 0.5}, 1}, kUnit));       // touches a face
    EXPECT_FALSE(overlaps(Sphere{{2, 2, 0.5}, 1.4}, kUnit));      // sqrt 2 away from the edge
}

// A triangle that has a point in the box, found by sampling it, must never be said to be outside.
TEST(TriangleOverlap, NeverDeniesAPointThatIsThere) {
    const unsigned seed = 31;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-2, 3);
    std::uniform_real_distribution<double> part(0, 1);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        Triangle t;
        for (Point3* p : {&t.a, &t.b, &t.c}) *p = {place(random), place(random), place(random)};
        const double u = part(random);
        const double v = part(random) * (1 - u);
        const Point3 p = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
        if (!kUnit.inflated(-0x1p-40).contains(p)) continue;
        ++inside;
        EXPECT_TRUE(overlaps(t, kUnit));
    }
    EXPECT_GT(inside, 50);
}

}  // namespace
}  // namespace nuvo
