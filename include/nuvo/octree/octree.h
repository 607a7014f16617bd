#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "nuvo/math/ray.h"
#include "nuvo/octree/label.h"
#include "nuvo/octree/voxel.h"

namespace nuvo {

/// Index of a leaf item: whatever the boxes given to the builder stand for.
using ItemId = std::uint32_t;
using NodeIndex = std::uint32_t;

struct Node {
    Voxel voxel;
    Label label = 0;
    NodeIndex first_child = 0;  ///< children 1..8 stand together; 0: a leaf
    std::uint32_t first_item = 0;
    std::uint32_t item_count = 0;

    constexpr bool is_leaf() const { return first_child == 0; }
    constexpr NodeIndex child(int digit) const {
        return first_child + static_cast<NodeIndex>(digit - 1);
    }
};

/// An octree over boxes, uniform or not: a value of flat arrays. Node 0 is the root.
/// [thesis 4.4, 5.4]
class Octree {
  public:
    Octree() = default;
    /// `depth_tried`: the deepest level at which a cut was tried, if it was noted.
    Octree(std::vector<Node> nodes, std::vector<ItemId> items, std::optional<int> depth_tried = {});

    std::span<const Node> nodes() const { return nodes_; }
    const Node& root() const { return nodes_[0]; }
    std::span<const ItemId> contents(const Node& leaf) const {
        return {items_.data() + leaf.first_item, leaf.item_count};
    }
    /// The thesis' "voxels".
    std::size_t leaf_count() const { return (nodes_.size() * 7 + 1) / 8; }
    /// Levels, the root's included: 1 for a tree that is one leaf.
    int depth() const { return depth_; }
    /// The published program's depth: the deepest level tried below the root, cuts that were taken
    /// back included. Known of trees built by its rules only.
    std::optional<int> depth_tried() const { return depth_tried_; }
    /// References to items over all leaves.
    std::size_t reference_count() const { return items_.size(); }
    /// Whether the builder's budget of references kept it from cuts that pay.
    bool out_of_budget() const { return out_of_budget_; }
    void set_out_of_budget(bool value) { out_of_budget_ = value; }
    /// Bytes of nodes, references and the hash map's entries, if there is one.
    std::size_t memory_bytes() const;

    /// Narrowest width of any leaf on any axis. [COMP1011 findMinSize; thesis 4.4.4]
    double smallest_width() const { return smallest_width_; }
    /// The leaf whose half-open voxel holds p, if p is in the root. [COMP1011 getLeafContaining]
    std::optional<NodeIndex> find_leaf(const Point3& p) const;
    /// A point just inside the next leaf on the ray's way out of the leaf that holds its origin:
    /// past the exit face by a step in proportion to the smallest leaf. [COMP1011 pointNextVoxel]
    Point3 point_next_voxel(const Ray& ray) const;

    /// The node of that name.
    std::optional<NodeIndex> find_name(Label label) const;
    /// Makes the hash map of names, for the walk that finds voxels by it. [thesis 5.4]
    void make_names();
    /// Empty until it is made.
    const std::unordered_map<Label, NodeIndex>& names() const { return names_; }

  private:
    std::vector<Node> nodes_;
    std::vector<ItemId> items_;
    std::unordered_map<Label, NodeIndex> names_;
    int depth_ = 0;
    std::optional<int> depth_tried_;
    double smallest_width_ = 0;
    bool out_of_budget_ = false;
};

/// The tree as text, a node a line, indented by level (the -showoctree flag).
void print(std::ostream& out, const Octree& octree);

}  // namespace nuvo
