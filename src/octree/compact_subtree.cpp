#include "compact_subtree.h"

#include <algorithm>
#include <array>

// Depth first: cut while the surface area heuristic falls, and on the way back turn what did not
// pay after all into a leaf. Children stand before their parents, so that taking a subtree back is
// cutting off the end.

namespace nuvo {

Subtree SubtreeBuilder::build(const Place& place, ItemSpan items) {
    out_ = {};
    if (stack_.size() < items.size()) stack_.resize(items.size());
    std::copy(items.begin(), items.end(), stack_.begin());
    top_ = items.size();
    const Built root = node(place, 0, items.size());
    out_.root = root.node;
    out_.cost = root.cost;
    return std::move(out_);
}

SubtreeBuilder::Built SubtreeBuilder::node(const Place& place, std::size_t begin,
                                           std::size_t count) {
    if (place.level >= CompactOctree::kMaxDepth) return leaf(place, begin, count);
    const std::optional<Split> split =
        splitter_.try_split(place.voxel, ItemSpan(stack_).subspan(begin, count));
    if (!split || !place.allowance.permits(*split)) return leaf(place, begin, count);
    if (split->references == 0) return leaf(place, begin, 0);  // all only came near
    return interior(place, *split, begin, count);
}

SubtreeBuilder::Built SubtreeBuilder::leaf(const Place& place, std::size_t begin,
                                           std::size_t count) {
    const auto first = static_cast<std::uint32_t>(out_.items.size());
    const auto from = stack_.begin() + static_cast<std::ptrdiff_t>(begin);
    out_.items.insert(out_.items.end(), from, from + static_cast<std::ptrdiff_t>(count));
    return {CompactNode::leaf(first, static_cast<std::uint32_t>(count)),
            splitter_.leaf_cost(place.voxel, count)};
}

SubtreeBuilder::Built SubtreeBuilder::interior(const Place& place, const Split& split,
                                               std::size_t begin, std::size_t count) {
    const std::size_t nodes_before = out_.nodes.size();
    const std::size_t items_before = out_.items.size();
    const std::size_t top_before = top_;
    std::array<std::size_t, 8> first;
    for (unsigned o = 0; o < 8; ++o) {
        first[o] = top_;
        top_ += split.counts[o] + 1;
    }
    if (stack_.size() < top_) stack_.resize(std::max(top_, 2 * stack_.size()));
    splitter_.distribute(ItemSpan(stack_).subspan(begin, count), first, stack_.data());

    std::array<CompactNode, 8> children;
    unsigned built = 0;
    double cost = splitter_.interior_cost(place.voxel);
    const auto octants = static_cast<unsigned>(std::popcount(split.occupied()));
    for (unsigned o = 0; o < 8; ++o) {
        if (split.counts[o] == 0) continue;
        const Place child{octant_box(split.voxel, o), place.level + 1,
                          place.allowance.share(split.counts[o], split.references, octants)};
        const Built result = node(child, first[o], split.counts[o]);
        children[built++] = result.node;
        cost += result.cost;
    }
    top_ = top_before;
    if (cost >= splitter_.leaf_cost(place.voxel, count)) {
        out_.nodes.resize(nodes_before);
        out_.items.resize(items_before);
        return leaf(place, begin, count);
    }
    CompactNode result;
    for (int axis = 0; axis < 3; ++axis) result.cut[axis] = split.voxel.cut[axis];
    result.children = static_cast<std::uint32_t>(out_.nodes.size()) << 8 | split.occupied();
    out_.nodes.insert(out_.nodes.end(), children.begin(), children.begin() + built);
    return {result, cost};
}

}  // namespace nuvo
