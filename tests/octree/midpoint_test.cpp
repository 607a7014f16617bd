#include "nuvo/octree/midpoint.h"

#include <gtest/gtest.h>

#include <random>

namespace nuvo {
namespace {

std::vector<Bounds3> points(std::initializer_list<Point3> places) {
    std::vector<Bounds3> boxes;
    for (const Point3& p : places) boxes.push_back({p, p});
    return boxes;
}

std::vector<Bounds3> random_boxes(unsigned seed, std::size_t count, const Bounds3& room) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0.05, 0.95);
    std::uniform_real_distribution<double> size(0, 0.05);
    std::vector<Bounds3> boxes;
    const Vector3 w = room.widths();
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 p = room.min + w * Vector3{place(random), place(random), place(random)};
        boxes.push_back(Bounds3{p, p}.extended(p + w * size(random)));
    }
    return boxes;
}

TEST(ObjectMedian, IsTheMiddleCentreOrTheMeanOfTheMiddleTwo) {
    const auto odd = points({{5, 0, 0}, {1, 0, 0}, {2, 0, 0}});
    EXPECT_EQ(object_median(odd, 0), 2);
    const auto even = points({{5, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    EXPECT_EQ(object_median(even, 0), 2.5);
}

// The thesis' two-dimensional example, eq. 20 and 21: at A two diamonds lie to the left and one to
// the right on both axes. On z all three span every plane, which makes that factor 3.
TEST(MidpointScore, GivesTheValuesOfTheThesisExample) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {1, 1, 1}});
    const std::vector<Bounds3> boxes{{{0.1, 0.1, 0}, {0.1, 0.1, 1}},
                                     {{0.4, 0.3, 0}, {0.4, 0.3, 1}},
                                     {{0.8, 0.9, 0}, {0.8, 0.9, 1}}};
    const MidpointScore score({voxel, boxes});
    EXPECT_NEAR(score.product({0.5, 0.375, 0.5}), 3 * 2.0625, 1e-12);
    EXPECT_NEAR(score.product({0.25, 0.475, 0.5}), 3 * 2.58125, 1e-12);
}

TEST(AxisEdges, CountsSpanningBoxesOnBothSidesAndTouchingOnesOnNone) {
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}};
    const AxisEdges edges(boxes, 0);
    EXPECT_EQ(edges.left_of(1), 1U);
    EXPECT_EQ(edges.right_of(1), 2U);
    EXPECT_EQ(edges.left_of(2), 1U);   // the second begins at 2, not below it
    EXPECT_EQ(edges.right_of(2), 1U);  // the first ends at 2, not above it
}

// Eq. 16 by hand: on x 2 * 1 + (10 - 2) * 2, on y 5 * 2 + (10 - 5) * 2, on z 9 * 2 + 1 * 0.
TEST(MidpointScore, SumsTheAxesInSceneUnits) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {10, 10, 10}});
    const std::vector<Bounds3> boxes{{{1, 0, 0}, {3, 10, 1}}, {{4, 0, 0}, {5, 10, 8}}};
    EXPECT_EQ(MidpointScore({voxel, boxes}).sum({2, 5, 9}), 18 + 20 + 18);
}

Point3 mean_center(const std::vector<Bounds3>& boxes) {
    Point3 sum;
    for (const Bounds3& box : boxes) sum += box.center();
    return sum / static_cast<double>(boxes.size());
}

TEST(PublishedMidpoint, StaysBetweenMeanAndMidpointAndIsDeterministic) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {8, 4, 2}});
    const auto boxes = random_boxes(7, 200, {{0, 0, 0}, {3, 3, 1.5}});
    const SplitQuery query{voxel, boxes};
    const auto midpoint = published_midpoint(query);
    ASSERT_TRUE(midpoint);
    const Point3 mean = mean_center(boxes);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE((*midpoint)[axis], std::min(mean[axis], voxel.midpoint[axis]) - 1e-6);
        EXPECT_LE((*midpoint)[axis], std::max(mean[axis], voxel.midpoint[axis]) + 1e-6);
    }
    EXPECT_EQ(published_midpoint(query), midpoint);
    const MidpointScore score(query);
    EXPECT_LE(score.sum(*midpoint), score.sum(mean) * (1 + 1e-6));  // where the search starts
    // The voxel's own midpoint is an end of the search, not its centre.
    const Voxel off{voxel.bounds, {2, 1, 0.5}};
    const auto other = published_midpoint({off, boxes});
    ASSERT_TRUE(other);
    EXPECT_LE(other->x, 2.1);
}

