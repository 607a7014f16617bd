#include "nuvo/octree/compact_build.h"

#include <algorithm>

#include "compact_plan.h"
#include "nuvo/math/parallel.h"

// The octree in the order in which a ray meets it: the children of a node side by side, then their
// subtrees in turn. A subtree thus is a range of nodes and a range of references.

namespace nuvo {
namespace {

// By these shares of its width the root reaches beyond the items, below and above: unlike each
// other, so that planes through the middle keep clear of the planes of symmetry of made scenes, in
// which corners and edges lie that would be on both sides.
constexpr float kBelow = 0x1p-11F;
constexpr float kAbove = 0x1.8p-10F;
// So many times as many references as by the sweep are worth the sweep's longer build.
constexpr double kManyMore = 1.5;

Bounds3T<float> root_box(BoxSpan boxes) {
    Bounds3T<float> root;
    for (const Bounds3T<float>& box : boxes) root = root.extended(box);
    if (root.empty()) return {{0, 0, 0}, {0, 0, 0}};
    const Vec3<float> widths = root.widths();
    return {root.min - widths * kBelow, root.max + widths * kAbove};
}

// Lays out one subtree in the ranges that begin at `node` and at `item`.
class Layout {
  public:
    Layout(const Subtree& from, CompactOctree& out, std::size_t node, std::size_t item)
        : from_(from), out_(out), next_node_(node), next_item_(item) {}

    void put(const CompactNode& node, std::size_t place) {
        if (node.is_leaf()) {
            const auto begin = from_.items.begin() + node.first_item();
            std::copy(begin, begin + node.item_count(),
                      out_.items.begin() + static_cast<std::ptrdiff_t>(next_item_));
            out_.nodes[place] =
                CompactNode::leaf(static_cast<std::uint32_t>(next_item_), node.item_count());
            next_item_ += node.item_count();
            return;
        }
        const std::size_t first = next_node_;
        const auto count = static_cast<std::size_t>(std::popcount(node.mask()));
        next_node_ += count;
        out_.nodes[place] = node;
        out_.nodes[place].children = static_cast<std::uint32_t>(first) << 8 | node.mask();
        for (std::size_t i = 0; i < count; ++i) put(from_.nodes[node.first_child() + i], first + i);
    }

  private:
    const Subtree& from_;
    CompactOctree& out_;
    std::size_t next_node_;
    std::size_t next_item_;
};

// Where the subtree of a node of the plan goes.
struct Destination {
    const Subtree* subtree;
    std::size_t root;
    std::size_t nodes;
    std::size_t items;
};

// Places the upper levels and reserves the ranges of the subtrees.
class Ranges {
  public:
    Ranges(const std::vector<PlanNode>& plan, CompactOctree& out) : plan_(plan), out_(out) {
        out_.nodes.resize(1);
        reserve(plan_[0], 0);
    }
    const std::vector<Destination>& destinations() const { return destinations_; }
    std::size_t item_count() const { return items_; }

  private:
    void reserve(const PlanNode& node, std::size_t place) {
        const std::size_t first = out_.nodes.size();
        if (!node.split) {
            destinations_.push_back({&node.subtree, place, first, items_});
            out_.nodes.resize(first + node.subtree.nodes.size());
            items_ += node.subtree.items.size();
            return;
        }
        const Vec3<float>& cut = node.split->voxel.cut;
        out_.nodes[place] = {{cut.x, cut.y, cut.z},
                             static_cast<std::uint32_t>(first) << 8 | node.split->occupied()};
        const unsigned count = node.split->octants();
        out_.nodes.resize(first + count);
        for (unsigned i = 0; i < count; ++i) reserve(plan_[node.first_child + i], first + i);
    }

    const std::vector<PlanNode>& plan_;
    CompactOctree& out_;
    std::vector<Destination> destinations_;
    std::size_t items_ = 0;
};

}  // namespace

CompactOctree build_compact_octree(std::span<const Bounds3T<float>> boxes,
                                   const CompactBuildOptions& options) {
    CompactOctree tree;
    tree.bounds = root_box(boxes);
    const Allowance allowance{
        std::max(options.max_references_per_item * static_cast<double>(boxes.size()),
                 options.free_references),
        CompactNode::kMaxNodes - 1.0};
    const Place root{tree.bounds, 1, allowance};
    Recipe recipe{boxes, options.overlaps, Prices(options.costs, tree.bounds, boxes.size()),
                  options.rule.value_or(CutRule::kSpatial), options.threads};
    std::vector<PlanNode> plan = make_plan(root, recipe);
    if (!options.rule && references_beside(CutRule::kSweep, plan, recipe) > kManyMore) {
        recipe.rule = CutRule::kSweep;
        plan = make_plan(root, recipe);
    }
    tree.rule = recipe.rule;
    carry_out(plan, recipe, options.progress);
    const Ranges ranges(plan, tree);
    tree.nodes.shrink_to_fit();
    tree.items.resize(ranges.item_count());
    for_each_index(options.threads, ranges.destinations().size(), [&](std::size_t i, int) {
        const Destination& to = ranges.destinations()[i];
        Layout(*to.subtree, tree, to.nodes, to.items).put(to.subtree->root, to.root);
    });
    return tree;
}

}  // namespace nuvo
