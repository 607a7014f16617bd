#include "fast/rays/wide_bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "fast/rays/ray_items.h"
#include "nuvo/math/error_bounds.h"

// In two steps. The first goes down and cuts in two by the surface area heuristic, asked of planes
// between bins (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"). On its
// way up it notes what a subtree costs as a leaf, as a node, and as part of a node above it that
// has so many lanes left (Ylitie, Karras and Laine 2017, "Efficient incoherent ray traversal on
// GPUs through compressed wide BVHs", section 3.1). The second goes down and takes the cheapest.

namespace nuvo {
namespace {

// Prices of a step through a node, of reaching a leaf and of a register of primitives there,
// measured on random rays. What all of the structure weighs when it has as many bytes as the
// primitives have is the price of memory.
constexpr float kNodeCost = 1;
constexpr float kLeafCost = 1.5F;
constexpr float kBlockCost = 1;
constexpr float kMemoryCost = 1;
// What a leaf takes for each item: nine corners' numbers of two bytes, and its slot.
constexpr float kItemBytes = 9 * sizeof(std::uint16_t) + sizeof(Slot);

// A plane across an axis.
struct Cut {
    int axis = -1;                      ///< none
    int bin = 0;                        ///< the first one above it
    float half_areas = kFloatInfinity;  ///< of the boxes of what lies on either side, together
    float cost = kFloatInfinity;
};

// Equal parts of the box of the items' middles on each axis, and what lies in each.
class Bins {
  public:
    Bins(std::span<const RayItem> items, const FourBox& middles)
        : size_(static_cast<int>(std::min(kMost, 4 + items.size() / kMost))), low_(middles.low) {
        for (int axis = 0; axis < 3; ++axis) {
            std::fill_n(boxes_[axis], size_, FourBox{});
            const float width = middles.high[axis] - middles.low[axis];
            if (width > kLeastWidth) scale_[axis] = static_cast<float>(size_) * kBelowOne / width;
        }
        for (const RayItem& item : items) {
            const FourInts bin = bins_of(item);
            for (int axis = 0; axis < 3; ++axis) {
                boxes_[axis][bin[axis]].extend(item.box);
                ++counts_[axis][bin[axis]];
            }
        }
    }

    bool below(const RayItem& item, const Cut& cut) const {
        return bins_of(item)[cut.axis] < cut.bin;
    }

    Cut best() const {
        Cut best;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<float, kMost> above;  // half areas of all from a bin on
            FourBox box;
            for (int bin = size_; --bin > 0;) {
                box.extend(boxes_[axis][bin]);
                above[static_cast<std::size_t>(bin)] = box.half_area();
            }
            const std::uint32_t all =
                std::accumulate(counts_[axis], counts_[axis] + size_, std::uint32_t{0});
            std::uint32_t count = 0;
            box = {};
            for (int bin = 1; bin < size_; ++bin) {
                box.extend(boxes_[axis][bin - 1]);
                count += counts_[axis][bin - 1];
                if (count == 0 || count == all) continue;
                const float low = box.half_area();
                const float high = above[static_cast<std::size_t>(bin)];
                const float cost =
                    low * static_cast<float>(count) + high * static_cast<float>(all - count);
                if (cost < best.cost) best = {axis, bin, low + high, cost};
            }
        }
        return best;
    }

  private:
    static constexpr std::size_t kMost = 32;
    // The scale stays finite above this.
    static constexpr float kLeastWidth = 0x1p-100F;
    // The last middle falls into the last bin, whatever is rounded.
    static constexpr float kBelowOne = 1 - roundings(8);

    FourInts bins_of(const RayItem& item) const {
        return __builtin_convertvector((item.middle() - low_) * scale_, FourInts);
    }

    int size_;
    Four low_;
    Four scale_{};
    FourBox boxes_[3][kMost];
    std::uint32_t counts_[3][kMost] = {};
};

// forest[k - 1] is the least cost of what a subtree holds in at most k lanes of a node above it.
using Forest = std::array<float, kWideLanes>;

// A node of the binary tree. Its lower child stands behind it.
struct Subtree {
    std::uint32_t first;  // of its items
    std::uint32_t count;
    Bounds3T<float> box{};
    float narrowest = kFloatInfinity;  // of its triangles
    float widest = 0;
    std::uint32_t upper = 0;  // the other child; 0: none
    int axis = 0;             // across which it is cut
    bool leaf = true;         // in one lane it is a leaf, not a node
    Forest forest{};

    // Whether one grid serves all corners.
    bool may_be_leaf() const {
        constexpr float kLargestRatio = 64;
        const float extent = std::max(widest, max_norm(box.widths()));
        return count == 1 || (count <= kMostOfLeaf && extent <= kLargestRatio * narrowest);
    }
};

class WideBuilder {
  public:
    WideBuilder(const FastScene& scene, WideBvh& out)
        : scene_(scene), out_(out), items_(ray_items(scene)) {}

