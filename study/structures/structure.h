#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "nuvo/octree/octree.h"
#include "nuvo/octree/walk.h"
#include "nuvo/render/primitives.h"

/// Structures that find what a ray meets, on the same rays and by the same counters. Each offers
///   visit(ray, limit, work, leaf)
/// which calls leaf(items) for the leaves that the ray meets, about front to back, until it returns
/// true; places that the ray reaches beyond limit() are left out. Boxes are tested so that none is
/// missed by rounding.
namespace nuvo::study {

/// What a picture, or a ray, costs.
struct Work {
    std::uint64_t rays = 0;
    std::uint64_t tests = 0;   ///< one ray against one leaf item
    std::uint64_t leaves = 0;  ///< leaves or cells entered: the thesis' voxel searches, about
    std::uint64_t nodes = 0;   ///< interior nodes met on the way
    bool timed = false;        ///< counts that cost time are left out
};

/// Sizes of a finished structure.
struct Sizes {
    std::size_t leaves = 0;
    std::size_t references = 0;
    int depth = 0;
    std::size_t bytes = 0;
};

/// A search for the tracer (src/render/tracer.h) over any structure.
template <typename Kernel, typename Structure>
class StructureSearch {
  public:
    StructureSearch(const Kernel& kernel, const Primitives& primitives, const Structure& structure,
                    Work* work)
        : kernel_(kernel),
          primitives_(primitives),
          structure_(structure),
          work_(work),
          stamps_(primitives.item_count(), 0) {}

    std::optional<typename Kernel::Hit> closest(const typename Kernel::PreparedRay& ray) {
        std::optional<typename Kernel::Hit> best;
        start();
        const auto limit = [&] { return best ? kernel_.upper_t(*best) : Kernel::kInfinity; };
        structure_.visit(kernel_.walk_ray(ray), limit, *work_, [&](std::span<const ItemId> items) {
            enter(items);
            for (const ItemId item : items)
                if (is_new(item)) kernel_.closest(ray, primitives_.of_item(item), best);
            return false;
        });
        return best;
    }

    bool occluded(const typename Kernel::Shadow& shadow) {
        bool blocked = kernel_.blocks_itself(shadow);
        start();
        if (blocked) return true;
        const auto limit = [&] { return shadow.end; };
        structure_.visit(
            kernel_.walk_ray(shadow.ray), limit, *work_, [&](std::span<const ItemId> items) {
                enter(items);
                for (const ItemId item : items)
                    if (is_new(item) && kernel_.blocks(shadow, primitives_.of_item(item)))
                        return blocked = true;
                return false;
            });
        return blocked;
    }

  private:
    void start() {
        ++work_->rays;
        ++ray_;
    }
    void enter(std::span<const ItemId> items) {
        ++work_->leaves;
        work_->tests += items.size();
    }
    bool is_new(ItemId item) { return std::exchange(stamps_[item], ray_) != ray_; }

    const Kernel& kernel_;
    const Primitives& primitives_;
    const Structure& structure_;
    Work* work_;
    std::vector<std::uint64_t> stamps_;  // no ray tests an item twice, in any structure
    std::uint64_t ray_ = 0;
};

/// Every item in one leaf.
class BruteForce {
  public:
    explicit BruteForce(std::size_t items) : all_(items) {
        for (std::size_t i = 0; i < items; ++i) all_[i] = static_cast<ItemId>(i);
    }
    template <typename Limit, typename Leaf>
    void visit(const Ray&, const Limit&, Work&, const Leaf& leaf) const {
        leaf(std::span<const ItemId>(all_));
    }
    Sizes sizes() const { return {1, all_.size(), 1, all_.size() * sizeof(ItemId)}; }

  private:
    std::vector<ItemId> all_;
};

/// The program's octree and walk.
class OctreeStructure {
  public:
    explicit OctreeStructure(const Octree& octree) : octree_(octree) {}

    template <typename Limit, typename Leaf>
    void visit(const Ray& ray, const Limit& limit, Work& work, const Leaf& leaf) const {
        ExactWalk<DescentLocator> walk(octree_);
        Label before = 0;
        int digits_before = 0;
        walk(ray, std::numeric_limits<double>::infinity(), [&](const Node& node, double exit) {
            if (work.timed) return leaf(octree_.contents(node)) || exit >= limit();
            // Down from the lowest ancestor that this leaf shares with the one before.
            const int digits = label_digits(node.label);
            Label a = node.label, b = before;
            for (int i = digits; i > digits_before; --i) a = parent_label(a);
            for (int i = digits_before; i > digits; --i) b = parent_label(b);
            int shared = std::min(digits, digits_before);
            for (; a != b; --shared) {
                a = parent_label(a);
                b = parent_label(b);
            }
            work.nodes += static_cast<std::uint64_t>(digits - shared);
            before = node.label;
            digits_before = digits;
            return leaf(octree_.contents(node)) || exit >= limit();
        });
    }
    Sizes sizes() const {
        return {octree_.leaf_count(), octree_.reference_count(), octree_.depth(),
                octree_.memory_bytes()};
    }

  private:
    const Octree& octree_;
};

}  // namespace nuvo::study
