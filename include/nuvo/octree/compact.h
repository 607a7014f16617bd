#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "nuvo/math/bounds.h"

namespace nuvo {

/// The box of one octant of a voxel that is cut by the planes x, y, z = cut; octant bits: 1 upper
/// x, 2 upper y, 4 upper z.
template <typename Cut>
Bounds3T<float> octant_box(const Bounds3T<float>& voxel, const Cut& cut, unsigned octant) {
    Bounds3T<float> box = voxel;
    for (int axis = 0; axis < 3; ++axis)
        ((octant >> axis & 1U) != 0 ? box.min : box.max)[axis] = cut[axis];
    return box;
}

/// One node of a CompactOctree in 16 bytes: an interior node with its cut and the non-empty of its
/// children, or a leaf with its run of items.
struct CompactNode {
    float cut[3] = {};           ///< interior: the planes x, y, z = cut; leaf: two integers
    std::uint32_t children = 0;  ///< place of the first child << 8 | mask of non-empty octants

    static constexpr std::uint32_t kMaxNodes = 1U << 24;  ///< what the place of a child can name

    static CompactNode leaf(std::uint32_t first, std::uint32_t count) {
        return {{std::bit_cast<float>(first), std::bit_cast<float>(count), 0}, 0};
    }
    bool is_leaf() const { return (children & 0xff) == 0; }
    /// Bit o is set where octant o holds items.
    std::uint32_t mask() const { return children & 0xff; }
    std::uint32_t first_child() const { return children >> 8; }
    /// The place of a non-empty octant's node.
    std::uint32_t child(unsigned octant) const {
        return first_child() +
               static_cast<std::uint32_t>(std::popcount(mask() & ((1U << octant) - 1)));
    }
    /// Calls use(its node's place, its box) for each non-empty octant.
    template <typename Use>
    void for_each_child(const Bounds3T<float>& voxel, Use&& use) const {
        for (unsigned octant = 0; octant < 8; ++octant)
            if ((mask() >> octant & 1) != 0) use(child(octant), octant_box(voxel, cut, octant));
    }
    std::uint32_t first_item() const { return std::bit_cast<std::uint32_t>(cut[0]); }
    std::uint32_t item_count() const { return std::bit_cast<std::uint32_t>(cut[1]); }
};
static_assert(sizeof(CompactNode) == 16);

/// Where a voxel is cut: through its centre, or on each axis where the surface area heuristic of
/// the two sides is least.
enum class CutRule : std::uint8_t { kSpatial, kSweep };

/// An octree for tracing: nothing but cuts and non-empty children, node 0 the root, the children of
/// a node side by side in octant order. A voxel is known on the way down only: `bounds` cut by the
/// planes of its ancestors. An item is listed in every leaf whose closed voxel it touches.
struct CompactOctree {
    static constexpr int kMaxDepth = 48;                    ///< levels, the root's included
    static constexpr int kMostWaiting = 7 * kMaxDepth + 1;  ///< voxels on the stack of a walk

    CutRule rule = CutRule::kSpatial;  ///< by which it was cut
    Bounds3T<float> bounds;
    std::vector<CompactNode> nodes;
    std::vector<std::uint32_t> items;  ///< of the leaves' runs; each run ascends

    int depth() const;               ///< levels that there are, the root's included
    std::size_t leaf_count() const;  ///< non-empty voxels
    /// Bytes of nodes and references.
    std::size_t memory_bytes() const {
        return nodes.size() * sizeof(CompactNode) + items.size() * sizeof(std::uint32_t);
    }
};

}  // namespace nuvo
