#include "compact_subtree.h"

#include <algorithm>
#include <array>
#include <utility>

// Depth first: cut while the surface area heuristic falls, and on the way back turn what did not
// pay after all into a leaf. Children stand before their parents, so that taking a subtree back is
// cutting off the end.

namespace nuvo {

Subtree SubtreeBuilder::build(const Place& place, ItemSpan items) {
    out_ = {};
    if (stack_.size() < items.size()) stack_.resize(items.size());
    std::copy(items.begin(), items.end(), stack_.begin());
    top_ = items.size();
    const Built root = node(place, {0, items.size()});
    out_.root = root.node;
    out_.cost = root.cost;
    return std::exchange(out_, {});
}

SubtreeBuilder::Built SubtreeBuilder::node(const Place& place, Run run) {
    const std::optional<Split> split =
        find_split(recipe_, place, items(run), masks_,
                   [&](const CutVoxel& cut, ItemSpan items, std::uint8_t* masks) {
                       return mark_octants(recipe_.boxes, recipe_.overlaps, cut, items, masks);
                   });
    if (!split) return leaf(run);
    if (split->occupied() == 0) return leaf({run.begin, 0});  // all only came near
    return interior(place, *split, run);
}

SubtreeBuilder::Built SubtreeBuilder::leaf(Run run) {
    const auto first = static_cast<std::uint32_t>(out_.items.size());
    const ItemSpan from = items(run);
    out_.items.insert(out_.items.end(), from.begin(), from.end());
    return {CompactNode::leaf(first, static_cast<std::uint32_t>(run.count)),
            recipe_.prices.leaf(run.count)};
}

SubtreeBuilder::Built SubtreeBuilder::interior(const Place& place, const Split& split, Run run) {
    const std::size_t nodes_before = out_.nodes.size();
    const std::size_t items_before = out_.items.size();
    const std::size_t top_before = top_;
    std::array<std::size_t, 8> first;
    for (unsigned o = 0; o < 8; ++o) {
        first[o] = top_;
        top_ += split.counts[o] + 1;
    }
    if (stack_.size() < top_) stack_.resize(std::max(top_, 2 * stack_.size()));
    distribute(items(run), masks_.kept.data(), first, stack_.data());

    std::array<CompactNode, 8> children;
    std::size_t built = 0;
    const double beam = recipe_.prices.beam(place.voxel, run.count);
    double cost = recipe_.prices.interior();
    for (unsigned o = 0; o < 8; ++o) {
        if (split.counts[o] == 0) continue;
        const Place octant = place.octant(split, o);
        const Built child = node(octant, {first[o], split.counts[o]});
        children[built++] = child.node;
        cost += Prices::share(octant.voxel, place.voxel, beam) * child.cost;
    }
    top_ = top_before;
    if (cost >= recipe_.prices.leaf(run.count)) {
        out_.nodes.resize(nodes_before);
        out_.items.resize(items_before);
        return leaf(run);
    }
    const Vec3<float>& cut = split.voxel.cut;
    const auto place_of_children = static_cast<std::uint32_t>(out_.nodes.size());
    out_.nodes.insert(out_.nodes.end(), children.begin(),
                      children.begin() + static_cast<std::ptrdiff_t>(built));
    return {{{cut.x, cut.y, cut.z}, place_of_children << 8 | split.occupied()}, cost};
}

}  // namespace nuvo
