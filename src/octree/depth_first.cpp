#include "depth_first.h"

#include <numeric>

namespace nuvo {

DepthFirstBuilder::DepthFirstBuilder(std::span<const Bounds3> boxes, const BuildOptions& options)
    : options_(options), cutter_(boxes, options) {}

Octree DepthFirstBuilder::build() {
    const Bounds3 root = cutter_.root();
    nodes_.push_back({Voxel::centered(root)});
    root_area_ = root.surface_area();
    Items all(cutter_.item_count());
    std::iota(all.begin(), all.end(), ItemId{0});
    totals_ = {0, root_area_, root_area_ * static_cast<double>(all.size()), 1};
    references_ = all.size();
    subdivide(0, all);
    return Octree(std::move(nodes_), std::move(leaf_items_));
}

void DepthFirstBuilder::subdivide(NodeIndex index, const Items& items) {
    std::optional<TrialCut> cut = kept_cut(nodes_[index], items);
    if (!cut) {
        nodes_[index].first_item = static_cast<std::uint32_t>(leaf_items_.size());
        nodes_[index].item_count = static_cast<std::uint32_t>(items.size());
        leaf_items_.insert(leaf_items_.end(), items.begin(), items.end());
        return;
    }
    const Label label = nodes_[index].label;
    nodes_[index].voxel = cut->voxel;
    nodes_[index].first_child = static_cast<NodeIndex>(nodes_.size());
    for (int digit = 1; digit <= 8; ++digit)
        nodes_.push_back({Voxel::centered(cut->voxel.octant(digit)), child_label(label, digit)});
    for (int digit = 1; digit <= 8; ++digit) {
        Items& octant = cut->octants[static_cast<std::size_t>(digit - 1)];
        subdivide(nodes_[index].child(digit), octant);
        octant = {};
    }
}

// The node's cut, unless that is not allowed, not possible or not worth it. [4.4.3, appendix D]
std::optional<TrialCut> DepthFirstBuilder::kept_cut(const Node& node, const Items& items) {
    const int digits = label_digits(node.label);
    if (digits >= kMaxLabelDigits || digits + 1 >= options_.max_depth) return std::nullopt;
    if (references_ >= options_.max_references) return std::nullopt;
    std::optional<TrialCut> trial = cutter_.cut(node.voxel, items);
    if (!trial) return std::nullopt;
    const SahTotals after = sums_after(totals_, *trial, items.size());
    if (!worth_it(after)) return std::nullopt;
    totals_ = after;
    references_ += trial->references();
    references_ -= items.size();
    return trial;
}

bool DepthFirstBuilder::worth_it(const SahTotals& after) const {
    const CostModel& costs = std::get<CostModel>(options_.worth);
    return sah(after, root_area_, costs(after.leaves)) <
           sah(totals_, root_area_, costs(totals_.leaves));
}

}  // namespace nuvo
