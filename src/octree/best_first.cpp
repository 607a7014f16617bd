#include "best_first.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace nuvo {

BestFirstBuilder::BestFirstBuilder(std::span<const Bounds3> boxes, const BuildOptions& options)
    : options_(options), finder_(std::in_place, boxes, options) {}

Octree BestFirstBuilder::build() {
    std::vector<ItemId> all(finder_->item_count());
    std::iota(all.begin(), all.end(), ItemId{0});
    references_ = all.size();
    begin_progress(options_, references_);
    add({Voxel::centered(finder_->root())}, std::move(all));
    while (!offers_.empty() && references_ < options_.max_references) {
        const NodeIndex best = offers_.top().node;
        offers_.pop();
        cut(best);
    }
    finder_.reset();  // which holds as much as the octree
    return in_label_order();
}

void BestFirstBuilder::add(const Node& node, std::vector<ItemId> items) {
    const auto index = static_cast<NodeIndex>(nodes_.size());
    nodes_.push_back(node);
    leaves_.push_back({std::move(items), nullptr});
    const int digits = label_digits(node.label);
    if (digits + 1 >= options_.max_depth) return;
    Leaf& leaf = leaves_.back();
    std::optional<PayingCut> cut = finder_->find(node.voxel, leaf.items);
    if (!cut) return;
    // A cut that adds none is as good as one that adds one.
    const std::size_t after = std::max(cut->references(), leaf.items.size() + 1);
    offers_.push({cut->saved / static_cast<double>(after - leaf.items.size()), index});
    leaf.cut = std::make_unique<PayingCut>(std::move(*cut));
}

void BestFirstBuilder::cut(NodeIndex index) {
    const Leaf leaf = std::exchange(leaves_[index], {});
    references_ += leaf.cut->references();
    references_ -= leaf.items.size();
    nuvo::add(options_.progress, leaf.cut->references() - leaf.items.size());
    const Label label = nodes_[index].label;
    const Voxel voxel = leaf.cut->voxel;
    nodes_[index].voxel = voxel;
    nodes_[index].first_child = static_cast<NodeIndex>(nodes_.size());
    for (int digit = 1; digit <= 8; ++digit)
        add({Voxel::centered(voxel.octant(digit)), child_label(label, digit)},
            leaf.cut->items(leaf.items, static_cast<unsigned>(octant_bits(digit))));
}

// Laid out depth first: what lies together in space lies together in memory.
Octree BestFirstBuilder::in_label_order() {
    struct Move {
        NodeIndex from;
        NodeIndex to;
    };
    std::vector<Node> nodes{nodes_[0]};
    std::vector<ItemId> items;
    nodes.reserve(nodes_.size());
    items.reserve(references_);
    std::vector<Move> open{{0, 0}};  // the next one last
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        const NodeIndex first_child = nodes_[from].first_child;
        if (first_child == 0) {
            const std::vector<ItemId> listed = std::move(leaves_[from].items);
            nodes[to].first_item = static_cast<std::uint32_t>(items.size());
            nodes[to].item_count = static_cast<std::uint32_t>(listed.size());
            items.insert(items.end(), listed.begin(), listed.end());
            continue;
        }
        nodes[to].first_child = static_cast<NodeIndex>(nodes.size());
        for (NodeIndex i = 0; i < 8; ++i) nodes.push_back(nodes_[first_child + i]);
        for (NodeIndex i = 8; i-- > 0;)
            open.push_back({first_child + i, nodes[to].first_child + i});
    }
    Octree octree(std::move(nodes), std::move(items));
    octree.set_out_of_budget(!offers_.empty());
    return octree;
}

}  // namespace nuvo
