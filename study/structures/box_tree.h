#pragma once

#include <algorithm>

#include "nuvo/octree/build.h"
#include "structures/structure.h"

namespace nuvo::study {

/// A binary tree of boxes: a kd-tree where the boxes of two children tile their parent's, a BVH
/// where each holds its own items.
class BoxTree {
  public:
    struct BoxNode {
        Bounds3 box;
        std::uint32_t first = 0;  ///< of two children, or of the items
        std::uint32_t count = 0;  ///< of items
        bool leaf = true;
    };

    template <typename Limit, typename Leaf>
    void visit(const Ray& ray, const Limit& limit, Work& work, const Leaf& leaf) const {
        struct Open {
            std::uint32_t node;
            double before;
        };
        const auto entry_of = [&](std::uint32_t node) {
            return detail::slab_entry(ray, nodes_[node].box);
        };
        const auto root = entry_of(0);
        if (!root) return;
        std::vector<Open> open{{0, root->before()}};
        while (!open.empty()) {
            const auto [index, before] = open.back();
            open.pop_back();
            if (before > limit()) continue;
            const BoxNode& node = nodes_[index];
            if (node.leaf) {
                if (leaf(std::span(items_).subspan(node.first, node.count))) return;
                continue;
            }
            ++work.nodes;
            const auto a = entry_of(node.first), b = entry_of(node.first + 1);
            const bool a_last = a && b && a->t > b->t;
            if (a && a_last) open.push_back({node.first, a->before()});
            if (b) open.push_back({node.first + 1, b->before()});
            if (a && !a_last) open.push_back({node.first, a->before()});
        }
    }
    Sizes sizes() const;
    /// The expected cost of a ray that enters the root, as the octree's. [eq. 10]
    double sah(const SahCosts& costs) const;

  protected:
    std::vector<BoxNode> nodes_;
    std::vector<ItemId> items_;
};

/// The plane of least SAH among all edges of boxes; ends where a cut does not pay. [Wald and Havran
/// 2006, without clipping]
class KdTree : public BoxTree {
  public:
    KdTree(std::span<const Bounds3> boxes, const OverlapTest& overlaps, double margin, double step);

  private:
    void build(std::uint32_t node, std::vector<ItemId> items, int depth_left);

    std::span<const Bounds3> boxes_;
    const OverlapTest& overlaps_;
    double margin_;
    double step_;
};

/// The SAH of 16 bins of centres on each axis. [Wald 2007]
class Bvh : public BoxTree {
  public:
    Bvh(std::span<const Bounds3> boxes, double step);

  private:
    void build(std::uint32_t node, std::span<ItemId> items);

    std::span<const Bounds3> boxes_;
    double step_;
};

}  // namespace nuvo::study
