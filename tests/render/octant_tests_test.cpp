#include "fast/scene/octant_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "nuvo/geometry/overlap.h"

namespace nuvo {
namespace {

// Octants that share `point`, of a voxel around it or with it on a face.
std::uint8_t octants_at(const CutVoxel& voxel, const Vec3<float>& p) {
    unsigned mask = 0;
    for (unsigned o = 0; o < 8; ++o) {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = (o >> axis & 1U) != 0;
            const float low = upper ? voxel.cut[axis] : voxel.bounds.min[axis];
            const float high = upper ? voxel.bounds.max[axis] : voxel.cut[axis];
            inside &= low <= p[axis] && p[axis] <= high;
        }
        mask |= (inside ? 1U : 0U) << o;
    }
    return static_cast<std::uint8_t>(mask);
}

// A voxel whose coordinates are multiples of 2^-18, and a point of it of the same kind, mostly on
// its planes.
struct VoxelAndPoint {
    explicit VoxelAndPoint(std::mt19937_64& random) {
        constexpr float kGrid = 0x1p-18F;
        const int size = 4 << random() % 14;
        for (int axis = 0; axis < 3; ++axis) {
            const int low = static_cast<int>(random() % 200000) - 100000;
            const int cut = low + 1 + static_cast<int>(random() % static_cast<unsigned>(size));
            const int high = cut + 1 + static_cast<int>(random() % static_cast<unsigned>(size));
            const int inside =
                low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
            const int choices[4] = {low, cut, high, inside};
            voxel.bounds.min[axis] = static_cast<float>(low) * kGrid;
            voxel.cut[axis] = static_cast<float>(cut) * kGrid;
            voxel.bounds.max[axis] = static_cast<float>(high) * kGrid;
            point[axis] = static_cast<float>(choices[random() % 4]) * kGrid;
        }
    }
    CutVoxel voxel;
    Vec3<float> point;
};

// A vector of multiples of 2^-18, each coordinate often 0.
Vec3<float> grid_vector(std::mt19937_64& random, int size) {
    Vec3<float> v;
    for (int axis = 0; axis < 3; ++axis)
        if (random() % 4 != 0)
            v[axis] =
                static_cast<float>(static_cast<int>(random() % (2U * size + 1)) - size) * 0x1p-18F;
    return v;
}

TEST(OctantTests, NeverClearAnOctantThatATriangleTouchesInAPoint) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 20000; ++round) {
        const VoxelAndPoint place(random);
        // The point is a corner, on an edge or inside: all numbers are exact in float.
        const int size = 1 << random() % 16;
        const Vec3<float> a = grid_vector(random, size);
        const Vec3<float> b = grid_vector(random, size);
        const Vec3<float>& p = place.point;
        const Vec3<float> kinds[4][3] = {{p, p + a, p + b},
                                         {p + a, p - a, p + b},
                                         {p + a, p + b, p - a - b},
                                         {p + a, p + a, p - a}};
        std::vector<LocalTriangle> triangles;
        for (const auto& corners : kinds) {
            LocalTriangle t;
            for (int i = 0; i < 9; ++i) t.corner[i] = corners[i / 3][i % 3];
            triangles.push_back(t);
        }
        const std::uint8_t touched = octants_at(place.voxel, p);
        ASSERT_NE(touched, 0);
        const std::vector<std::uint32_t> items{0, 1, 2, 3};
        std::vector<std::uint8_t> masks(4, 0xff);
        clear_octants(triangles, place.voxel, items, masks);
        for (std::size_t i = 0; i < 4; ++i)
            ASSERT_EQ(masks[i] & touched, touched) << "round " << round << " kind " << i;
    }
}

TEST(OctantTests, NeverClearAnOctantThatASphereTouchesInAPoint) {
    std::mt19937_64 random(8);
    for (int round = 0; round < 20000; ++round) {
        const VoxelAndPoint place(random);
        // Pythagorean quadruples reach the point exactly.
        constexpr int kQuadruples[5][4] = {
            {1, 2, 2, 3}, {2, 3, 6, 7}, {0, 3, 4, 5}, {0, 0, 1, 1}, {1, 4, 8, 9}};
        const int(&q)[4] = kQuadruples[random() % 5];
        const float unit = static_cast<float>(1 + random() % 20000) * 0x1p-18F;
        Vec3<float> away;
        for (int axis = 0; axis < 3; ++axis)
            away[axis] = static_cast<float>(q[axis]) * unit * (random() % 2 == 0 ? 1.0F : -1.0F);
        const auto turn = static_cast<int>(random() % 3);
        LocalSphere sphere;
        for (int axis = 0; axis < 3; ++axis)
            sphere.center[axis] = place.point[axis] + away[(axis + turn) % 3];
        sphere.radius = static_cast<float>(q[3]) * unit;
        const std::uint8_t touched = octants_at(place.voxel, place.point);
        const std::vector<LocalSphere> spheres{sphere};
        const std::vector<std::uint32_t> items{5};
        std::vector<std::uint8_t> masks{0xff};
        clear_octants(spheres, 5, place.voxel, items, masks);
        ASSERT_EQ(masks[0] & touched, touched) << "round " << round;
    }
}

// How many octants double arithmetic finds touched and how many are kept, of voxels at a place.
struct Kept {
    std::size_t touching = 0;
    std::size_t kept = 0;
};
Kept kept_at(float scale) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<float> number(-0.5F, 0.5F);
    const auto vector = [&](float size) {
        return Vec3<float>{number(random) * size, number(random) * size, number(random) * size};
    };
    Kept result;
    for (int round = 0; round < 1000; ++round) {
        const float size = scale * std::exp2(8 * number(random) - 6);
        const Vec3<float> p = vector(scale);
        const CutVoxel voxel{{p - Vec3<float>{size, size, size}, p + Vec3<float>{size, size, size}},
                             p + vector(size)};
        std::vector<LocalTriangle> triangles(37);
        std::vector<std::uint32_t> items;
        for (LocalTriangle& t : triangles) {
            items.push_back(static_cast<std::uint32_t>(items.size()));
            for (int i = 0; i < 3; ++i) {
                const Vec3<float> corner = p + vector(4 * size);
                for (int axis = 0; axis < 3; ++axis) t.corner[3 * i + axis] = corner[axis];
            }
        }
        std::vector<std::uint8_t> masks(items.size(), 0xff);
        clear_octants(triangles, voxel, items, masks);
        for (std::size_t i = 0; i < items.size(); ++i)
            for (unsigned o = 0; o < 8; ++o) {
                Bounds3 box{Point3(voxel.bounds.min), Point3(voxel.bounds.max)};
                for (int axis = 0; axis < 3; ++axis)
                    ((o >> axis & 1U) != 0 ? box.min : box.max)[axis] = voxel.cut[axis];
                const auto& c = triangles[i].corner;
                const Triangle t{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
                const bool in_double = overlaps(t, box);
                const bool in_float = (masks[i] >> o & 1U) != 0;
                EXPECT_TRUE(in_float || !in_double);
                result.touching += in_double ? 1 : 0;
                result.kept += in_float ? 1 : 0;
            }
    }
    return result;
}

// Near the frame's origin floats are dense, and what is small there is told apart as well.
TEST(OctantTests, ClearAlmostAllThatTheTestInDoubleClears) {
    for (const float scale : {1.0F, 0x1p-16F, 0x1p-30F}) {
        const Kept of = kept_at(scale);
        EXPECT_GT(of.touching, 50000U);
        EXPECT_LT(static_cast<double>(of.kept), 1.02 * static_cast<double>(of.touching)) << scale;
    }
}

}  // namespace
}  // namespace nuvo
