#include "nuvo/octree/build.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nuvo {
namespace {

using Items = std::vector<ItemId>;

// A voxel thinner than this many units in the last place of its coordinates is not cut: each half
// must still hold points that differ from its faces.
constexpr double kThinnestCutUlps = 8;

bool thin(const Bounds3& box, int axis) {
    const double size = std::fmax(std::fabs(box.min[axis]), std::fabs(box.max[axis]));
    const double ulp = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
    return !(box.max[axis] - box.min[axis] > kThinnestCutUlps * ulp);
}

class Builder {
  public:
    Builder(std::span<const Bounds3> boxes, const BuildOptions& options) : options_(options) {
        boxes_.reserve(boxes.size());
        for (const Bounds3& box : boxes) boxes_.push_back(box.inflated(options.margin));
    }

    Octree build() {
        Bounds3 root;
        for (const Bounds3& box : boxes_) root = root.extended(box);
        if (root.empty()) root = {{0, 0, 0}, {0, 0, 0}};
        nodes_.push_back({Voxel::centered(root)});
        root_area_ = root.surface_area();
        Items all(boxes_.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<ItemId>(i);
        totals_ = {0, root_area_, root_area_ * static_cast<double>(all.size()), 1};
        references_ = all.size();
        subdivide(0, all);
        return Octree(std::move(nodes_), std::move(leaf_items_));
    }

  private:
    // [thesis 4.4.2]
    void subdivide(NodeIndex index, const Items& items) {
        std::array<Items, 8> children;
        if (!split(index, items, children)) {
            nodes_[index].first_item = static_cast<std::uint32_t>(leaf_items_.size());
            nodes_[index].item_count = static_cast<std::uint32_t>(items.size());
            leaf_items_.insert(leaf_items_.end(), items.begin(), items.end());
            return;
        }
        for (int digit = 1; digit <= 8; ++digit) {
            Items& child = children[static_cast<std::size_t>(digit - 1)];
            subdivide(nodes_[index].child(digit), child);
            child = {};
        }
    }

    // Cuts the node, unless that is not allowed, not possible or not worth it. [4.4.3, appendix D]
    bool split(NodeIndex index, const Items& items, std::array<Items, 8>& children) {
        const Label label = nodes_[index].label;
        const int digits = label_digits(label);
        if (digits >= kMaxLabelDigits || digits + 1 >= options_.max_depth) return false;
        if (references_ >= options_.max_references) return false;
        if (const auto* rule = std::get_if<MaxObjects>(&options_.worth))
            if (items.size() <= rule->count) return false;
        Voxel voxel = nodes_[index].voxel;
        const std::optional<Point3> midpoint = choose_midpoint(voxel, items);
        if (!midpoint) return false;
        voxel.midpoint = *midpoint;

        SahTotals after = totals_;
        after.interior_area += voxel.bounds.surface_area();
        after.leaf_area -= voxel.bounds.surface_area();
        after.leaf_area_objects -= voxel.bounds.surface_area() * static_cast<double>(items.size());
        after.leaves += 7;
        for (int digit = 1; digit <= 8; ++digit) {
            const Bounds3 box = voxel.octant(digit);
            Items& child = children[static_cast<std::size_t>(digit - 1)];
            distribute(box, items, child);
            after.leaf_area += box.surface_area();
            after.leaf_area_objects += box.surface_area() * static_cast<double>(child.size());
        }
        if (!worth_it(after, items, children)) return false;

        totals_ = after;
        for (const Items& child : children) references_ += child.size();
        references_ -= items.size();
        nodes_[index].voxel = voxel;
        nodes_[index].first_child = static_cast<NodeIndex>(nodes_.size());
        for (int digit = 1; digit <= 8; ++digit)
            nodes_.push_back({Voxel::centered(voxel.octant(digit)), child_label(label, digit)});
        return true;
    }

    std::optional<Point3> choose_midpoint(const Voxel& voxel, const Items& items) {
        query_boxes_.clear();
        for (ItemId id : items) query_boxes_.push_back(boxes_[id]);
        std::optional<Point3> midpoint = options_.midpoint({voxel, query_boxes_, options_.margin});
        if (!midpoint) return midpoint;
        int cut_axes = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (thin(voxel.bounds, axis))
                (*midpoint)[axis] = voxel.bounds.max[axis];
            else
                ++cut_axes;
        }
        if (cut_axes == 0) return std::nullopt;
        return midpoint;
    }

    void distribute(const Bounds3& box, const Items& items, Items& child) const {
        if (options_.margin > 0 && empty_slab(box)) return;
        // The overlap test sees the voxel grown by the margin; the boxes are grown already.
        const Bounds3 grown = box.inflated(options_.margin);
        for (ItemId id : items)
            if (boxes_[id].overlaps(box) && (!options_.overlaps || options_.overlaps(id, grown)))
                child.push_back(id);
    }

    // The far half of an axis that was not cut: its neighbour lists all that is near it.
    static bool empty_slab(const Bounds3& box) {
        return box.min.x == box.max.x || box.min.y == box.max.y || box.min.z == box.max.z;
    }

    bool worth_it(const SahTotals& after, const Items& items,
                  const std::array<Items, 8>& children) const {
        if (const auto* costs = std::get_if<CostModel>(&options_.worth))
            return sah(after, root_area_, (*costs)(after.leaves)) <
                   sah(totals_, root_area_, (*costs)(totals_.leaves));
        // Without a price, a cut that leaves every item in two or more octants gains nothing.
        return std::count_if(children.begin(), children.end(),
                             [&](const Items& child) { return child.size() == items.size(); }) < 2;
    }

    const BuildOptions& options_;
    std::vector<Bounds3> boxes_;
    std::vector<Bounds3> query_boxes_;
    std::vector<Node> nodes_;
    Items leaf_items_;
    SahTotals totals_;
    std::size_t references_ = 0;  // of all leaves so far
    double root_area_ = 0;
};

}  // namespace

Octree build_octree(std::span<const Bounds3> boxes, const BuildOptions& options) {
    return Builder(boxes, options).build();
}

SahTotals sah_totals(const Octree& octree) {
    SahTotals totals;
    for (const Node& node : octree.nodes()) {
        const double area = node.voxel.bounds.surface_area();
        if (node.is_leaf()) {
            totals.leaf_area += area;
            totals.leaf_area_objects += area * node.item_count;
            ++totals.leaves;
        } else {
            totals.interior_area += area;
        }
    }
    return totals;
}

}  // namespace nuvo
