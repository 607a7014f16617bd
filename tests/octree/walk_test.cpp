#include "nuvo/octree/walk.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <random>
#include <set>

#include "nuvo/octree/build.h"

namespace nuvo {
namespace {

using Rational = boost::multiprecision::cpp_rational;

std::vector<Bounds3> random_boxes(unsigned seed, double scale) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-4, 4);
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 200; ++i) {
        const Point3 p{place(random), place(random), place(random)};
        boxes.push_back({p * scale, (p + Vector3{0.25, 0.25, 0.25}) * scale});
    }
    return boxes;
}

struct Visit {
    Label leaf;
    double exit;
};

std::vector<Visit> walk(const Octree& octree, const Ray& ray) {
    std::vector<Visit> visits;
    ExactWalk<DescentLocator> walk(octree);
    walk(ray, std::numeric_limits<double>::infinity(), [&](const Node& leaf, double exit) {
        visits.push_back({leaf.label, exit});
        return false;
    });
    return visits;
}

// The leaves that the ray meets at more than one point, nearest first, by each leaf's own slabs.
std::vector<Label> met_leaves(const Octree& octree, const Ray& ray) {
    std::vector<std::pair<double, Label>> met;
    for (const Node& node : octree.nodes()) {
        if (!node.is_leaf()) continue;
        double near = 0;
        double far = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (node.voxel.bounds.min[axis] - ray.origin[axis]) / ray.direction[axis];
            const double b = (node.voxel.bounds.max[axis] - ray.origin[axis]) / ray.direction[axis];
            near = std::max(near, std::min(a, b));
            far = std::min(far, std::max(a, b));
        }
        if (near < far) met.emplace_back(near, node.label);
    }
    std::sort(met.begin(), met.end());
    std::vector<Label> labels;
    for (const auto& [near, label] : met) labels.push_back(label);
    return labels;
}

Octree tree_of(double scale) {
    BuildOptions options;
    options.worth = MaxObjects{1};
    return build_octree(random_boxes(5, scale), options);
}

std::vector<Ray> random_rays(int count) {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> place(-5, 5);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({{place(random), place(random), place(random)},
                        {place(random), place(random), place(random)}});
    return rays;
}

TEST(ExactWalk, VisitsTheLeavesThatTheRayMeetsInOrder) {
    const Octree octree = tree_of(1);
    std::size_t all = 0;
    for (const Ray& ray : random_rays(500)) {
        std::vector<Label> visited;
        for (const Visit& visit : walk(octree, ray)) visited.push_back(visit.leaf);
        EXPECT_EQ(visited, met_leaves(octree, ray));
        all += visited.size();
    }
    EXPECT_GT(all, 1000U);
}

TEST(ExactWalk, EndsWhereItIsTold) {
    const Octree octree = tree_of(1);
    const Ray ray{{-9, 0.1, 0.2}, {1, 0.01, 0.02}};
    const std::vector<Visit> visits = walk(octree, ray);
    ASSERT_GT(visits.size(), 4U);
    ExactWalk<DescentLocator> limited(octree);
    std::size_t count = 0;
    limited(ray, visits[2].exit, [&](const Node&, double) { return ++count, false; });
    EXPECT_EQ(count, 3U);
    limited(ray, 1e9, [&](const Node&, double) { return ++count == 5; });
    EXPECT_EQ(count, 5U);
}

// So far away that one step to the root ends far from it.
TEST(ExactWalk, FindsItsWayFromVeryFar) {
    const Octree octree = tree_of(1);
    for (const Vector3& direction :
         {Vector3{1, 0.5, 0.25}, {-0.125, 1, 0.5}, {0.75, -0.5, -1}, {-1, -0.375, 0.625}}) {
        const std::vector<Label> expected = met_leaves(octree, {direction * -16.0, direction});
        EXPECT_GT(expected.size(), 4U);
        for (const int exponent : {60, 120, 500}) {
            const Point3 origin = direction * -std::ldexp(1.0, exponent);
            std::vector<Label> visited;
            for (const Visit& visit : walk(octree, {origin, direction}))
                visited.push_back(visit.leaf);
            EXPECT_EQ(visited, expected) << exponent;
            EXPECT_TRUE(walk(octree, {origin, direction * -1.0}).empty());
        }
    }
}

