#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "crowd.h"
#include "nuvo/octree/walk.h"
#include "nuvo/render/primitives.h"
#include "nuvo/render/render.h"

// The ways to find what a ray meets. Each search is built from a kernel, which answers for one ray
// and the primitives of an item (exact_kernel.h, plain_kernel.h), and offers
//   closest(ray)     -> std::optional<Kernel::Hit>
//   occluded(shadow) -> bool

namespace nuvo {

/// Counts nothing, at no cost.
struct NoCounter {
    void count_leaf(const Node&) const {}
    void count_items(std::size_t) const {}
    void count_search() const {}
    void count_primitives(PrimitiveRange) const {}
};

/// Counts as the thesis does.
struct EventCounter {
    TraceCounts* counts;
    std::uint64_t* primitives;  // of those leaf items
    void count_leaf(const Node& leaf) const { count_items(leaf.item_count); }
    void count_items(std::size_t n) const { counts->intersection_tests += n; }
    void count_search() const { ++counts->voxel_searches; }
    void count_primitives(PrimitiveRange range) const { *primitives += range.last - range.first; }
};

/// Every primitive against every ray.
template <typename Kernel, typename Counter = NoCounter>
class BruteForceSearch {
  public:
    BruteForceSearch(const Kernel& kernel, const Primitives& primitives, Counter counter = {})
        : kernel_(kernel),
          all_(primitives.all()),
          items_(primitives.item_count()),
          counter_(counter) {}

    std::optional<typename Kernel::Hit> closest(const typename Kernel::PreparedRay& ray) const {
        std::optional<typename Kernel::Hit> best;
        count();
        kernel_.closest(ray, all_, best);
        return best;
    }
    bool occluded(const typename Kernel::Shadow& shadow) const {
        count();
        return kernel_.blocks(shadow, all_);
    }

  private:
    void count() const {
        counter_.count_items(items_);
        counter_.count_primitives(all_);
    }

    const Kernel& kernel_;
    PrimitiveRange all_;
    std::size_t items_;
    Counter counter_;
};

/// Through the octree by the walk without an epsilon: no hit is missed.
template <typename Kernel, typename Locator, typename Counter>
class ExactSearch {
  public:
    ExactSearch(const Kernel& kernel, const Primitives& primitives, const Octree& octree,
                Counter counter)
        : kernel_(kernel),
          primitives_(primitives),
          octree_(octree),
          walk_(octree),
          counter_(counter),
          stamps_(primitives.item_count(), 0) {}

    std::optional<typename Kernel::Hit> closest(const typename Kernel::PreparedRay& ray) {
        std::optional<typename Kernel::Hit> best;
        start();
        bool entered = false;
        walk_(kernel_.walk_ray(ray), Kernel::kInfinity, [&](const Node& leaf, double exit) {
            if (!entered && !octree_.root().is_leaf()) counter_.count_search();
            entered = true;
            counter_.count_leaf(leaf);
            if (is_crowd(leaf))
                closest_in_crowd(ray, leaf, best);
            else
                test(ray, octree_.contents(leaf), best);
            // What is listed in a leaf but met beyond it is met again in its own leaf, so the
            // nearest hit is final once the ray leaves the leaf no earlier than there.
            const bool found = best && kernel_.upper_t(*best) <= exit;
            if (!found) counter_.count_search();
            return found;
        });
        return best;
    }

    /// Starts in the leaf that holds the shadow ray's origin, which needs no search. [5.3.2]
    bool occluded(const typename Kernel::Shadow& shadow) {
        // Not left to the leaves: its rounded point may lie outside of all that list it.
        const bool by_itself = kernel_.blocks_itself(shadow);
        bool blocked = by_itself;
        start();
        walk_(kernel_.walk_ray(shadow.ray), shadow.end, [&](const Node& leaf, double exit) {
            counter_.count_leaf(leaf);
            if (by_itself) return true;
            blocked = is_crowd(leaf) ? blocked_by_crowd(shadow, leaf)
                                     : blocked_by(shadow, octree_.contents(leaf));
            if (blocked) return true;
            if (exit < shadow.end) counter_.count_search();
            return false;
        });
        return blocked;
    }

  private:
    // Only exact answers of one ray say anything about another.
    static constexpr bool kHasCrowds = std::is_same_v<typename Kernel::PreparedRay, ExactRay>;

    void start() {
        if (++ray_ != 0) return;
        std::fill(stamps_.begin(), stamps_.end(), 0);
        ray_ = 1;
    }
    bool is_new(ItemId item) { return std::exchange(stamps_[item], ray_) != ray_; }

    void test(const typename Kernel::PreparedRay& ray, std::span<const ItemId> items,
              std::optional<typename Kernel::Hit>& best) {
        for (const ItemId item : items)
            if (is_new(item)) kernel_.closest(ray, of_item(item), best);
    }
    bool blocked_by(const typename Kernel::Shadow& shadow, std::span<const ItemId> items) {
        for (const ItemId item : items)
            if (is_new(item) && kernel_.blocks(shadow, of_item(item))) return true;
        return false;
    }