    void build() {
        FourBox all;
        for (const RayItem& item : items_) all.extend(item.box);
        std::vector<Lane> lanes;
        if (!items_.empty()) {
            byte_cost_ =
                kMemoryCost * all.half_area() / (kItemBytes * static_cast<float>(items_.size()));
            add_subtree(0, static_cast<std::uint32_t>(items_.size()), 0);
            const Bounds3T<float>& box = subtrees_[0].box;
            out_.reach = std::max(max_norm(box.min), max_norm(box.max));
            constexpr Lane kRoot = {0, 0, 3 * kWideLanes};
            if (subtrees_[0].leaf)
                lanes.push_back(kRoot);
            else
                add_children(kRoot, kWideLanes, lanes);
        }
        out_.nodes.emplace_back(WideNode{});
        fill(0, lanes);
        // The widest load begins at the last word.
        out_.leaves.resize(out_.leaves.size() + kMostLeafLanes, 0);
        out_.leaves.shrink_to_fit();
        out_.nodes.shrink_to_fit();
    }

  private:
    // Deeper down the items are halved.
    static constexpr int kBinnedLevels = WideBvh::kMostLevels - 32;

    // A subtree in a node, and the way to it from the node's own: three bits a level, the first
    // ones highest, of which the one of the cut's axis tells on which side it lies.
    struct Lane {
        std::uint32_t place;
        std::uint64_t way;
        int shift;  // of the last level
    };

    float leaf_cost(const Subtree& tree) const {
        const auto blocks = static_cast<float>((tree.count + kLeafLanes - 1) / kLeafLanes);
        return tree.box.surface_area() / 2 * (kLeafCost + kBlockCost * blocks) +
               byte_cost_ * (static_cast<float>(sizeof(WideLeafHead)) +
                             kItemBytes * static_cast<float>(tree.count));
    }

    // Over the items from `first` on; changes their order. Returns its place.
    std::uint32_t add_subtree(std::uint32_t first, std::uint32_t count, int level) {
        const auto place = static_cast<std::uint32_t>(subtrees_.size());
        const std::span all(items_.data() + first, count);
        FourBox box;
        FourBox middles;
        Subtree tree{.first = first, .count = count};
        for (const RayItem& item : all) {
            box.extend(item.box);
            middles.extend({item.middle(), item.middle()});
            tree.narrowest = std::min(tree.narrowest, item.width());
            if (item.width() < kFloatInfinity) tree.widest = std::max(tree.widest, item.width());
        }
        for (int axis = 0; axis < 3; ++axis) {
            tree.box.min[axis] = box.low[axis];
            tree.box.max[axis] = box.high[axis];
        }
        const std::uint32_t below = cut(all, middles, level, tree);
        subtrees_.push_back(tree);
        if (below > 0) {
            add_subtree(first, below, level + 1);
            tree.upper = add_subtree(first + below, count - below, level + 1);
        }
        set_costs(place, tree);
        subtrees_[place] = tree;
        return place;
    }

    // Sorts the items by the side of the cut that they lie on; returns how many lie below.
    // 0: they are few, and no boxes of parts of them are smaller.
    static std::uint32_t cut(std::span<RayItem> all, const FourBox& middles, int level,
                             Subtree& tree) {
        if (all.size() == 1) return 0;
        const bool few = all.size() <= kMostLeafLanes && tree.may_be_leaf();
        if (level < kBinnedLevels) {
            const Bins bins(all, middles);
            const Cut best = bins.best();
            if (few && best.half_areas >= tree.box.surface_area() / 2) return 0;
            if (best.axis >= 0) {
                tree.axis = best.axis;
                const auto above = std::partition(all.begin(), all.end(), [&](const RayItem& item) {
                    return bins.below(item, best);
                });
                return static_cast<std::uint32_t>(above - all.begin());
            }
        }
        if (few) return 0;
        const Four widths = middles.high - middles.low;
        for (int axis = 1; axis < 3; ++axis)
            if (widths[axis] > widths[tree.axis]) tree.axis = axis;
        const std::size_t half = all.size() / 2;
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                         [&](const RayItem& p, const RayItem& q) {
                             return p.middle()[tree.axis] < q.middle()[tree.axis];
                         });
        return static_cast<std::uint32_t>(half);
    }

    void set_costs(std::uint32_t place, Subtree& tree) const {
        const float as_leaf = leaf_cost(tree);
        if (tree.upper == 0) {
            tree.forest.fill(as_leaf);
            return;
        }
        const Forest& lower = subtrees_[place + 1].forest;
        const Forest& upper = subtrees_[tree.upper].forest;
        Forest& forest = tree.forest;
        forest.fill(kFloatInfinity);
        for (std::size_t j = 0; j + 1 < kWideLanes; ++j)
            for (std::size_t k = 0; j + k + 1 < kWideLanes; ++k)
                forest[j + k + 1] = std::min(forest[j + k + 1], lower[j] + upper[k]);
        const float as_node = tree.box.surface_area() / 2 * kNodeCost +
                              byte_cost_ * static_cast<float>(sizeof(WideNode)) + forest.back();
        tree.leaf = tree.may_be_leaf() && as_leaf <= as_node;
        forest[0] = tree.leaf ? as_leaf : as_node;
        for (std::size_t k = 1; k < kWideLanes; ++k) forest[k] = std::min(forest[k], forest[k - 1]);
    }

