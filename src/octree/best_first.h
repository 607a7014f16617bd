#pragma once

#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "nuvo/octree/build.h"
#include "paying_cut.h"

namespace nuvo {

/// Cuts in the order of what cuts save, where prices are constant and the order is free: first the
/// voxel whose cut saves most expected cost for each reference that it adds. So what the budget
/// buys is spread over the scene, and a voxel that cuts hardly part waits for the others.
class BestFirstBuilder {
  public:
    BestFirstBuilder(std::span<const Bounds3> boxes, const BuildOptions& options);
    Octree build();

  private:
    // The items of a leaf, and its cut where one pays.
    struct Leaf {
        std::vector<ItemId> items;
        std::unique_ptr<PayingCut> cut;
    };
    struct Offer {
        double worth;  // expected cost saved for each reference added
        NodeIndex node;
        bool operator<(const Offer& other) const {
            return worth != other.worth ? worth < other.worth : node > other.node;
        }
    };

    void add(const Node& node, std::vector<ItemId> items);
    void cut(NodeIndex index);
    Octree in_label_order();

    const BuildOptions& options_;
    std::optional<CutFinder> finder_;  // until all cuts are made
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;  // by node; of interior nodes empty
    std::priority_queue<Offer> offers_;
    std::size_t references_ = 0;  // of all leaves so far
};

}  // namespace nuvo