TEST(PublishedMidpoint, DoesNotCutWhereTheSearchComesWithinATenthOfAFace) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {4, 4, 4}});
    EXPECT_FALSE(published_midpoint({voxel, points({{3.95, 2, 2}})}));
    EXPECT_FALSE(published_midpoint({voxel, points({{2, -2, 2}})}));  // clamped to the face
    EXPECT_FALSE(published_midpoint({voxel, {}}));
    EXPECT_TRUE(published_midpoint({voxel, points({{3.85, 3, 3}})}));
    // So no voxel narrower than 0.2 is cut.
    const Voxel thin = Voxel::centered({{0, 0, 0}, {4, 4, 0.19}});
    EXPECT_FALSE(published_midpoint({thin, points({{3, 3, 0.095}})}));
}

TEST(PublishedMidpoint, TakesTheUpperCornerOfAThinBoxInALargeVoxelOnly) {
    // x and z agree: nothing to search between.
    const auto boxes = points({{2.5, 3, 2}, {1.5, 3, 2}});
    const Voxel large = Voxel::centered({{0, 0, 0}, {4, 4, 4}});
    EXPECT_EQ(published_midpoint({large, boxes}), (Point3{2, 3, 2}));
    const Voxel small = Voxel::centered({{1, 1, 1}, {3, 3.5, 3}});  // half as wide as 1
    EXPECT_FALSE(published_midpoint({small, boxes}));
}

// Brute force over a fine grid of planes, with areas and counts written out.
void expect_least_cost(unsigned seed, const Bounds3& room, std::size_t count) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Voxel voxel = Voxel::centered(room);
    const auto boxes = random_boxes(seed, count, room);
    const auto midpoint = sweep_midpoint({voxel, boxes, 0x1p-40});
    ASSERT_TRUE(midpoint);
    for (int axis = 0; axis < 3; ++axis) {
        const auto cost = [&](double plane) {
            Bounds3 left = room;
            Bounds3 right = room;
            left.max[axis] = plane;
            right.min[axis] = plane;
            double left_count = 0;
            double right_count = 0;
            for (const Bounds3& box : boxes) {
                left_count += box.min[axis] < plane;
                right_count += box.max[axis] > plane;
            }
            return left.surface_area() * left_count + right.surface_area() * right_count;
        };
        const double found = cost((*midpoint)[axis]);
        for (int i = 1; i < 2000; ++i)
            ASSERT_LE(found, cost(room.min[axis] + room.widths()[axis] * i / 2000) * (1 + 1e-9));
    }
}

TEST(Sweep, FindsTheLeastCostOfAllPlanesOfAFineGrid) {
    for (unsigned seed = 40; seed < 48; ++seed) {
        expect_least_cost(seed, {{0, 0, 0}, {3, 2, 1}}, 30);
        expect_least_cost(seed, {{-1, 2, -9}, {19, 3, -2}}, 6);
        expect_least_cost(seed, {{0, 0, 0}, {1, 9, 30}}, 6);
    }
}

TEST(Sweep, StandsClearOfTheEdgesItChooses) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {10, 10, 10}});
    const std::vector<Bounds3> boxes{{{1, 1, 1}, {2, 2, 2}}, {{8, 8, 8}, {9, 9, 9}}};
    const double margin = 0x1p-30;
    const auto midpoint = sweep_midpoint({voxel, boxes, margin});
    ASSERT_TRUE(midpoint);
    for (const Bounds3& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(std::abs((*midpoint)[axis] - box.min[axis]), 2 * margin);
            EXPECT_GT(std::abs((*midpoint)[axis] - box.max[axis]), 2 * margin);
        }
}

}  // namespace
}  // namespace nuvo
