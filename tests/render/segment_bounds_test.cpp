#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fast/shadow/segment_walk.h"
#include "leaf_boxes.h"
#include "property/test_scenes.h"
#include "real_numbers.h"

// Single rays at voxels and boxes that they touch in a point, or pass by less than roundings,
// against 60 digits.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261181;

/// A ray to a point, given by its direction or by a light beyond the point.
struct Aimed {
    Vec3<Real> origin, direction;  // true ones
    std::optional<ExactRay> ray;
    double end;

    /// At `target`, which is met at about t = 1.
    Aimed(std::mt19937_64& random, const Point3& target, double far) {
        Vector3 way = uniform_point(random, 1) * far;
        if (random() % 3 == 0) way[static_cast<int>(random() % 3)] = 0;
        if (random() % 6 == 0) {
            const int kept = static_cast<int>(random() % 3);
            for (int axis = 0; axis < 3; ++axis)
                if (axis != kept) way[axis] = 0;
        }
        const Point3 from = target - way;
        if (random() % 2 != 0) {
            ray.emplace(Ray{from, way});
            direction = Vec3<Real>(way);
            end = random() % 2 != 0 ? kInfinity : 1;
        } else {
            // To a light: the way is the exact difference.
            const Point3 light = from + way * std::exp2(uniform(random, -1, 3));
            if (light == from) return;
            ray.emplace(ExactRay::between(from, light));
            direction = Vec3<Real>(light) - Vec3<Real>(from);
            end = 1;
        }
        origin = Vec3<Real>(from);
    }

    /// By how much of t the ray is within the box at most; negative: it passes it by as much.
    Real within(const Vec3<Real>& low, const Vec3<Real>& high) const {
        Real first = 0, last = end == kInfinity ? Real(1e30) : Real(end);
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0) {
                if (origin[axis] < low[axis] || origin[axis] > high[axis]) return -1;
                continue;
            }
            Real a = (low[axis] - origin[axis]) / direction[axis];
            Real b = (high[axis] - origin[axis]) / direction[axis];
            if (a > b) std::swap(a, b);
            first = std::max(first, a);
            last = std::min(last, b);
        }
        return last - first;
    }
};

TEST(SegmentBounds, MeetEveryVoxelThatTheRayTouches) {
    std::mt19937_64 random(kSeed);
    int touched = 0, passed = 0, missed = 0;
    for (int round = 0; round < 6000; ++round) {
        const double world = std::exp2(uniform(random, -10, 10));
        const LocalFrame frame{uniform_point(random, 3 * world),
                               std::exp2(-std::ceil(std::log2(world))), 0.25};
        CompactOctree octree;
        octree.nodes.push_back({});
        for (int axis = 0; axis < 3; ++axis) {
            octree.bounds.min[axis] = static_cast<float>(uniform(random, -1, 0));
            octree.bounds.max[axis] = static_cast<float>(uniform(random, 0.25, 1));
            octree.nodes[0].cut[axis] =
                random() % 4 == 0 ? 0 : static_cast<float>(uniform(random, 0, 0.25));
        }
        octree.nodes[0].children = 1 << 8 | 0xff;
        for (std::uint32_t o = 0; o < 8; ++o) {
            octree.nodes.push_back(CompactNode::leaf(o, 1));
            octree.items.push_back(o);
        }
        Bounds3T<float> voxel[8];
        for (unsigned o = 0; o < 8; ++o) {
            voxel[o] = octree.bounds;
            for (int axis = 0; axis < 3; ++axis)
                ((o >> axis & 1) != 0 ? voxel[o].min : voxel[o].max)[axis] =
                    octree.nodes[0].cut[axis];
        }
        // A corner of a voxel, or a point of an edge.
        const Bounds3T<float>& of = voxel[random() % 8];
        Point3 target;
        for (int axis = 0; axis < 3; ++axis)
            target[axis] = static_cast<double>((random() % 2 != 0 ? of.min : of.max)[axis]);
        if (random() % 2 != 0) target.x = uniform(random, -0.2, 0.3);
        const Point3 in_world = target * (1 / frame.scale) + frame.center;
        const Aimed aimed(random, in_world, std::exp2(uniform(random, -6, 8)) / frame.scale);
        if (!aimed.ray) continue;
        unsigned met = 0;
        SegmentWalk(*aimed.ray, aimed.end, frame)
            .any(octree, [&](const std::uint32_t* items, std::uint32_t) {
                met |= 1U << *items;
                return false;
            });
        for (unsigned o = 0; o < 8; ++o) {
            Vec3<Real> low, high;
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = Real(voxel[o].min[axis]) / frame.scale + Real(frame.center[axis]);
                high[axis] = Real(voxel[o].max[axis]) / frame.scale + Real(frame.center[axis]);
            }
            const Real within = aimed.within(low, high);
            const bool is_met = (met >> o & 1) != 0;
            if (within >= 0) {
                ++touched;
                ASSERT_TRUE(is_met) << "seed " << kSeed << ", round " << round << ", voxel " << o;
            } else {
                ++missed;
                passed += is_met;
            }
        }
    }
    EXPECT_GT(touched, 10'000);
    EXPECT_GT(missed, 30'000);
    EXPECT_LT(passed, 4350);
}

TEST(SegmentBounds, MeetEveryBoxThatTheRayTouches) {
    std::mt19937_64 random(kSeed + 1);
    int touched = 0, missed = 0, passed = 0;
    for (int round = 0; round < 30'000; ++round) {
        const double far = std::exp2(uniform(random, -6, 30));
        Bounds3 box;
        const Point3 middle = uniform_point(random, 10);
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = middle[axis] - std::exp2(uniform(random, -20, 1));
            box.max[axis] = middle[axis] + std::exp2(uniform(random, -20, 1));
        }
        Point3 target;
        for (int axis = 0; axis < 3; ++axis)
            target[axis] = (random() % 2 != 0 ? box.min : box.max)[axis];
        if (random() % 2 != 0) target.y = middle.y;
        const Aimed aimed(random, target, far);
        if (!aimed.ray) continue;
        const Real within = aimed.within(Vec3<Real>(box.min), Vec3<Real>(box.max));
        const bool is_met = !Slabs(*aimed.ray).surely_missed(box, aimed.end);
        if (within >= 0) {
            ++touched;
            ASSERT_TRUE(is_met) << "seed " << kSeed + 1 << ", round " << round;
        } else {
            ++missed;
            passed += is_met;
        }
    }
    EXPECT_GT(touched, 5000);
    EXPECT_GT(missed, 10'000);
    EXPECT_LT(passed, 7150);
}

}  // namespace
}  // namespace nuvo::testing
