#include "nuvo/octree/voxel.h"

#include <gtest/gtest.h>

#include <random>

namespace nuvo {
namespace {

// The assignment's worked example: the octants of ((0,0,0), 2).
TEST(Voxel, OctantsOfTheAssignmentsExample) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {2, 2, 2}});
    const Point3 corners[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    for (int octant = 0; octant < 8; ++octant) {
        const Bounds3 box = voxel.octant(octant_digit(octant));
        EXPECT_EQ(box.min, corners[octant]) << octant;
        EXPECT_EQ(box.widths(), (Vector3{1, 1, 1})) << octant;
    }
}

TEST(Voxel, WidthsAreThoseOfFigure16) {
    const Voxel voxel{{{0, 0, 0}, {10, 10, 10}}, {2, 3, 4}};
    EXPECT_EQ(voxel.positive_width(), (Vector3{8, 7, 6}));
    EXPECT_EQ(voxel.negative_width(), (Vector3{2, 3, 4}));
}

TEST(Voxel, PointsOnFacesBelongBelowLeftAndFront) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {2, 2, 2}});
    EXPECT_TRUE(voxel.contains({0, 0, 0}));
    EXPECT_FALSE(voxel.contains({2, 1, 1}));
    EXPECT_FALSE(voxel.contains({1, 2, 1}));
    EXPECT_FALSE(voxel.contains({1, 1, 2}));
    EXPECT_EQ(voxel.octant_of({1, 1, 1}), octant_digit(7));
    EXPECT_EQ(voxel.octant_of({0.5, 1, 0.5}), octant_digit(2));
}

TEST(Voxel, OctantsTileTheParentExactly) {
    const unsigned seed = 20181;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1e3, 1e3);
    for (int n = 0; n < 1000; ++n) {
        Bounds3 box;
        for (int i = 0; i < 2; ++i)
            box = box.extended({place(random), place(random), place(random)});
        std::uniform_real_distribution<double> part(0.01, 0.99);
        const Vector3 w = box.widths();
        const Voxel voxel{
            box, box.min + Vector3{w.x * part(random), w.y * part(random), w.z * part(random)}};
        for (int digit = 1; digit <= 8; ++digit) {
            const Bounds3 octant = voxel.octant(digit);
            for (int axis = 0; axis < 3; ++axis) {
                const bool upper = (octant_bits(digit) >> axis & 1) != 0;
                EXPECT_EQ(octant.min[axis], upper ? voxel.midpoint[axis] : box.min[axis]);
                EXPECT_EQ(octant.max[axis], upper ? box.max[axis] : voxel.midpoint[axis]);
            }
        }
        for (int i = 0; i < 20; ++i) {
            const Point3 p =
                box.min + Vector3{w.x * part(random), w.y * part(random), w.z * part(random)};
            int holders = 0;
            for (int digit = 1; digit <= 8; ++digit) {
                const bool holds = Voxel::centered(voxel.octant(digit)).contains(p);
                holders += holds;
                EXPECT_EQ(holds, digit == voxel.octant_of(p));
            }
            EXPECT_EQ(holders, 1);
        }
    }
}

}  // namespace
}  // namespace nuvo
