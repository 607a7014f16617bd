#pragma once

#include <array>

#include "nuvo/octree/build.h"
#include "structures/structure.h"

namespace nuvo::study {

/// A uniform grid of about `density` cells an item, walked cell by cell. [Amanatides and Woo 1987]
class Grid {
  public:
    /// `margin` covers the walk's rounding: items are listed where they come this near.
    Grid(std::span<const Bounds3> boxes, const OverlapTest& overlaps, double margin,
         double density);

    template <typename Limit, typename Leaf>
    void visit(const Ray& ray, const Limit& limit, Work&, const Leaf& leaf) const {
        const auto entry = detail::slab_entry(ray, box_);
        if (!entry) return;
        std::array<int, 3> cell{};
        std::array<double, 3> next{};
        const Point3 start = ray.at(entry->t);
        for (int k = 0; k < 3; ++k) {
            cell[k] = cell_of(k, start[k]);
            next[k] = crossing(ray, k, cell[k]);
        }
        double before = entry->before();
        while (before <= limit()) {
            if (leaf(contents(cell))) return;
            const int k =
                next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
            before = next[k] * (1 - 8 * kUnitRoundoff);
            cell[k] += ray.direction[k] > 0 ? 1 : -1;
            if (cell[k] < 0 || cell[k] >= cells_[k]) return;
            next[k] = crossing(ray, k, cell[k]);
        }
    }
    Sizes sizes() const;

  private:
    int cell_of(int axis, double at) const;
    double face(int axis, int index) const { return box_.min[axis] + width_[axis] * index; }
    double crossing(const Ray& ray, int axis, int cell) const {
        const double d = ray.direction[axis];
        if (d == 0) return std::numeric_limits<double>::infinity();
        return (face(axis, cell + (d > 0 ? 1 : 0)) - ray.origin[axis]) / d;
    }
    std::size_t index_of(const std::array<int, 3>& cell) const {
        return static_cast<std::size_t>((cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0]);
    }
    std::span<const ItemId> contents(const std::array<int, 3>& cell) const {
        const std::size_t i = index_of(cell);
        return std::span(items_).subspan(first_[i], first_[i + 1] - first_[i]);
    }

    Bounds3 box_;
    Vector3 width_;
    std::array<int, 3> cells_{};
    std::vector<std::uint32_t> first_;  // of each cell, and the end
    std::vector<ItemId> items_;
};

}  // namespace nuvo::study