    // Appends the children of a subtree, or what stands for them, in at most `lanes` lanes.
    void add_children(const Lane& parent, std::size_t lanes, std::vector<Lane>& out) const {
        const Subtree& tree = subtrees_[parent.place];
        const std::uint32_t below = parent.place + 1;
        const Forest& lower = subtrees_[below].forest;
        const Forest& upper = subtrees_[tree.upper].forest;
        const auto cost = [&](std::size_t k) { return lower[k - 1] + upper[lanes - k - 1]; };
        std::size_t share = 1;
        for (std::size_t k = 2; k < lanes; ++k)
            if (cost(k) < cost(share)) share = k;
        const int shift = parent.shift - 3;
        add({below, parent.way, shift}, share, out);
        add({tree.upper, parent.way | std::uint64_t{1} << (shift + tree.axis), shift},
            lanes - share, out);
    }
    // As one wherever that costs no more.
    void add(const Lane& lane, std::size_t lanes, std::vector<Lane>& out) const {
        const Forest& forest = subtrees_[lane.place].forest;
        if (forest[lanes - 1] >= forest[0])
            out.push_back(lane);
        else
            add_children(lane, lanes, out);
    }

    // Children from near to far are in the order of their ways, each bit turned where the ray goes
    // downwards.
    static void put_orders(const std::vector<Lane>& children, WideNode& node) {
        std::array<std::uint32_t, kWideLanes> lanes;
        for (std::uint64_t signs = 0; signs < 8; ++signs) {
            constexpr std::uint64_t kEachLevel = 0x1249249249249249;  // bit 0 of three
            const std::uint64_t turned = signs * kEachLevel;
            std::iota(lanes.begin(), lanes.end(), 0U);
            // As many places on as there are nearer ones: no two ways are the same.
            for (std::size_t i = 0; i < children.size(); ++i) {
                const auto nearer =
                    std::count_if(children.begin(), children.end(), [&](const Lane& other) {
                        return (other.way ^ turned) < (children[i].way ^ turned);
                    });
                lanes[static_cast<std::size_t>(nearer)] = static_cast<std::uint32_t>(i);
            }
            for (std::size_t i = 0; i < kWideLanes; ++i)
                node.order[signs][i % 2] |= lanes[i] << (4 * (i / 2));
        }
    }

    void put_boxes(const std::vector<Lane>& children, WideNode& node) const {
        for (std::size_t lane = 0; lane < kWideLanes; ++lane) {
            const Bounds3T<float> box =
                lane < children.size() ? subtrees_[children[lane].place].box : Bounds3T<float>{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.face[axis * kWideLanes + lane] = box.min[static_cast<int>(axis)];
                node.face[(axis + 3) * kWideLanes + lane] = box.max[static_cast<int>(axis)];
            }
        }
    }

    std::uint32_t put_leaf(const Subtree& tree) {
        std::array<Slot, kMostOfLeaf> slots;
        std::transform(items_.begin() + tree.first, items_.begin() + tree.first + tree.count,
                       slots.begin(), [](const RayItem& item) { return item.slot(); });
        std::sort(slots.begin(), slots.begin() + tree.count);
        const auto end = std::unique(slots.begin(), slots.begin() + tree.count);
        return append_leaf(scene_, {slots.begin(), end}, tree.box, out_.leaves) | WideBvh::kLeaf;
    }

    // Node `place` with these children, and all below it. Leaves first, so that those of a node
    // stand together.
    void fill(std::size_t place, const std::vector<Lane>& children) {
        put_boxes(children, out_.nodes[place]);
        put_orders(children, out_.nodes[place]);
        for (std::size_t lane = 0; lane < children.size(); ++lane) {
            const Subtree& tree = subtrees_[children[lane].place];
            if (tree.leaf) out_.nodes[place].child[lane] = put_leaf(tree);
        }
        std::vector<Lane> below;
        for (std::size_t lane = 0; lane < children.size(); ++lane) {
            if (subtrees_[children[lane].place].leaf) continue;
            const std::size_t next = out_.nodes.size();
            out_.nodes.emplace_back(WideNode{});
            out_.nodes[place].child[lane] = static_cast<std::uint32_t>(next);
            below.clear();
            add_children({children[lane].place, 0, 3 * kWideLanes}, kWideLanes, below);
            fill(next, below);
        }
    }

    const FastScene& scene_;
    WideBvh& out_;
    float byte_cost_ = 0;  // of a byte, in half areas
    std::vector<RayItem> items_;
    std::vector<Subtree> subtrees_;  // 0 is the root
};

}  // namespace

WideBvh::WideBvh(const FastScene& scene) { WideBuilder(scene, *this).build(); }

}  // namespace nuvo
