#include "nuvo/octree/compact.h"

#include <gtest/gtest.h>

namespace nuvo {
namespace {

TEST(CompactOctree, CountsItsLevelsAndVoxelsWithItems) {
    CompactOctree octree;
    EXPECT_EQ(octree.depth(), 0);
    EXPECT_EQ(octree.leaf_count(), 0u);
    octree.nodes = {CompactNode::leaf(0, 0)};  // of a scene without items
    EXPECT_EQ(octree.depth(), 1);
    EXPECT_EQ(octree.leaf_count(), 0u);
    // Octants 0 and 7 of the root, of which 7 is cut once more and holds items in its octant 2.
    octree.nodes = {{{0, 0, 0}, 1 << 8 | 0x81},
                    CompactNode::leaf(0, 2),
                    {{1, 1, 1}, 3 << 8 | 0x04},
                    CompactNode::leaf(2, 1)};
    octree.items = {0, 1, 1};
    EXPECT_EQ(octree.depth(), 3);
    EXPECT_EQ(octree.leaf_count(), 2u);
}

}  // namespace
}  // namespace nuvo
