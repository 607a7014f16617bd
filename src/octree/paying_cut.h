#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nuvo/octree/build.h"

namespace nuvo {

/// Octants as bits: bit o for the octant of octant_bits() o.
using OctantMask = std::uint8_t;
/// Items of each octant.
using OctantCounts = std::array<std::uint32_t, 8>;

/// A cut that pays, of a voxel with its items.
struct PayingCut {
    Voxel voxel;  ///< where an axis is not cut, the midpoint lies on the upper face
    std::vector<OctantMask> masks;  ///< octants that each item is listed in
    OctantCounts counts{};
    double saved = 0;  ///< of the sum of eq. 10

    std::size_t references() const;
    /// The items of octant o, in order.
    std::vector<ItemId> items(std::span<const ItemId> of_voxel, unsigned o) const;
};

/// Finds cuts that pay under constant prices, or by COMP1011's rule.
class CutFinder {
  public:
    CutFinder(std::span<const Bounds3> boxes, const BuildOptions& options);

    /// The box of all items.
    Bounds3 root() const { return root_; }
    std::size_t item_count() const { return boxes_.size(); }
    /// The best cut by the strategy's planes, or where they save little by the fallback's: on those
    /// axes that save most together. None where no cut pays.
    std::optional<PayingCut> find(const Voxel& voxel, std::span<const ItemId> items);

  private:
    std::optional<PayingCut> cut_at(const Point3& planes, const Voxel& voxel,
                                    std::span<const ItemId> items) const;
    OctantMask octants_of(ItemId item, const Voxel& cut) const;
    double area(const Bounds3& box) const;
    double cost_after(const Voxel& cut, const OctantCounts& counts, unsigned axes) const;

    const BuildOptions& options_;
    SahCosts costs_;
    bool free_axes_;              // axes may be left out
    std::vector<Bounds3> boxes_;  // inflated
    Bounds3 root_;
    double unit_ = 1;                   // of areas: about the root's width
    std::vector<Bounds3> query_boxes_;  // of the voxel's items
};

}  // namespace nuvo
