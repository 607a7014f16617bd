#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "nuvo/math/bounds.h"
#include "nuvo/math/progress.h"
#include "nuvo/octree/compact.h"

namespace nuvo {

/// A voxel and the planes that cut it. Where a plane is the voxel's upper face the axis is not cut:
/// the upper octants of that axis stay empty, and the lower ones are as wide as the voxel.
struct CutVoxel {
    Bounds3T<float> bounds;
    Vec3<float> cut;
};

/// Clears in masks[i] the octants (bits as in CompactNode) in whose closed box item items[i] surely
/// has no point. Called for all items of a voxel or many of them at once, so that it can work in
/// vectors, and by several threads at a time.
using OctantTest = std::function<void(const CutVoxel& voxel, std::span<const std::uint32_t> items,
                                      std::span<std::uint8_t> masks)>;

/// Prices in units of one primitive test, measured on whole frames.
struct CompactCosts {
    double interior = 8;  ///< a step through a node's children
    double leaf = 2;      ///< reaching a leaf
    /// The width of the beams for which the tree is built, as a share of the widest side: a beam
    /// meets a voxel as often as a line meets one wider by this. 16 of 1080 pixels of a scene that
    /// fills the picture, or less; less in proportion where items stand closer than on the whole.
    double beam = 0.01;
};

struct CompactBuildOptions {
    /// None: through centres, unless the sweep lists items much more seldom in a part of the scene.
    std::optional<CutRule> rule = CutRule::kSpatial;
    CompactCosts costs;
    OctantTest overlaps;  ///< empty: the boxes decide everywhere
    int threads = 1;      ///< >= 1; the tree does not depend on it
    /// What the tree may hold for each item, but `free_references` in any case; a voxel's share is
    /// in proportion to its items.
    double max_references_per_item = 8;
    double free_references = 0x1p21;  ///< 8 megabytes
    Progress* progress = nullptr;
};

/// The octree of the items with these boxes (none empty; all together 2^-30 to 2^30 wide, best 1
/// around 0, where floats are densest); an item is its index. Each leaf lists every item whose box
/// touches the closed voxel and which `overlaps` does not exclude; that is asked where the boxes of
/// a voxel's items touch more than half of its octants on average, or of many items a quarter.
/// O(n log n) but for items that cuts do not part.
CompactOctree build_compact_octree(std::span<const Bounds3T<float>> boxes,
                                   const CompactBuildOptions& options);

}  // namespace nuvo
