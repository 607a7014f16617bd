#include "nuvo/octree/compact.h"

#include <algorithm>
#include <utility>

namespace nuvo {

int CompactOctree::depth() const {
    int deepest = 0;
    std::vector<std::pair<std::uint32_t, int>> open;  // nodes and their levels
    if (!nodes.empty()) open.emplace_back(0, 1);
    while (!open.empty()) {
        const auto [index, level] = open.back();
        open.pop_back();
        deepest = std::max(deepest, level);
        const CompactNode& node = nodes[index];
        const int children = std::popcount(node.mask());
        for (int i = 0; i < children; ++i)
            open.emplace_back(node.first_child() + static_cast<std::uint32_t>(i), level + 1);
    }
    return deepest;
}

std::size_t CompactOctree::leaf_count() const {
    return static_cast<std::size_t>(std::count_if(
        nodes.begin(), nodes.end(),
        [](const CompactNode& node) { return node.is_leaf() && node.item_count() > 0; }));
}

}  // namespace nuvo
