// Fronts alone: literal rays whose answers are plain, and random ones by the sign of n.d.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "nuvo/geometry/predicates.h"

namespace nuvo {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Its front is turned to +z.
const Triangle kTriangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
const Sphere kBall{{0, 0, 0}, 1};
const Ellipsoid kMirrored{{0, 0, 0}, {{{-1, 0, 0}, {0, 2, 0}, {0, 0, 1}}}, 1};

template <typename Primitive>
bool is_hit(const Ray& ray, const Primitive& primitive, Sides sides) {
    StageCounts counts;
    return hit(ExactRay(ray), primitive, counts, sides).has_value();
}
bool triangle_blocks(const Point3& from, const Point3& to, Sides sides) {
    StageCounts counts;
    return blocks(ExactRay::between(from, to), 1, 0, kTriangle, counts, sides);
}
template <typename Round>
bool round_blocks(const Point3& from, const Point3& to, const Round& round, Sides sides,
                  bool on_it = false) {
    StageCounts counts;
    return blocks(ExactRay::between(from, to), 1, 0, round, on_it, counts, sides);
}

TEST(FrontsAlone, AreHitFromTheirSide) {
    EXPECT_TRUE(is_hit({{0, 0, 5}, {0, 0, -1}}, kTriangle, Sides::kFront));
    EXPECT_FALSE(is_hit({{0, 0, -5}, {0, 0, 1}}, kTriangle, Sides::kFront));
    EXPECT_TRUE(is_hit({{0, 0, -5}, {0, 0, 1}}, kTriangle, Sides::kBoth));
    // Through a corner, an edge, and within the plane.
    EXPECT_TRUE(is_hit({{0, 1, 5}, {0, 0, -1}}, kTriangle, Sides::kFront));
    EXPECT_FALSE(is_hit({{0, 1, -5}, {0, 0, 1}}, kTriangle, Sides::kFront));
    EXPECT_TRUE(is_hit({{0, -1, 5}, {0, 0, -1}}, kTriangle, Sides::kFront));
    EXPECT_FALSE(is_hit({{0, -1, -5}, {0, 0, 1}}, kTriangle, Sides::kFront));
    EXPECT_FALSE(is_hit({{-5, 0, 0}, {1, 0, 0}}, kTriangle, Sides::kFront));
}

template <typename Round>
void expect_hit_from_outside(const Round& round) {
    EXPECT_TRUE(is_hit({{0, 0, 5}, {0, 0, -1}}, round, Sides::kFront));
    EXPECT_FALSE(is_hit({{0, 0, 0.5}, {0, 0, -1}}, round, Sides::kFront));
    EXPECT_TRUE(is_hit({{0, 0, 0.5}, {0, 0, -1}}, round, Sides::kBoth));
    EXPECT_FALSE(is_hit({{0, 0, 1}, {0, 0, -1}}, round, Sides::kFront));  // from the surface
    EXPECT_TRUE(is_hit({{0, 0, 1}, {0, 0, -1}}, round, Sides::kBoth));
    EXPECT_TRUE(is_hit({{1, 0, 5}, {0, 0, -1}}, round, Sides::kFront));  // tangent
    EXPECT_FALSE(is_hit({{0, 0, 5}, {0, 0, 1}}, round, Sides::kFront));
}
TEST(FrontsAlone, OfRoundShapesAreHitFromOutside) {
    expect_hit_from_outside(kBall);
    expect_hit_from_outside(kMirrored);
}

// A light sees the front of what the way to it leaves.
TEST(FrontsAlone, BlockTheLightThatSeesThem) {
    EXPECT_TRUE(triangle_blocks({0, 0, -1}, {0, 0, 1}, Sides::kFront));
    EXPECT_FALSE(triangle_blocks({0, 0, 1}, {0, 0, -1}, Sides::kFront));
    EXPECT_TRUE(triangle_blocks({0, 0, 1}, {0, 0, -1}, Sides::kBoth));
    EXPECT_FALSE(triangle_blocks({0, 0, -1}, {0, 0, 0}, Sides::kFront));  // touches the light
}

template <typename Round>
void expect_blocks_outside_lights(const Round& round) {
    const Point3 above{0, 0, 3};
    const Point3 below{0, 0, -3};
    const Point3 within{0, 0, 0.5};
    for (const Sides sides : {Sides::kBoth, Sides::kFront}) {
        EXPECT_TRUE(round_blocks(below, above, round, sides));
        EXPECT_TRUE(round_blocks(within, above, round, sides));
        EXPECT_FALSE(round_blocks(above, {0, 0, 2}, round, sides));
        EXPECT_FALSE(round_blocks(within, {0, 0, -0.5}, round, sides));
        // Tangent: both roots are one.
        EXPECT_TRUE(round_blocks({1, 0, -3}, {1, 0, 3}, round, sides));
        // From the surface itself: inwards and outwards, to lights outside and inside.
        EXPECT_TRUE(round_blocks({0, 0, -1}, above, round, sides, true));
        EXPECT_FALSE(round_blocks({0, 0, 1}, above, round, sides, true));
        EXPECT_FALSE(round_blocks({0, 0, -1}, within, round, sides, true));
        EXPECT_FALSE(round_blocks({0, 0, -1}, {0, 0, 1}, round, sides, true));
    }
    EXPECT_TRUE(round_blocks(below, within, round, Sides::kBoth));
    EXPECT_FALSE(round_blocks(below, within, round, Sides::kFront));
    // A light on the far surface touches that, and sees the near one from within.
    EXPECT_TRUE(round_blocks(below, {0, 0, 1}, round, Sides::kBoth));
    EXPECT_FALSE(round_blocks(below, {0, 0, 1}, round, Sides::kFront));
    StageCounts counts;
    for (const Sides sides : {Sides::kBoth, Sides::kFront})
        EXPECT_TRUE(
            blocks(ExactRay(Ray{below, {0, 0, 1}}), kEndless, 0, round, false, counts, sides));
}
TEST(FrontsAlone, OfRoundShapesBlockLightsOutside) {
    expect_blocks_outside_lights(kBall);
    expect_blocks_outside_lights(kMirrored);
}

// Integer coordinates: n.d is exact in double.
TEST(FrontsAlone, OfRandomTrianglesAreThoseWithANegativeSlope) {
    const unsigned seed = 35;
    std::mt19937 random(seed);
    const auto point = [&] {
        const auto coordinate = [&] {
            return static_cast<double>(static_cast<int>(random() % 9) - 4);
        };
        return Point3{coordinate(), coordinate(), coordinate()};
    };
    int fronts = 0, backs = 0;
    for (int i = 0; i < 200'000; ++i) {
        const Triangle t{point(), point(), point()};
        const Point3 from = point();
        const Point3 to = point();
        const Ray ray{from, to - from};
        if (ray.direction == Vector3{}) continue;
        const double slope = dot(cross(t.b - t.a, t.c - t.a), ray.direction);
        StageCounts counts;
        const ExactRay exact(ray);
        const bool any = hit(exact, t, counts).has_value();
        ASSERT_EQ(hit(exact, t, counts, Sides::kFront).has_value(), any && slope < 0)
            << "seed " << seed << ", triangle " << i;
        const bool in_the_way = blocks(exact, 1, 0, t, counts);
        ASSERT_EQ(blocks(exact, 1, 0, t, counts, Sides::kFront), in_the_way && slope > 0)
            << "seed " << seed << ", triangle " << i;
        (slope < 0 ? fronts : backs) += any ? 1 : 0;
    }
    EXPECT_GT(fronts, 1000);
    EXPECT_GT(backs, 1000);
}

}  // namespace
}  // namespace nuvo
