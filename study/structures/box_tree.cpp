#include "structures/box_tree.h"

namespace nuvo::study {
namespace {

int depth_of(std::span<const BoxTree::BoxNode> nodes, std::uint32_t node) {
    if (nodes[node].leaf) return 1;
    const std::uint32_t first = nodes[node].first;
    return 1 + std::max(depth_of(nodes, first), depth_of(nodes, first + 1));
}

}  // namespace

Sizes BoxTree::sizes() const {
    return {(nodes_.size() + 1) / 2, items_.size(), depth_of(nodes_, 0),
            nodes_.size() * sizeof(BoxNode) + items_.size() * sizeof(ItemId)};
}

double BoxTree::sah(const SahCosts& costs) const {
    SahTotals totals;
    for (const BoxNode& node : nodes_) {
        const double area = node.box.empty() ? 0 : node.box.surface_area();
        if (!node.leaf) {
            totals.interior_area += area;
            continue;
        }
        totals.leaf_area += area;
        totals.leaf_area_objects += area * node.count;
        ++totals.leaves;
    }
    return nuvo::sah(totals, nodes_[0].box.surface_area(), costs);
}

}  // namespace nuvo::study
