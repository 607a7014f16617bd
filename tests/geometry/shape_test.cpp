// Bounds that contain their shapes, and the exact test for area zero.
#include "nuvo/geometry/shape.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace nuvo {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr double kHuge = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

TEST(Bounds, OfASphereAreExactWhereItsFacesAreDoubles) {
    EXPECT_EQ((Sphere{{1, -2, 0.5}, 4}.bounds()), (Bounds3{{-3, -6, -3.5}, {5, 2, 4.5}}));
}

TEST(Bounds, OfASphereContainItAndAreTight) {
    const std::uint64_t seed = 20;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> exponent(-40, 40);
    std::uniform_real_distribution<double> sign(-1, 1);
    for (int i = 0; i < 20000; ++i) {
        const double size = std::exp2(exponent(random));
        const double c = std::copysign(size, sign(random));
        const double r = std::exp2(exponent(random));
        const Bounds3 box = Sphere{{c, 0, 0}, r}.bounds();
        const Rational low = Rational(c) - Rational(r);
        const Rational high = Rational(c) + Rational(r);
        ASSERT_LE(Rational(box.min.x), low) << "seed " << seed << " case " << i;
        ASSERT_GE(Rational(box.max.x), high) << "seed " << seed << " case " << i;
        // The next double inwards would cut the sphere.
        ASSERT_GT(Rational(std::nextafter(box.min.x, kHuge)), low);
        ASSERT_LT(Rational(std::nextafter(box.max.x, -kHuge)), high);
    }
}

TEST(Bounds, OfAnEllipsoidReachItsHalfExtents) {
    // Rows (3, 4, 0), (0, 0, 2), (1, 2, 2): lengths 5, 2, 3.
    const Ellipsoid ellipsoid{{10, 20, 30}, {{{3, 4, 0}, {0, 0, 2}, {1, 2, 2}}}, 2};
    const Bounds3 box = ellipsoid.bounds();
    const double expected[3][2] = {{0, 20}, {16, 24}, {24, 36}};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.min[axis], expected[axis][0]);
        EXPECT_GE(box.max[axis], expected[axis][1]);
        EXPECT_NEAR(box.min[axis], expected[axis][0], 1e-13);
        EXPECT_NEAR(box.max[axis], expected[axis][1], 1e-13);
    }
}

TEST(Bounds, OfAnEllipsoidContainIt) {
    const std::uint64_t seed = 21;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> value(-3, 3);
    std::uniform_real_distribution<double> exponent(-500, 500);
    for (int i = 0; i < 5000; ++i) {
        const double scale = std::exp2(exponent(random));
        Ellipsoid e;
        for (Vector3& row : e.linear.row)
            row = Vector3{value(random), value(random), value(random)} * scale;
        e.radius = std::fabs(value(random));
        const Bounds3 box = e.bounds();
        for (int axis = 0; axis < 3; ++axis) {
            // reach^2 >= radius^2 |row|^2, in rational arithmetic.
            const Vector3& row = e.linear.row[axis];
            const Rational squares = Rational(row.x) * Rational(row.x) +
                                     Rational(row.y) * Rational(row.y) +
                                     Rational(row.z) * Rational(row.z);
            const Rational reach(box.max[axis]);
            ASSERT_GE(reach * reach, Rational(e.radius) * Rational(e.radius) * squares)
                << "seed " << seed << " case " << i;
            ASSERT_EQ(box.min[axis], -box.max[axis]);
        }
    }
}

TEST(Bounds, OfAMeshCoverItsTrianglesOnly) {
    TriangleMesh mesh;
    mesh.positions = {{9, 9, 9}, {0, 1, 2}, {-1, 5, 2}, {3, 1, 2}};
    mesh.triangles = {{1, 2, 3}};
    EXPECT_EQ(mesh.bounds(), (Bounds3{{-1, 1, 2}, {3, 5, 2}}));
    EXPECT_EQ(bounds(Shape{mesh}), mesh.bounds());
    EXPECT_EQ(bounds(Shape{Sphere{{0, 0, 0}, 2}}), (Bounds3{{-2, -2, -2}, {2, 2, 2}}));
    EXPECT_TRUE(TriangleMesh{}.bounds().empty());
}

