#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

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
    void count_tests(std::size_t) const {}
    void count_search() const {}
    void count_primitives(PrimitiveRange) const {}
};

/// Counts as the thesis does.
struct EventCounter {
    TraceCounts* counts;
    std::uint64_t* primitives;  // of those leaf items
    void count_tests(std::size_t n) const { counts->intersection_tests += n; }
    void count_search() const { ++counts->voxel_searches; }
    void count_primitives(PrimitiveRange range) const { *primitives += range.last - range.first; }
};

/// Every primitive against every ray.
template <typename Kernel>
class BruteForceSearch {
  public:
    BruteForceSearch(const Kernel& kernel, const Primitives& primitives)
        : kernel_(kernel), all_(primitives.all()) {}

    std::optional<typename Kernel::Hit> closest(const typename Kernel::PreparedRay& ray) const {
        std::optional<typename Kernel::Hit> best;
        kernel_.closest(ray, all_, best);
        return best;
    }
    bool occluded(const typename Kernel::Shadow& shadow) const {
        return kernel_.blocks(shadow, all_);
    }

  private:
    const Kernel& kernel_;
    PrimitiveRange all_;
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
            counter_.count_tests(leaf.item_count);
            for (ItemId item : octree_.contents(leaf))
                if (is_new(item)) kernel_.closest(ray, of_item(item), best);
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
            counter_.count_tests(leaf.item_count);
            if (by_itself) return true;
            for (ItemId item : octree_.contents(leaf)) {
                if (!is_new(item)) continue;
                blocked = kernel_.blocks(shadow, of_item(item));
                if (blocked) return true;
            }
            if (exit < shadow.end) counter_.count_search();
            return false;
        });
        return blocked;
    }

  private:
    void start() {
        if (++ray_ != 0) return;
        std::fill(stamps_.begin(), stamps_.end(), 0);
        ray_ = 1;
    }
    bool is_new(ItemId item) { return std::exchange(stamps_[item], ray_) != ray_; }

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
        walk(line, [&](const Node& leaf) {
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
        walk(line, [&](const Node& leaf) {
            for (ItemId item : octree_.contents(leaf)) {
                const Scalar nearest = kernel_.shadow_t(shadow, of_item(item));
                if (nearest < first && inside(leaf, line, nearest)) first = nearest;
            }
            return first < Kernel::kInfinity;
        });
        return first < shadow.end;
    }

  private:
    // Slack of the bounds check, in scene units: the thesis' epsilon. [5.5]
    static constexpr Scalar kTolerance = static_cast<Scalar>(1e-6);

    template <typename Visit>
    void walk(const RayT<Scalar>& line, Visit&& visit) const {
        walk_(
            line, [&] { counter_.count_search(); },
            [&](const Node& leaf) {
                counter_.count_tests(leaf.item_count);
                return visit(leaf);
            });
    }

    bool inside(const Node& leaf, const RayT<Scalar>& line, Scalar t) const {
        return decltype(walk_)::bounds_of(leaf).inflated(kTolerance).contains(line.at(t));
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