// Powers of two change no digit, so the walk goes the same way at every size of scene and ray.
TEST(ExactWalk, GoesTheSameWayAtEveryScale) {
    const std::vector<Ray> rays = random_rays(100);
    const Octree plain = tree_of(1);
    for (const auto& [scene, direction] : {std::pair{0, -1000},
                                           {0, 900},
                                           {-700, -500},
                                           {-700, 900},
                                           {700, -700},
                                           {700, 900},
                                           {900, -900},
                                           {-900, -900}}) {
        SCOPED_TRACE("scales " + std::to_string(scene) + " " + std::to_string(direction));
        const Octree scaled = tree_of(std::ldexp(1.0, scene));
        for (const Ray& ray : rays) {
            const std::vector<Visit> expected = walk(plain, ray);
            const std::vector<Visit> visits = walk(
                scaled,
                {ray.origin * std::ldexp(1.0, scene), ray.direction * std::ldexp(1.0, direction)});
            ASSERT_EQ(visits.size(), expected.size());
            for (std::size_t i = 0; i < visits.size(); ++i) {
                EXPECT_EQ(visits[i].leaf, expected[i].leaf);
                const double exit = std::ldexp(expected[i].exit, scene - direction);
                // Never late; where the largest or smallest double ends it, early.
                EXPECT_LE(visits[i].exit, exit + kUnderflow);
                if (exit < 0x1p1000 && exit > 0x1p-1000) {
                    EXPECT_GE(visits[i].exit, exit * (1 - 1e-14));
                }
            }
        }
    }
}

// A ray of any length from any distance towards a point of the scene's box.
Ray ray_of_any_size(std::mt19937_64& random, double scale) {
    std::uniform_real_distribution<double> place(-5, 5);
    std::uniform_int_distribution<int> exponent(-1060, 1000);
    Ray ray;
    const int longest = exponent(random);
    for (int k = 0; k < 3; ++k) {
        const double part = place(random);
        ray.direction[k] = std::ldexp(part, std::min(longest, exponent(random)));
        if (ray.direction[k] == 0) ray.direction[k] = kUnderflow;
    }
    const double back = std::ldexp(1.0, exponent(random) / 2);
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = place(random) * scale - back * ray.direction[k];
        if (!std::isfinite(ray.origin[k])) ray.origin[k] = place(random) * scale;
    }
    return ray;
}

// By the box' own slabs in rational arithmetic, where it is smaller by `margin` all around.
bool surely_meets(const Ray& ray, const Bounds3& box, double margin) {
    Rational near = 0;
    std::optional<Rational> far;
    for (int axis = 0; axis < 3; ++axis) {
        Rational a = (Rational(box.min[axis]) + Rational(margin) - Rational(ray.origin[axis])) /
                     Rational(ray.direction[axis]);
        Rational b = (Rational(box.max[axis]) - Rational(margin) - Rational(ray.origin[axis])) /
                     Rational(ray.direction[axis]);
        if (ray.direction[axis] < 0) std::swap(a, b);
        if (a > near) near = a;
        if (!far || b < *far) far = b;
    }
    return near < *far;
}

void add_surely_met(const Octree& octree, NodeIndex index, const Ray& ray,
                    std::set<Label>& leaves) {
    const Node& node = octree.nodes()[index];
    const double margin = path_error_bound(octree.root().voxel.bounds);
    if (!surely_meets(ray, node.voxel.bounds, margin)) return;
    if (node.is_leaf()) {
        leaves.insert(node.label);
        return;
    }
    for (int digit = 1; digit <= 8; ++digit) add_surely_met(octree, node.child(digit), ray, leaves);
}

TEST(ExactWalk, MissesNoLeafAtAnySizeOfSceneAndRay) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::size_t all = 0;
    for (const int exponent : {0, 300, -300, 900, -570, -900, -1000, 1015, 1020}) {
        const double scale = std::ldexp(1.0, exponent);
        const Octree octree = tree_of(scale);
        for (int i = 0; i < 40; ++i) {
            const Ray ray = ray_of_any_size(random, scale);
            std::set<Label> visited;
            for (const Visit& visit : walk(octree, ray)) visited.insert(visit.leaf);
            std::set<Label> expected;
            add_surely_met(octree, 0, ray, expected);
            all += expected.size();
            EXPECT_TRUE(std::ranges::includes(visited, expected))
                << std::hexfloat << scale << ": " << ray.origin.x << ' ' << ray.origin.y << ' '
                << ray.origin.z << ", " << ray.direction.x << ' ' << ray.direction.y << ' '
                << ray.direction.z;
        }
    }
    EXPECT_GT(all, 100U);
}

}  // namespace
}  // namespace nuvo
