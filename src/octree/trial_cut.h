#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "nuvo/octree/build.h"

namespace nuvo {

using Items = std::vector<ItemId>;

/// A voxel cut as a trial, and the items of its octants: octant `digit` stands at digit - 1.
struct TrialCut {
    Voxel voxel;
    std::array<Items, 8> octants;

    /// Items listed in all octants together.
    std::size_t references() const;
};

/// Cuts voxels: where, and which items lie in which octant.
class Cutter {
  public:
    Cutter(std::span<const Bounds3> boxes, const BuildOptions& options);

    /// The box of all items.
    Bounds3 root() const;
    std::size_t item_count() const { return boxes_.size(); }
    /// The cut of this voxel with these items; none where it has no place for one. [thesis 4.4.3]
    std::optional<TrialCut> cut(const Voxel& voxel, const Items& items);

  private:
    std::optional<Point3> choose_midpoint(const Voxel& voxel, const Items& items);
    void distribute(const Voxel& voxel, int digit, const Items& items, Items& out) const;

    const BuildOptions& options_;
    std::vector<Bounds3> boxes_;  // inflated
    std::vector<Bounds3> query_boxes_;
};

}  // namespace nuvo
