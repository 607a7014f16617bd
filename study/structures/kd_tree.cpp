#include <cmath>
#include <limits>
#include <numeric>

#include "structures/box_tree.h"

namespace nuvo::study {
namespace {

struct Plane {
    int axis = -1;
    double at = 0;
    double cost = 0;
};

/// The best plane by sorted edges; the boxes are inflated, and planes stand clear of edges.
Plane best_plane(const Bounds3& box, std::span<const Bounds3> items, double margin, double step) {
    Plane best;
    const double area = box.surface_area();
    best.cost = area * static_cast<double>(items.size());
    for (int axis = 0; axis < 3; ++axis) {
        const AxisEdges edges(items, axis);
        const auto consider = [&](double plane) {
            if (!(box.min[axis] < plane && plane < box.max[axis])) return;
            Bounds3 low = box, high = box;
            low.max[axis] = high.min[axis] = plane;
            const double cost = step * area +
                                low.surface_area() * static_cast<double>(edges.left_of(plane)) +
                                high.surface_area() * static_cast<double>(edges.right_of(plane));
            if (cost < best.cost) best = {axis, plane, cost};
        };
        for (const double begin : edges.begins()) consider(begin - 4 * margin);
        for (const double end : edges.ends()) consider(end + 4 * margin);
    }
    return best;
}

}  // namespace

KdTree::KdTree(std::span<const Bounds3> boxes, const OverlapTest& overlaps, double margin,
               double step)
    : boxes_(boxes), overlaps_(overlaps), margin_(margin), step_(step) {
    BoxNode root;
    for (const Bounds3& box : boxes) root.box = root.box.extended(box.inflated(margin));
    nodes_.push_back(root);
    std::vector<ItemId> all(boxes.size());
    std::iota(all.begin(), all.end(), ItemId{0});
    // 8 + 1.3 log2 n. [Pharr and Humphreys]
    build(0, std::move(all),
          8 + static_cast<int>(1.3 * std::log2(static_cast<double>(boxes.size()) + 1)));
}

void KdTree::build(std::uint32_t node, std::vector<ItemId> items, int depth_left) {
    const Bounds3 box = nodes_[node].box;
    std::vector<Bounds3> boxes;
    for (const ItemId item : items) boxes.push_back(boxes_[item].inflated(margin_));
    const Plane plane = depth_left > 0 ? best_plane(box, boxes, margin_, step_) : Plane{};
    if (plane.axis < 0) {
        nodes_[node].first = static_cast<std::uint32_t>(items_.size());
        nodes_[node].count = static_cast<std::uint32_t>(items.size());
        items_.insert(items_.end(), items.begin(), items.end());
        return;
    }
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = first;
    nodes_[node].leaf = false;
    for (int side = 0; side < 2; ++side) {
        BoxNode child{box};
        (side == 0 ? child.box.max : child.box.min)[plane.axis] = plane.at;
        nodes_.push_back(child);
    }
    for (std::uint32_t side = 0; side < 2; ++side) {
        const Bounds3 child = nodes_[first + side].box;
        std::vector<ItemId> inside;
        for (std::size_t i = 0; i < items.size(); ++i)
            if (boxes[i].overlaps(child) &&
                (!overlaps_ || overlaps_(items[i], child.inflated(margin_))))
                inside.push_back(items[i]);
        build(first + side, std::move(inside), depth_left - 1);
    }
}

}  // namespace nuvo::study