    bool is_crowd(const Node& leaf) const {
        if constexpr (kHasCrowds)
            return leaf.item_count >= Crowd<Kernel>::kLeast &&
                   primitives_.item_count() == primitives_.sources.size();
        return false;
    }
    auto& crowd_of(const Node& leaf) {
        return crowds_.try_emplace(leaf.first_item, kernel_, primitives_, octree_.contents(leaf))
            .first->second;
    }
    void closest_in_crowd(const typename Kernel::PreparedRay& ray, const Node& leaf,
                          std::optional<typename Kernel::Hit>& best) {
        if constexpr (kHasCrowds) {
            Crowd<Kernel>& crowd = crowd_of(leaf);
            if (crowd.surely_missed(ray)) return;
            if (const auto* front = crowd.front(ray.origin())) {
                const auto hit = kernel_.hit_of(ray, front->first);
                counter_.count_primitives({front->first, front->first + 1});
                if (hit) {
                    if (!best || kernel_.precedes(ray, *hit, *best)) best = hit;
                    std::span<const ItemId> rivals = front->rivals;
                    if (rivals.size() > Crowd<Kernel>::kLeast)
                        if (const auto some = crowd.towards(ray.origin(), ray.direction()))
                            if (some->size() < rivals.size()) rivals = *some;
                    return test(ray, rivals, best);
                }
            }
            const auto before = best;
            std::size_t tests = 0;
            if (const auto some = crowd.towards(ray.origin(), ray.direction())) {
                tests = some->size();
                test(ray, *some, best);
            } else {
                crowd.boxes().visit(
                    ray, [&] { return best ? kernel_.upper_t(*best) : Kernel::kInfinity; },
                    [&](ItemId item) {
                        ++tests;
                        if (is_new(item)) kernel_.closest(ray, of_item(item), best);
                        return false;
                    });
            }
            if (best && (!before || best->primitive != before->primitive))
                crowd.won(ray.origin(), best->primitive, tests);
        }
    }
    bool blocked_by_crowd(const typename Kernel::Shadow& shadow, const Node& leaf) {
        if constexpr (kHasCrowds) {
            return crowd_of(leaf).blocked(shadow, [&](ItemId item) {
                return is_new(item) && kernel_.blocks(shadow, of_item(item));
            });
        }
        return false;
    }

    PrimitiveRange of_item(ItemId item) const {
        const PrimitiveRange range = primitives_.of_item(item);
        counter_.count_primitives(range);
        return range;
    }

    const Kernel& kernel_;
    const Primitives& primitives_;
    const Octree& octree_;
    ExactWalk<Locator> walk_;
    Counter counter_;
    // The ray that last met the item: no ray tests one twice, so that none costs more tests than
    // there are items. [Arnaldi, Priol and Bouatouch 1987]
    std::vector<std::uint32_t> stamps_;
    std::uint32_t ray_ = 0;
    struct None {};
    // By the leaf's first item.
    std::conditional_t<kHasCrowds, std::unordered_map<std::uint32_t, Crowd<Kernel>>, None> crowds_;
};

/// Through the octree as published: the first leaf with a hit inside its own bounds decides, and
/// hits outside the leaf are ignored. [thesis 5.4.3]
template <typename Kernel, typename Locator, typename Counter>
class NudgedSearch {
    using Scalar = typename Kernel::Scalar;

  public:
    NudgedSearch(const Kernel& kernel, const Primitives& primitives, const Octree& octree,
                 double step, Counter counter)
        : kernel_(kernel),
          primitives_(primitives),
          octree_(octree),
          walk_(octree, step),
          counter_(counter) {}

    std::optional<typename Kernel::Hit> closest(const typename Kernel::PreparedRay& ray) const {
        std::optional<typename Kernel::Hit> best;
        const RayT<Scalar> line(kernel_.nudged_ray(ray));
        walk(line, WalkStart::kRoot, [&](const Node& leaf) {
            for (ItemId item : octree_.contents(leaf)) {
                std::optional<typename Kernel::Hit> nearest;
                kernel_.closest(ray, of_item(item), nearest);
                if (nearest && inside(leaf, line, kernel_.t(*nearest)) &&
                    (!best || kernel_.t(*nearest) < kernel_.t(*best)))
                    best = nearest;
            }
            return best.has_value();
        });
        return best;
    }

    /// The first hit on the way decides: it blocks if it lies before the light. [thesis 5.3.2]
    bool occluded(const typename Kernel::Shadow& shadow) const {
        Scalar first = Kernel::kInfinity;
        const RayT<Scalar> line(kernel_.nudged_ray(shadow.ray));
        walk(line, WalkStart::kLeaf, [&](const Node& leaf) {
            for (ItemId item : octree_.contents(leaf)) {
                const Scalar nearest = kernel_.shadow_t(shadow, of_item(item));
                if (nearest < first && inside(leaf, line, nearest)) first = nearest;
            }
            return first < Kernel::kInfinity;
        });
        return first < shadow.end;
    }

  private:
    template <typename Visit>
    void walk(const RayT<Scalar>& line, WalkStart start, Visit&& visit) const {
        walk_(
            line, start, [&] { counter_.count_search(); },
            [&](const Node& leaf) {
                counter_.count_leaf(leaf);
                return visit(leaf);
            });
    }

    bool inside(const Node& leaf, const RayT<Scalar>& line, Scalar t) const {
        return decltype(walk_)::bounds_of(leaf)
            .inflated(static_cast<Scalar>(kPublishedEpsilon))
            .contains(line.at(t));
    }

    PrimitiveRange of_item(ItemId item) const {
        const PrimitiveRange range = primitives_.of_item(item);
        counter_.count_primitives(range);
        return range;
    }

    const Kernel& kernel_;
    const Primitives& primitives_;
    const Octree& octree_;
    NudgedWalk<Scalar, Locator> walk_;
    Counter counter_;
};

}  // namespace nuvo
