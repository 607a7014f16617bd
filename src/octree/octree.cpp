#include "nuvo/octree/octree.h"
#include "nuvo/math/error_bounds.h"

#include <algorithm>
#include <ostream>
#include <string>

namespace nuvo {
namespace {

// Buckets of the hash map are kept this full at most [thesis 5.4].
constexpr float kMaxLoadFactor = 0.5F;

}  // namespace

Octree::Octree(std::vector<Node> nodes, std::vector<ItemId> items, std::optional<int> depth_tried)
    : nodes_(std::move(nodes)), items_(std::move(items)), depth_tried_(depth_tried) {
    smallest_width_ = kInfinity;
    for (NodeIndex i = 0; i < nodes_.size(); ++i) {
        const Node& node = nodes_[i];
        depth_ = std::max(depth_, label_digits(node.label) + 1);
        if (!node.is_leaf()) continue;
        const Vector3 w = node.voxel.bounds.widths();
        for (int axis = 0; axis < 3; ++axis)
            if (w[axis] > 0) smallest_width_ = std::min(smallest_width_, w[axis]);
    }
    if (smallest_width_ == kInfinity) smallest_width_ = 0;
}

std::size_t Octree::memory_bytes() const {
    // An entry of the standard library's map: key, value and the chain's pointer.
    const std::size_t entry = sizeof(std::pair<const Label, NodeIndex>) + sizeof(void*);
    return nodes_.size() * sizeof(Node) + items_.size() * sizeof(ItemId) + names_.size() * entry +
           names_.bucket_count() * sizeof(void*);
}

std::optional<NodeIndex> Octree::find_leaf(const Point3& p) const {
    if (nodes_.empty() || !root().voxel.contains(p)) return std::nullopt;
    NodeIndex index = 0;
    while (!nodes_[index].is_leaf()) index = nodes_[index].child(nodes_[index].voxel.octant_of(p));
    return index;
}

Point3 Octree::point_next_voxel(const Ray& ray) const {
    const std::optional<NodeIndex> leaf = find_leaf(ray.origin);
    if (!leaf) return ray.origin;
    const Bounds3& box = nodes_[*leaf].voxel.bounds;
    double exit = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d != 0)
            exit = std::min(exit, ((d > 0 ? box.max : box.min)[axis] - ray.origin[axis]) / d);
    }
    // Half the narrowest leaf, measured along the ray's longest component: past the face, and not
    // past the leaf behind it.
    return ray.at(exit + 0.5 * smallest_width_ / max_norm(ray.direction));
}

std::optional<NodeIndex> Octree::find_name(Label label) const {
    if (label == 0) return 0;
    const std::optional<NodeIndex> parent = find_name(parent_label(label));
    const int digit = static_cast<int>(label % 10);
    if (!parent || nodes_[*parent].is_leaf() || digit < 1 || digit > 8) return std::nullopt;
    return nodes_[*parent].child(digit);
}

void Octree::make_names() {
    names_.max_load_factor(kMaxLoadFactor);
    names_.reserve(nodes_.size());
    for (NodeIndex i = 0; i < nodes_.size(); ++i) names_.emplace(nodes_[i].label, i);
}

void print(std::ostream& out, const Octree& octree) {
    // Depth first in label order; a stack of nodes instead of recursion.
    std::vector<NodeIndex> open{0};
    while (!open.empty()) {
        const Node& node = octree.nodes()[open.back()];
        open.pop_back();
        const Bounds3& box = node.voxel.bounds;
        out << std::string(static_cast<std::size_t>(2 * label_digits(node.label)), ' ')
            << node.label << (node.is_leaf() ? " leaf" : " node") << " [" << box.min.x << ' '
            << box.min.y << ' ' << box.min.z << "] [" << box.max.x << ' ' << box.max.y << ' '
            << box.max.z << ']';
        if (node.is_leaf()) {
            out << ' ' << node.item_count << " items";
            for (ItemId item : octree.contents(node)) out << ' ' << item;
        } else {
            const Point3& m = node.voxel.midpoint;
            out << " midpoint [" << m.x << ' ' << m.y << ' ' << m.z << ']';
            for (int digit = 8; digit >= 1; --digit) open.push_back(node.child(digit));
        }
        out << '\n';
    }
}

}  // namespace nuvo
