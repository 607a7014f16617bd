#include "wide_octree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>

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

// A voxel of the compact octree. forest[k - 1] is the least cost of what it holds as at most k
// leaves and nodes in lanes of a node above it.
struct Voxel {
    Bounds3T<float> box;
    std::uint32_t first = 0;  // of its items without repetition, if few enough for a leaf
    std::uint32_t count = 0;
    bool small = false;  // so few
    bool leaf = false;   // as one, it is a leaf rather than a node
    std::array<float, kWideLanes> forest;
};

class WideBuilder {
  public:
    WideBuilder(const FastScene& scene, WideOctree& out)
        : scene_(scene), octree_(scene.octree()), out_(out), voxels_(octree_.nodes.size()) {}

    void build() {
        measure(0, octree_.bounds);
        out_.nodes.emplace_back();
        std::vector<Inner> voxels;
        if (voxels_[0].leaf)
            voxels.push_back({0, 0, kFirstShift});
        else
            distribute({0, 0, kFirstShift + 3}, kWideLanes, voxels);
        fill(0, voxels);
        // The widest load begins at the last word.
        out_.leaves.resize(out_.leaves.size() + kWideLanes);
        out_.leaves.shrink_to_fit();
        out_.nodes.shrink_to_fit();
    }

  private:
    static constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();

    static float leaf_cost(const Voxel& voxel) {
        const auto blocks = static_cast<float>((voxel.count + kWideLanes - 1) / kWideLanes);
        return half_area(voxel.box) * (kLeafCost + kBlockCost * blocks);
    }

    // Fills in the voxels from this one down.
    void measure(std::uint32_t place, const Bounds3T<float>& bounds) {
        const CompactNode& node = octree_.nodes[place];
        Voxel& voxel = voxels_[place];
        if (node.is_leaf()) {
            voxel.first = static_cast<std::uint32_t>(items_.size());
            for (std::uint32_t i = 0; i < node.item_count(); ++i) {
                const Slot slot = octree_.items[node.first_item() + i];
                const Bounds3T<float> box = clipped_box(scene_, slot, bounds);
                if (box.empty()) continue;
                voxel.box = voxel.box.extended(box);
                items_.push_back(slot);
            }
            voxel.count = static_cast<std::uint32_t>(items_.size()) - voxel.first;
            voxel.small = voxel.leaf = true;
            voxel.forest.fill(leaf_cost(voxel));
            return;
        }
        for (unsigned octant = 0; octant < 8; ++octant) {
            if ((node.mask() >> octant & 1) == 0) continue;
            Bounds3T<float> inside = bounds;
            for (int axis = 0; axis < 3; ++axis)
                ((octant >> axis & 1U) != 0 ? inside.min : inside.max)[axis] = node.cut[axis];
            const std::uint32_t child = node.child(octant);
            measure(child, inside);
            voxel.box = voxel.box.extended(voxels_[child].box);
        }
        gather_items(node, voxel);
        const std::vector<Forest> sums = sums_of(node);
        voxel.forest = sums.back();
        const float as_node = half_area(voxel.box) * kNodeCost + voxel.forest[kWideLanes - 1];
        const float as_leaf =
            voxel.small ? leaf_cost(voxel) : std::numeric_limits<float>::infinity();
        voxel.leaf = as_leaf <= as_node;
        voxel.forest[0] = std::min(as_leaf, as_node);
        for (std::size_t k = 1; k < kWideLanes; ++k)
            voxel.forest[k] = std::min(voxel.forest[k], voxel.forest[k - 1]);
    }

    // The items of all octants without repetition, if they are few.
    void gather_items(const CompactNode& node, Voxel& voxel) {
        constexpr std::size_t kMostOfLeaf = 2 * kWideLanes;
        gathered_.clear();
        for (int i = 0; i < std::popcount(node.mask()); ++i) {
            const Voxel& child = voxels_[node.first_child() + static_cast<std::uint32_t>(i)];
            if (!child.small || gathered_.size() + child.count > 4 * kMostOfLeaf) return;
            const auto begin = items_.begin() + child.first;
            gathered_.insert(gathered_.end(), begin, begin + child.count);
        }
        std::sort(gathered_.begin(), gathered_.end());
        gathered_.erase(std::unique(gathered_.begin(), gathered_.end()), gathered_.end());
        if (gathered_.size() > kMostOfLeaf) return;
        voxel.small = true;
        voxel.first = static_cast<std::uint32_t>(items_.size());
        voxel.count = static_cast<std::uint32_t>(gathered_.size());
        items_.insert(items_.end(), gathered_.begin(), gathered_.end());
    }

    // sums[i][k - 1]: the least cost of the first i + 1 octants in at most k lanes; infinite where
    // k is too small.
    using Forest = std::array<float, kWideLanes>;
    std::vector<Forest> sums_of(const CompactNode& node) const {
        std::vector<Forest> sums;
        const int octants = std::popcount(node.mask());
        for (int i = 0; i < octants; ++i) {
            const Forest& forest =
                voxels_[node.first_child() + static_cast<std::uint32_t>(i)].forest;
            if (i == 0) {
                sums.push_back(forest);
                continue;
            }
            Forest next;
            next.fill(std::numeric_limits<float>::infinity());
            const Forest& before = sums.back();
            for (std::size_t j = static_cast<std::size_t>(i) - 1; j + 1 < kWideLanes; ++j)
                for (std::size_t k = 0; j + k + 1 < kWideLanes; ++k)
                    next[j + k + 1] = std::min(next[j + k + 1], before[j] + forest[k]);
            sums.push_back(next);
        }
        return sums;
    }

