#include <gtest/gtest.h>

#include <random>
#include <set>

#include "nuvo/octree/build.h"

namespace nuvo {
namespace {

std::set<ItemId> items_below(const Octree& octree, NodeIndex index) {
    const Node& node = octree.nodes()[index];
    const auto own = octree.contents(node);
    std::set<ItemId> all(own.begin(), own.end());
    if (!node.is_leaf())
        for (int digit = 1; digit <= 8; ++digit) all.merge(items_below(octree, node.child(digit)));
    return all;
}

// A plane on a face would be counted on one side and list the item on both.
TEST(Sweep, ReferencesPlacedAreThoseThatItCounted) {
    std::mt19937_64 random(41);
    // Boxes of a lattice: faces touch and coincide.
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 150; ++i) {
        const Point3 p{double(random() % 8), double(random() % 8), double(random() % 8)};
        boxes.push_back({p, p + Vector3{1, 1.0 + double(random() % 2), 1}});
    }
    for (const double margin : {0.0, 0x1p-45}) {
        BuildOptions options;
        options.midpoint = sweep_midpoint;
        options.worth = MaxObjects{2};
        options.margin = margin;
        const Octree octree = build_octree(boxes, options);
        EXPECT_GT(octree.leaf_count(), 50U);
        for (NodeIndex i = 0; i < octree.nodes().size(); ++i) {
            const Node& node = octree.nodes()[i];
            if (node.is_leaf()) continue;
            std::vector<Bounds3> inside;
            for (ItemId id : items_below(octree, i)) inside.push_back(boxes[id].inflated(margin));
            for (int axis = 0; axis < 3; ++axis) {
                const double plane = node.voxel.midpoint[axis];
                if (plane == node.voxel.bounds.max[axis]) continue;  // not cut
                const AxisEdges edges(inside, axis);
                std::set<ItemId> sides[2];
                for (int digit = 1; digit <= 8; ++digit)
                    sides[octant_bits(digit) >> axis & 1].merge(
                        items_below(octree, node.child(digit)));
                EXPECT_EQ(sides[0].size(), edges.left_of(plane)) << node.label << ' ' << axis;
                EXPECT_EQ(sides[1].size(), edges.right_of(plane)) << node.label << ' ' << axis;
            }
        }
    }
}

}  // namespace
}  // namespace nuvo
