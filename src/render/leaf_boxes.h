#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "nuvo/geometry/predicates.h"
#include "nuvo/octree/octree.h"

namespace nuvo {

/// A ray against boxes, by slabs whose bounds hold whatever the scales of the ray and of the boxes.
/// [Kay and Kajiya 1986; numerics: slabs]
class Slabs {
  public:
    explicit Slabs(const ExactRay& ray) : origin_(ray.origin()) {
        for (int axis = 0; axis < 3; ++axis) {
            const double d = ray.direction()[axis];
            inverse_[axis] = 1 / d;
            kind_[axis] = d == 0                          ? Kind::kParallel
                          : std::isnormal(inverse_[axis]) ? Kind::kCrosses
                                                          : Kind::kUnknown;
        }
    }

    /// No point of the box is met at 0 < t <= end.
    bool surely_missed(const Bounds3& box, double end) const {
        double first = 0;
        double last = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = box.min[axis] - origin_[axis];
            const double high = box.max[axis] - origin_[axis];
            if (kind_[axis] == Kind::kParallel && (low > 0 || high < 0)) return true;
            if (kind_[axis] != Kind::kCrosses) continue;
            const double s = low * inverse_[axis];
            const double t = high * inverse_[axis];
            // What is no number, for it has overflowed, bounds nothing.
            const double enters = lowered(s < t ? s : t);
            const double leaves = raised(s < t ? t : s);
            if (enters > first) first = enters;
            if (leaves < last) last = leaves;
        }
        return first > last;
    }

  private:
    enum class Kind : std::uint8_t { kCrosses, kParallel, kUnknown };
    // Difference, direction, reciprocal, product: four roundings, and one that may underflow.
    static double error(double t) { return gamma(6) * std::fabs(t) + 4 * kUnderflow; }
    static double lowered(double t) { return t - error(t); }
    static double raised(double t) { return t + error(t); }

    Point3 origin_;
    Vector3 inverse_;
    Kind kind_[3];
};

/// A bounding volume hierarchy of a leaf whose items no voxel parts: they are smaller than the
/// margin by which voxels overlap, as a thing in a scene many times as wide, or tangled. Halves by
/// number, so that it is as deep at any scale.
class LeafBoxes {
  public:
    LeafBoxes() = default;
    template <typename Boxes>
    LeafBoxes(std::span<const ItemId> items, const Boxes& boxes)
        : items_(items.begin(), items.end()) {
        build<true>(0, items_.size(), boxes);
    }
    /// Of those items of `all` of which `keeps(ItemId)` is true: in its order, which costs no sort.
    template <typename Boxes, typename Keeps>
    LeafBoxes(const LeafBoxes& all, const Boxes& boxes, Keeps&& keeps) {
        std::copy_if(all.items_.begin(), all.items_.end(), std::back_inserter(items_), keeps);
        build<false>(0, items_.size(), boxes);
    }

    std::span<const ItemId> items() const { return items_; }

    /// Calls visit(ItemId) for what the ray may meet at t <= end(), until it says true. `end` is
    /// asked for anew at each box. Returns whether it was said.
    template <typename End, typename Visit>
    bool visit(const ExactRay& ray, End&& end, Visit&& visit) const {
        const Slabs slabs(ray);
        for (std::size_t i = 0; i < nodes_.size();) {
            const BoxNode& node = nodes_[i];
            if (slabs.surely_missed(node.box, end())) {
                i = node.next;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.last; ++k)
                if (visit(items_[k])) return true;
            ++i;
        }
        return false;
    }

  private:
    static constexpr std::size_t kItems = 4;  // of a leaf of the hierarchy
    struct BoxNode {
        Bounds3 box;
        std::uint32_t first;  // items of a leaf; of others none
        std::uint32_t last;
        std::uint32_t next;  // the node after all below this one
    };

    template <bool kSorts, typename Boxes>
    void build(std::size_t first, std::size_t last, const Boxes& boxes) {
        const std::size_t index = nodes_.size();
        Bounds3 box;
        for (std::size_t k = first; k < last; ++k) box = box.extended(boxes[items_[k]]);
        const bool leaf = last - first <= kItems;
        nodes_.push_back({box, leaf ? static_cast<std::uint32_t>(first) : 0,
                          leaf ? static_cast<std::uint32_t>(last) : 0, 0});
        if (!leaf) {
            if constexpr (kSorts) part(first, last, boxes);
            build<kSorts>(first, (first + last) / 2, boxes);
            build<kSorts>((first + last) / 2, last, boxes);
        }
        nodes_[index].next = static_cast<std::uint32_t>(nodes_.size());
    }

    // Halves along the axis on which the centers lie furthest apart.
    template <typename Boxes>
    void part(std::size_t first, std::size_t last, const Boxes& boxes) {
        Bounds3 centers;
        for (std::size_t k = first; k < last; ++k)
            centers = centers.extended(boxes[items_[k]].center());
        const Vector3 w = centers.widths();
        const int axis = w.x >= w.y && w.x >= w.z ? 0 : w.y >= w.z ? 1 : 2;
        const auto at = [&](std::size_t k) {
            return items_.begin() + static_cast<std::ptrdiff_t>(k);
        };
        std::nth_element(at(first), at((first + last) / 2), at(last), [&](ItemId a, ItemId b) {
            const double x = boxes[a].center()[axis];
            const double y = boxes[b].center()[axis];
            return x != y ? x < y : a < b;
        });
    }

    std::vector<ItemId> items_;
    std::vector<BoxNode> nodes_;  // depth first
};

}  // namespace nuvo
