#pragma once

#include <optional>
#include <vector>

#include "nuvo/octree/build.h"
#include "trial_cut.h"

namespace nuvo {

/// Cuts as the published program: depth first in label order, a cut taken back where the whole
/// tree's cost, rounded to float, does not fall; the root is given a midpoint twice.
/// [thesis 4.4.2, 5.4; docs/thesis-map.md, section 7]
class PublishedBuilder {
  public:
    PublishedBuilder(std::span<const Bounds3> boxes, const BuildOptions& options,
                     const ThesisCosts& costs);
    Octree build();

  private:
    Voxel sized_root(std::span<const Bounds3> boxes) const;
    void subdivide(NodeIndex index, const Items& items);
    std::optional<TrialCut> kept_cut(const Node& node, const Items& items);

    const BuildOptions& options_;
    ThesisCosts costs_;
    Cutter cutter_;
    std::vector<Node> nodes_;
    Items leaf_items_;
    SahTotals totals_;
    float root_area_ = 0;
    std::size_t references_ = 0;  // of all leaves so far
    int depth_tried_ = 0;
};

}  // namespace nuvo