TEST(ZeroArea, IsExactOnHandMadeTriangles) {
    EXPECT_FALSE(has_zero_area({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(has_zero_area({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(has_zero_area({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}));
    EXPECT_TRUE(has_zero_area({{0, 0, 0}, {1, 2, 3}, {-2, -4, -6}}));
    // On one line only if decimal fractions were exact.
    EXPECT_FALSE(has_zero_area({{0, 0, 0}, {0.1, 0.3, 0}, {0.2, 0.6000000000000001, 0}}));
    EXPECT_TRUE(has_zero_area({{0, 0, 0}, {0.1, 0.3, 0}, {0.2, 0.6, 0}}));
    EXPECT_FALSE(has_zero_area({{0, 0, 0}, {0.1, 0.3, 0}, {0.3, 0.9, 0}}));
}

TEST(ZeroArea, SeesOneUnitInTheLastPlace) {
    const double above = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(has_zero_area({{-1, -1, -1}, {1, 1, 1}, {1e10, 1e10, 1e10}}));
    EXPECT_FALSE(has_zero_area({{-1, -1, -1}, {above, 1, 1}, {1e10, 1e10, 1e10}}));
    EXPECT_FALSE(has_zero_area({{1e-300, 0, 0}, {1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}}));
}

TEST(ZeroArea, NeitherOverflowsNorUnderflows) {
    EXPECT_FALSE(has_zero_area({{0, 0, 0}, {kTiny, 0, 0}, {0, kTiny, 0}}));
    EXPECT_TRUE(has_zero_area({{0, 0, 0}, {kTiny, kTiny, 0}, {2 * kTiny, 2 * kTiny, 0}}));
    EXPECT_FALSE(has_zero_area({{-kHuge, -kHuge, 0}, {kHuge, -kHuge, 0}, {0, kHuge, 0}}));
    EXPECT_TRUE(has_zero_area({{-kHuge, -kHuge, 0}, {kHuge, kHuge, 0}, {0, 0, 0}}));
    EXPECT_FALSE(has_zero_area({{-kHuge, -kHuge, 0}, {kHuge, kHuge, 0}, {0, kTiny, 0}}));
    EXPECT_FALSE(has_zero_area({{0, 0, kHuge}, {kTiny, 0, kHuge}, {0, kTiny, kHuge}}));
}

bool exactly_zero(const Triangle& t) {
    const auto minor = [&](int i, int j) {
        const Rational p =
            (Rational(t.b[i]) - Rational(t.a[i])) * (Rational(t.c[j]) - Rational(t.a[j]));
        const Rational q =
            (Rational(t.b[j]) - Rational(t.a[j])) * (Rational(t.c[i]) - Rational(t.a[i]));
        return p == q;
    };
    return minor(0, 1) && minor(1, 2) && minor(2, 0);
}

TEST(ZeroArea, AgreesWithRationalArithmetic) {
    const std::uint64_t seed = 22;
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> small(-4, 4);
    std::uniform_int_distribution<int> nudge(0, 20);
    std::uniform_real_distribution<double> exponent(-60, 60);
    int zeros = 0;
    for (int i = 0; i < 30000; ++i) {
        // Points on one line, some moved by a unit in the last place, at many scales.
        const double scale = std::exp2(std::floor(exponent(random))) * (i % 3 == 0 ? 0.1 : 1);
        const Vector3 along{1.0 * small(random), 1.0 * small(random), 1.0 * small(random)};
        const Vector3 offset{1.0 * small(random), 1.0 * small(random), 1.0 * small(random)};
        Point3 corners[3];
        for (Point3& p : corners) {
            p = (offset + along * small(random)) * scale;
            if (nudge(random) == 0) p.x = std::nextafter(p.x, kHuge);
        }
        const Triangle triangle{corners[0], corners[1], corners[2]};
        const bool expected = exactly_zero(triangle);
        zeros += expected;
        ASSERT_EQ(has_zero_area(triangle), expected) << "seed " << seed << " case " << i;
    }
    // Both answers were asked for, often.
    EXPECT_GT(zeros, 5000);
    EXPECT_LT(zeros, 28000);
}

}  // namespace
}  // namespace nuvo
