#include "nuvo/octree/compact_build.h"

#include <algorithm>
#include <limits>

#include "compact_subtree.h"

// The octree in the order in which a ray meets it: the children of a node side by side, then their
// subtrees in turn.

namespace nuvo {
namespace {

// By these shares of its width the root reaches beyond the items, below and above: unlike each
// other, so that planes through the middle keep clear of the planes of symmetry of made scenes, in
// which corners and edges lie that would be on both sides.
constexpr float kBelow = 0x1p-11F;
constexpr float kAbove = 0x1.8p-10F;

Bounds3T<float> root_box(BoxSpan boxes) {
    Bounds3T<float> root;
    for (const Bounds3T<float>& box : boxes) root = root.extended(box);
    if (root.empty()) return {{0, 0, 0}, {0, 0, 0}};
    const Vec3<float> widths = root.widths();
    return {root.min - widths * kBelow, root.max + widths * kAbove};
}

class Layout {
  public:
    explicit Layout(CompactOctree& out) : out_(out) {}

    // Puts a node of the subtree, and all below it, at `place`.
    void put(const Subtree& from, const CompactNode& node, std::size_t place) {
        if (node.is_leaf()) {
            const auto first = static_cast<std::uint32_t>(out_.items.size());
            const auto begin = from.items.begin() + node.first_item();
            out_.items.insert(out_.items.end(), begin, begin + node.item_count());
            out_.nodes[place] = CompactNode::leaf(first, node.item_count());
            return;
        }
        const auto count = static_cast<std::size_t>(std::popcount(node.mask()));
        const std::size_t first = out_.nodes.size();
        out_.nodes.resize(first + count);
        out_.nodes[place] = node;
        out_.nodes[place].children = static_cast<std::uint32_t>(first) << 8 | node.mask();
        for (std::size_t i = 0; i < count; ++i)
            put(from, from.nodes[node.first_child() + i], first + i);
    }

  private:
    CompactOctree& out_;
};

}  // namespace

CompactOctree build_compact_octree(std::span<const Bounds3T<float>> boxes,
                                   const CompactBuildOptions& options) {
    CompactOctree tree;
    tree.bounds = root_box(boxes);
    std::vector<std::uint32_t> all(boxes.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    const Allowance allowance{options.max_references_per_item * static_cast<double>(all.size()),
                              CompactNode::kMaxNodes - 1.0};
    const Subtree subtree = SubtreeBuilder(boxes, options).build({tree.bounds, 1, allowance}, all);
    tree.nodes.reserve(subtree.nodes.size() + 1);
    tree.items.reserve(subtree.items.size());
    tree.nodes.resize(1);
    Layout(tree).put(subtree, subtree.root, 0);
    return tree;
}

}  // namespace nuvo