    // A voxel in a node, and the way to it from the node's own: three bits an octant, the first
    // ones highest.
    struct Inner {
        std::uint32_t place;
        std::uint64_t way;
        int shift;  // of the way's last octant
    };
    static constexpr int kFirstShift = 60;

    // Appends the octants of a voxel, or what stands for them, in at most `lanes` lanes.
    void distribute(const Inner& voxel, std::size_t lanes, std::vector<Inner>& out) const {
        const CompactNode& node = octree_.nodes[voxel.place];
        const std::vector<Forest> sums = sums_of(node);
        unsigned rest = node.mask();
        for (std::size_t i = sums.size(); i-- > 0;) {
            const auto octant = static_cast<unsigned>(31 - std::countl_zero(rest));
            rest &= ~(1U << octant);
            const std::uint32_t child = node.child(octant);
            std::size_t share = lanes;
            if (i > 0) {
                share = 1;
                for (std::size_t k = 1; k + i <= lanes; ++k)
                    if (sums[i - 1][lanes - k - 1] + voxels_[child].forest[k - 1] <
                        sums[i - 1][lanes - share - 1] + voxels_[child].forest[share - 1])
                        share = k;
            }
            lanes -= share;
            const int shift = voxel.shift - 3;
            put({child, voxel.way | static_cast<std::uint64_t>(octant) << shift, shift}, share,
                out);
        }
    }
    void put(const Inner& voxel, std::size_t lanes, std::vector<Inner>& out) const {
        const Voxel& v = voxels_[voxel.place];
        if (v.box.empty()) return;
        // As one wherever that costs no more.
        const bool one = v.leaf ? v.forest[lanes - 1] >= v.forest[0]
                                : v.forest[lanes - 1] >= v.forest[0] || voxel.shift < 3;
        if (one || octree_.nodes[voxel.place].is_leaf())
            out.push_back(voxel);
        else
            distribute(voxel, lanes, out);
    }

    // Octants from near to far are in the order of their numbers, each bit turned where the ray
    // goes downwards.
    static void put_orders(const std::vector<Inner>& voxels, WideNode& node) {
        std::array<std::uint32_t, kWideLanes> lanes;
        for (std::uint64_t signs = 0; signs < 8; ++signs) {
            constexpr std::uint64_t kEachOctant = 0x1249249249249249;  // bit 0 of three
            const std::uint64_t turned = signs * kEachOctant;
            std::iota(lanes.begin(), lanes.end(), 0U);
            std::sort(lanes.begin(), lanes.begin() + static_cast<std::ptrdiff_t>(voxels.size()),
                      [&](std::uint32_t a, std::uint32_t b) {
                          return (voxels[a].way ^ turned) < (voxels[b].way ^ turned);
                      });
            for (std::size_t i = 0; i < kWideLanes; ++i)
                node.order[signs][i % 2] |= lanes[i] << (4 * (i / 2));
        }
    }

    void fill(std::size_t place, const std::vector<Inner>& voxels) {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        put_orders(voxels, out_.nodes[place]);
        for (std::size_t lane = 0; lane < kWideLanes; ++lane) {
            const Bounds3T<float> box =
                lane < voxels.size() ? voxels_[voxels[lane].place].box : Bounds3T<float>{};
            for (int axis = 0; axis < 3; ++axis) {
                out_.nodes[place].low[axis][lane] = box.empty() ? kInfinity : box.min[axis];
                out_.nodes[place].high[axis][lane] = box.empty() ? -kInfinity : box.max[axis];
            }
        }
        for (std::size_t lane = 0; lane < voxels.size(); ++lane) {
            const Voxel& voxel = voxels_[voxels[lane].place];
            if (!voxel.leaf) continue;
            const std::span<const Slot> slots(items_.data() + voxel.first, voxel.count);
            out_.nodes[place].child[lane] =
                append_leaf(scene_, slots, out_.leaves) | WideOctree::kLeaf;
        }
        for (std::size_t lane = 0; lane < voxels.size(); ++lane) {
            if (voxels_[voxels[lane].place].leaf) continue;
            const std::size_t next = out_.nodes.size();
            out_.nodes.emplace_back();
            out_.nodes[place].child[lane] = static_cast<std::uint32_t>(next);
            std::vector<Inner> inside;
            distribute({voxels[lane].place, 0, kFirstShift + 3}, kWideLanes, inside);
            fill(next, inside);
        }
    }

    const FastScene& scene_;
    const CompactOctree& octree_;
    WideOctree& out_;
    std::vector<Voxel> voxels_;  // by place in the octree
    std::vector<Slot> items_;
    std::vector<Slot> gathered_;
};

}  // namespace

WideOctree::WideOctree(const FastScene& scene) {
    const auto& [low, high] = scene.octree().bounds;
    for (int axis = 0; axis < 3; ++axis)
        reach = std::max(reach, std::max(std::fabs(low[axis]), std::fabs(high[axis])));
    WideBuilder(scene, *this).build();
}

}  // namespace nuvo
