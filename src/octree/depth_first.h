#pragma once

#include <vector>

#include "nuvo/octree/build.h"
#include "trial_cut.h"

namespace nuvo {

/// Cuts in the published order: depth first in label order, each cut judged by the sums of the
/// whole tree so far. [thesis 4.4.2]
class DepthFirstBuilder {
  public:
    DepthFirstBuilder(std::span<const Bounds3> boxes, const BuildOptions& options);
    Octree build();

  private:
    void subdivide(NodeIndex index, const Items& items);
    std::optional<TrialCut> kept_cut(const Node& node, const Items& items);
    bool worth_it(const SahTotals& after) const;

    const BuildOptions& options_;
    Cutter cutter_;
    std::vector<Node> nodes_;
    Items leaf_items_;
    SahTotals totals_;
    std::size_t references_ = 0;  // of all leaves so far
    double root_area_ = 0;
};

}  // namespace nuvo
