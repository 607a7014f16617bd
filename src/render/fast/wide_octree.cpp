#include "wide_octree.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "wide_leaf.h"

// From the compact octree, in two passes. The first goes up: boxes from what the leaves hold, and
// by the surface area heuristic over these boxes whether a subtree should be a leaf. The second
// goes down: the voxels of a node are replaced by their octants, the largest first, while there are
// no more than 16.

namespace nuvo {
namespace {

// Prices of a step through a node, of reaching a leaf and of a register of primitives there,
// measured on random rays.
constexpr float kNodeCost = 1;
constexpr float kLeafCost = 0.75F;
constexpr float kBlockCost = 0.75F;

float half_area(const Bounds3T<float>& box) {
    if (box.empty()) return 0;
    const Vec3<float> w = box.widths();
    return w.x * w.y + w.y * w.z + w.z * w.x;
}

class WideBuilder {
  public:
    WideBuilder(const FastScene& scene, WideOctree& out)
        : scene_(scene), octree_(scene.octree()), out_(out), voxels_(octree_.nodes.size()) {}

    void build() {
        const float cost = measure(0, octree_.bounds);
        static_cast<void>(cost);
        out_.nodes.emplace_back();
        if (voxels_[0].leaf)
            fill(0, {0});
        else
            fill(0, children_of(0));
        // The widest load begins at the last word.
        out_.leaves.resize(out_.leaves.size() + kWideLanes);
        out_.leaves.shrink_to_fit();
        out_.nodes.shrink_to_fit();
    }

  private:
    struct Voxel {
        Bounds3T<float> box;
        bool leaf = false;
        std::uint32_t first = 0;  // of the leaf's items
        std::uint32_t count = 0;
    };

    static float leaf_cost(const Bounds3T<float>& box, std::size_t count) {
        const auto blocks = static_cast<float>((count + kWideLanes - 1) / kWideLanes);
        return half_area(box) * (kLeafCost + kBlockCost * blocks);
    }

    // Fills in the voxels from this one down; the subtree's items come to stand at the end of
    // items_, without repetition if it is a leaf.
    float measure(std::uint32_t place, const Bounds3T<float>& bounds) {
        const CompactNode& node = octree_.nodes[place];
        Voxel& voxel = voxels_[place];
        voxel.first = static_cast<std::uint32_t>(items_.size());
        if (node.is_leaf()) {
            voxel.leaf = true;
            for (std::uint32_t i = 0; i < node.item_count(); ++i) {
                const Slot slot = octree_.items[node.first_item() + i];
                const Bounds3T<float> box = clipped_box(scene_, slot, bounds);
                if (box.empty()) continue;
                voxel.box = voxel.box.extended(box);
                items_.push_back(slot);
            }
            voxel.count = static_cast<std::uint32_t>(items_.size()) - voxel.first;
            return leaf_cost(voxel.box, voxel.count);
        }
        float cost = 0;
        bool leaves = true;
        for (unsigned octant = 0; octant < 8; ++octant) {
            if ((node.mask() >> octant & 1) == 0) continue;
            Bounds3T<float> inside = bounds;
            for (int axis = 0; axis < 3; ++axis)
                ((octant >> axis & 1U) != 0 ? inside.min : inside.max)[axis] = node.cut[axis];
            const std::uint32_t child = node.child(octant);
            cost += measure(child, inside);
            leaves &= voxels_[child].leaf;
            voxel.box = voxel.box.extended(voxels_[child].box);
        }
        cost += kNodeCost * half_area(voxel.box);
        return leaves ? std::min(cost, as_leaf(voxel, cost)) : cost;
    }

    // Makes a leaf of a voxel with leaves below it if that is cheaper.
    float as_leaf(Voxel& voxel, float cost) {
        merged_.assign(items_.begin() + voxel.first, items_.end());
        std::sort(merged_.begin(), merged_.end());
        merged_.erase(std::unique(merged_.begin(), merged_.end()), merged_.end());
        const float merged_cost = leaf_cost(voxel.box, merged_.size());
        if (merged_cost > cost) return cost;
        voxel.leaf = true;
        voxel.count = static_cast<std::uint32_t>(merged_.size());
        items_.resize(voxel.first);
        items_.insert(items_.end(), merged_.begin(), merged_.end());
        return merged_cost;
    }

    std::vector<std::uint32_t> children_of(std::uint32_t place) const {
        const CompactNode& node = octree_.nodes[place];
        std::vector<std::uint32_t> children;
        for (int i = 0; i < std::popcount(node.mask()); ++i) {
            const std::uint32_t child = node.first_child() + static_cast<std::uint32_t>(i);
            if (!voxels_[child].box.empty()) children.push_back(child);
        }
        return children;
    }

    // Replaces the largest voxel by its octants while that leaves at most 16.
    void open(std::vector<std::uint32_t>& voxels) const {
        for (;;) {
            std::size_t widest = voxels.size();
            float area = -1;
            for (std::size_t i = 0; i < voxels.size(); ++i) {
                const Voxel& voxel = voxels_[voxels[i]];
                if (voxel.leaf || half_area(voxel.box) <= area) continue;
                const CompactNode& node = octree_.nodes[voxels[i]];
                if (voxels.size() - 1 + static_cast<std::size_t>(std::popcount(node.mask())) >
                    kWideLanes)
                    continue;
                widest = i;
                area = half_area(voxel.box);
            }
            if (widest == voxels.size()) return;
            const std::vector<std::uint32_t> inside = children_of(voxels[widest]);
            voxels.erase(voxels.begin() + static_cast<std::ptrdiff_t>(widest));
            voxels.insert(voxels.begin() + static_cast<std::ptrdiff_t>(widest), inside.begin(),
                          inside.end());
        }
    }

    void fill(std::size_t place, std::vector<std::uint32_t> voxels) {
        open(voxels);
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        std::vector<std::size_t> interior(kWideLanes, 0);
        for (std::size_t lane = 0; lane < kWideLanes; ++lane) {
            const bool used = lane < voxels.size();
            std::uint32_t child = 0;
            if (used && voxels_[voxels[lane]].leaf) {
                const Voxel& voxel = voxels_[voxels[lane]];
                const std::span<const Slot> slots(items_.data() + voxel.first, voxel.count);
                child = append_leaf(scene_, slots, out_.leaves) | WideOctree::kLeaf;
            } else if (used) {
                child = static_cast<std::uint32_t>(out_.nodes.size());
                interior[lane] = child;
                out_.nodes.emplace_back();
            }
            WideNode& node = out_.nodes[place];
            node.child[lane] = child;
            for (int axis = 0; axis < 3; ++axis) {
                node.low[axis][lane] = used ? voxels_[voxels[lane]].box.min[axis] : kInfinity;
                node.high[axis][lane] = used ? voxels_[voxels[lane]].box.max[axis] : -kInfinity;
            }
        }
        for (std::size_t lane = 0; lane < voxels.size(); ++lane)
            if (interior[lane] != 0) fill(interior[lane], children_of(voxels[lane]));
    }

    const FastScene& scene_;
    const CompactOctree& octree_;
    WideOctree& out_;
    std::vector<Voxel> voxels_;  // by place in the octree
    std::vector<Slot> items_;
    std::vector<Slot> merged_;
};

}  // namespace

WideOctree::WideOctree(const FastScene& scene) {
    const auto& [low, high] = scene.octree().bounds;
    for (int axis = 0; axis < 3; ++axis)
        reach = std::max(reach, std::max(std::fabs(low[axis]), std::fabs(high[axis])));
    WideBuilder(scene, *this).build();
}

}  // namespace nuvo
