#include "published.h"

#include <algorithm>
#include <numeric>

namespace nuvo {
namespace {

// The program's areas and sums in float. It was compiled with -Ofast, which takes the width that
// two of the three products share out of them; written so, its trees come out without that flag.
float area_of(const Bounds3& box) {
    const Vec3<float> w(box.widths());
    return 2 * (w.x * (w.z + w.y) + w.z * w.y);
}

void add_leaf(SahTotals& totals, float area, std::size_t items) {
    totals.leaf_area += area;
    totals.leaf_area_objects += area * static_cast<float>(items);
    ++totals.leaves;
}

void take_leaf(SahTotals& totals, float area, std::size_t items) {
    totals.leaf_area -= area;
    totals.leaf_area_objects -= area * static_cast<float>(items);
    --totals.leaves;
}

}  // namespace

PublishedBuilder::PublishedBuilder(std::span<const Bounds3> boxes, const BuildOptions& options,
                                   const ThesisCosts& costs)
    : options_(options), costs_(costs), cutter_(boxes, options) {
    nodes_.push_back({sized_root(boxes)});
}

Octree PublishedBuilder::build() {
    root_area_ = area_of(nodes_[0].voxel.bounds);
    Items all(cutter_.item_count());
    std::iota(all.begin(), all.end(), ItemId{0});
    add_leaf(totals_, root_area_, all.size());
    references_ = all.size();
    begin_progress(options_, references_);
    subdivide(0, all);
    return Octree(std::move(nodes_), std::move(leaf_items_), depth_tried_);
}

// When it is sized; when it is cut it gets another midpoint, found from this one.
Voxel PublishedBuilder::sized_root(std::span<const Bounds3> boxes) const {
    Voxel root = Voxel::centered(cutter_.root());
    const std::optional<Point3> midpoint = options_.midpoint({root, boxes, options_.margin});
    if (midpoint) root.midpoint = *midpoint;
    return root;
}

void PublishedBuilder::subdivide(NodeIndex index, const Items& items) {
    std::optional<TrialCut> cut = kept_cut(nodes_[index], items);
    if (!cut) {
        nodes_[index].first_item = static_cast<std::uint32_t>(leaf_items_.size());
        nodes_[index].item_count = static_cast<std::uint32_t>(items.size());
        leaf_items_.insert(leaf_items_.end(), items.begin(), items.end());
        return;
    }
    const Label label = nodes_[index].label;
    nodes_[index].voxel = cut->voxel;
    nodes_[index].first_child = static_cast<NodeIndex>(nodes_.size());
    for (int digit = 1; digit <= 8; ++digit)
        nodes_.push_back({Voxel::centered(cut->voxel.octant(digit)), child_label(label, digit)});
    for (int digit = 1; digit <= 8; ++digit) {
        Items& octant = cut->octants[static_cast<std::size_t>(digit - 1)];
        subdivide(nodes_[index].child(digit), octant);
        octant = {};
    }
}

std::optional<TrialCut> PublishedBuilder::kept_cut(const Node& node, const Items& items) {
    const int digits = label_digits(node.label);
    if (digits + 1 >= options_.max_depth) return std::nullopt;
    if (items.empty() || references_ >= options_.max_references) return std::nullopt;
    std::optional<TrialCut> trial = cutter_.cut(node.voxel, items);
    if (!trial) return std::nullopt;
    depth_tried_ = std::max(depth_tried_, digits + 1);
    SahTotals after = totals_;
    const float area = area_of(node.voxel.bounds);
    after.interior_area += area;
    take_leaf(after, area, items.size());
    for (int digit = 1; digit <= 8; ++digit)
        add_leaf(after, area_of(trial->voxel.octant(digit)),
                 trial->octants[static_cast<std::size_t>(digit - 1)].size());
    if (!(costs_.of_tree(after, root_area_) < costs_.of_tree(totals_, root_area_)))
        return std::nullopt;
    totals_ = after;
    references_ += trial->references();
    references_ -= items.size();
    add(options_.progress, trial->references() - items.size());
    return trial;
}

}  // namespace nuvo
