#include "nuvo/octree/octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "nuvo/octree/build.h"
#include "octree/random_boxes.h"

namespace nuvo {
namespace {

/// Cut until no leaf holds more than `most`.
Octree cut_octree(const std::vector<Bounds3>& boxes, std::size_t most) {
    BuildOptions options;
    options.worth = MaxObjects{most};
    return build_octree(boxes, options);
}

TEST(Octree, NamesLeadToNodesWithAndWithoutTheirMap) {
    Octree octree = cut_octree(random_boxes(4, 100, 1), 2);
    EXPECT_TRUE(octree.names().empty());
    const std::size_t bytes = octree.memory_bytes();
    octree.make_names();
    EXPECT_GT(octree.memory_bytes(), bytes);
    EXPECT_EQ(octree.names().size(), octree.nodes().size());
    for (const auto& [label, index] : octree.names()) EXPECT_EQ(octree.find_name(label), index);
    for (const Label none : {Label{9}, Label{10}, Label{111111111}, Label{109}})
        EXPECT_FALSE(octree.find_name(none)) << none;
}

TEST(Octree, FindLeafReturnsTheHalfOpenLeaf) {
    const auto boxes = random_boxes(3, 200, 2);
    const Octree octree = cut_octree(boxes, 4);
    std::mt19937_64 random(77);
    std::uniform_real_distribution<double> place(0, 100);
    for (int i = 0; i < 2000; ++i) {
        // Half of the points on stored faces.
        Point3 p{place(random), place(random), place(random)};
        if (i % 2 == 0) p = octree.nodes()[random() % octree.nodes().size()].voxel.bounds.min;
        const auto leaf = octree.find_leaf(p);
        ASSERT_EQ(leaf.has_value(), octree.root().voxel.contains(p));
        if (leaf) {
            EXPECT_TRUE(octree.nodes()[*leaf].is_leaf());
            EXPECT_TRUE(octree.nodes()[*leaf].voxel.contains(p));
        }
    }
}

TEST(Octree, SmallestWidthIsTheNarrowestLeafs) {
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{7, 7, 7}, {8, 16, 32}}};
    const Octree octree = cut_octree(boxes, 1);
    double narrowest = 1e300;
    for (const Node& node : octree.nodes()) {
        const Vector3 w = node.voxel.bounds.widths();
        if (node.is_leaf()) narrowest = std::min({narrowest, w.x, w.y, w.z});
    }
    EXPECT_EQ(octree.smallest_width(), narrowest);
    EXPECT_EQ(octree.smallest_width(), 4);
}

TEST(Octree, NextVoxelPointLiesInTheNextLeafOfTheRay) {
    const auto boxes = random_boxes(3, 100, 2);
    const Octree octree = cut_octree(boxes, 4);
    std::mt19937_64 random(78);
    std::uniform_real_distribution<double> place(1, 99);
    for (int i = 0; i < 1000; ++i) {
        // Along an axis the next leaf is the face neighbour, so the answer is plain to see.
        const Point3 p{place(random), place(random), place(random)};
        const int axis = i % 3;
        Ray ray{p, {}};
        ray.direction[axis] = i % 2 == 0 ? 2.0 : -0.5;
        const Node& leaf = octree.nodes()[*octree.find_leaf(p)];
        const Point3 next = octree.point_next_voxel(ray);
        const double beyond = i % 2 == 0 ? next[axis] - leaf.voxel.bounds.max[axis]
                                         : leaf.voxel.bounds.min[axis] - next[axis];
        EXPECT_GT(beyond, 0);
        EXPECT_LT(beyond, octree.smallest_width());
    }
}

TEST(Octree, PrintsANodeALineIndentedByLevel) {
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{7, 7, 7}, {8, 8, 8}}};
    std::ostringstream text;
    print(text, cut_octree(boxes, 1));
    EXPECT_EQ(text.str().substr(0, text.str().find('\n', text.str().find('\n') + 1)),
              "0 node [0 0 0] [8 8 8] midpoint [4 4 4]\n  1 leaf [0 4 0] [4 8 4] 0 items");
}

}  // namespace
}  // namespace nuvo
