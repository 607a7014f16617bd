#include "fast/rays/wide_octree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "fast/rays/wide_leaf.h"
#include "nuvo/math/error_bounds.h"

// From the compact octree, in two passes. The first goes up: tight boxes from what the leaves hold,
// and by the surface area heuristic over these boxes what a voxel costs as a leaf, as a node, and
// as part of a node above it that has so many lanes left (Ylitie, Karras and Laine 2017, "Efficient
// incoherent ray traversal on GPUs through compressed wide BVHs", section 3.1). The second goes
// down and takes the cheapest.
//
// What counts are the boxes, not the voxels: a ray that meets a primitive meets the box of a leaf
// that lists it, and all boxes around that, no later. So a primitive that is small against its
// leaves need stand in one of them only, whose box then holds all of it; of a large one each leaf
// lists the part in its voxel.

namespace nuvo {
namespace {

// Prices of a step through a node, of reaching a leaf and of a register of primitives there,
// measured on random rays. What all of the structure weighs when it has as many bytes as the
// primitives would have, each listed once, is the price of memory.
constexpr float kNodeCost = 1;
constexpr float kLeafCost = 1.5F;
constexpr float kBlockCost = 1;
constexpr float kMemoryCost = 0.1F;
// A primitive at most so many times as wide as a leaf's voxel is listed in one leaf only.
constexpr float kLoose = 2;
// What a leaf takes for each item: nine corners' numbers of two bytes, and its slot.
constexpr float kItemBytes = 9 * sizeof(std::uint16_t) + sizeof(Slot);

CompactBuildOptions octree_options() {
    CompactBuildOptions options;
    options.rule = CutRule::kSweep;
    // Cut finely: the passes below take back what is not worth it.
    options.costs = {2, 0.5, 0};  // lines have no width
    return options;
}

float half_area(const Bounds3T<float>& box) { return box.surface_area() / 2; }

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
    WideBuilder(const FastScene& scene, const CompactOctree& octree, WideOctree& out)
        : scene_(scene), octree_(octree), out_(out), voxels_(octree_.nodes.size()) {
        const float bytes = kItemBytes * static_cast<float>(std::max(scene.slot_end(), Slot{1}));
        byte_cost_ = kMemoryCost * half_area(octree.bounds) / bytes;
    }

    void build() {
        homes_.resize(scene_.slot_end());
        std::vector<Inner> voxels;
        set_large_apart(voxels);
        find_homes(0, octree_.bounds);
        measure(0, octree_.bounds);
        out_.nodes.emplace_back(WideNode{});
        constexpr std::uint64_t kBehindLarge = std::uint64_t{1} << 63;
        if (voxels_[0].leaf)
            voxels.push_back({0, kBehindLarge, kFirstShift});
        else
            distribute({0, kBehindLarge, kFirstShift + 3}, kWideLanes - voxels.size(), voxels);
        fill(0, voxels);
        // The widest load begins at the last word.
        out_.leaves.resize(out_.leaves.size() + kMostLeafLanes, 0);
        out_.leaves.shrink_to_fit();
        out_.nodes.shrink_to_fit();
    }

  private:
    // A voxel in a node, and the way to it from the node's own: three bits an octant, the first
    // ones highest.
    struct Inner {
        std::uint32_t place;
        std::uint64_t way;
        int shift;  // of the way's last octant
    };
    static constexpr int kFirstShift = 60;

    float leaf_cost(const Voxel& voxel) const {
        const auto blocks = static_cast<float>((voxel.count + kLeafLanes - 1) / kLeafLanes);
        return half_area(voxel.box) * (kLeafCost + kBlockCost * blocks) +
               byte_cost_ * (static_cast<float>(sizeof(WideLeafHead)) +
                             kItemBytes * static_cast<float>(voxel.count));
    }

    // Fills in the voxels from this one down.
    void measure(std::uint32_t place, const Bounds3T<float>& bounds) {
        const CompactNode& node = octree_.nodes[place];
        Voxel& voxel = voxels_[place];
        if (node.is_leaf()) {
            measure_leaf(node, bounds, voxel);
            return;
        }
        node.for_each_child(bounds, [&](std::uint32_t child, const Bounds3T<float>& box) {
            measure(child, box);
            voxel.box = voxel.box.extended(voxels_[child].box);
        });
        gather_items(node, voxel);
        voxel.forest = sums_of(node).all();
        const float as_node = half_area(voxel.box) * kNodeCost +
                              byte_cost_ * static_cast<float>(sizeof(WideNode)) +
                              voxel.forest[kWideLanes - 1];
        const float as_leaf = voxel.small ? leaf_cost(voxel) : kFloatInfinity;
        voxel.leaf = as_leaf <= as_node;
        voxel.forest[0] = std::min(as_leaf, as_node);
        for (std::size_t k = 1; k < kWideLanes; ++k)
            voxel.forest[k] = std::min(voxel.forest[k], voxel.forest[k - 1]);
    }
    void measure_leaf(const CompactNode& node, const Bounds3T<float>& bounds, Voxel& voxel) {
        voxel.first = static_cast<std::uint32_t>(items_.size());
        for (std::uint32_t i = 0; i < node.item_count(); ++i) {
            const Slot slot = octree_.items[node.first_item() + i];
            const Home& home = homes_[slot];
            if (home.only && home.leaf != node.first_item()) continue;
            const Bounds3T<float> box =
                home.only ? whole_box(scene_, slot) : clipped_box(scene_, slot, bounds);
            if (box.empty()) continue;
            voxel.box = voxel.box.extended(box);
            items_.push_back(slot);
        }
        voxel.count = static_cast<std::uint32_t>(items_.size()) - voxel.first;
        voxel.small = voxel.leaf = true;
        voxel.forest.fill(leaf_cost(voxel));
    }

    // Primitives about as wide as the scene, if they are few, get leaves beside the root's voxels:
    // tests that most rays need, once instead of at each leaf on their ways.
    void set_large_apart(std::vector<Inner>& lanes) {
        constexpr std::size_t kFew = kMostLeafLanes;
        const float wide = max_norm(octree_.bounds.widths()) / 2;
        std::vector<Slot> large;
        for (Slot slot = 0; slot < scene_.sphere_end() && large.size() <= kFew; ++slot)
            if (max_norm(whole_box(scene_, slot).widths()) >= wide) large.push_back(slot);
        if (large.size() > kFew) return;
        for (const Slot slot : large) homes_[slot] = {~std::uint32_t{0}, -kFloatInfinity, true};
        for (const LargeGroup& group : groups_of(large)) {
            std::uint64_t way = lanes.size();  // they differ in that
            for (int axis = 0; axis < 3; ++axis)
                if (group.box.center()[axis] > octree_.bounds.center()[axis])
                    way |= std::uint64_t{1} << (kFirstShift + axis);
            lanes.push_back({static_cast<std::uint32_t>(voxels_.size()), way, 0});
            Voxel voxel;
            voxel.box = group.box;
            voxel.first = static_cast<std::uint32_t>(items_.size());
            voxel.count = static_cast<std::uint32_t>(group.slots.size());
            voxel.leaf = true;
            voxels_.push_back(voxel);
            items_.insert(items_.end(), group.slots.begin(), group.slots.end());
        }
    }
    struct LargeGroup {
        Bounds3T<float> box;
        std::vector<Slot> slots;
    };
    // One leaf for those in one box, as are two halves of a wall, or in boxes that rays can hardly
    // tell apart.
    std::vector<LargeGroup> groups_of(std::span<const Slot> large) const {
        constexpr std::size_t kMostGroups = kWideLanes - 8;
        constexpr float kSame = 1 + 0x1p-18F;
        std::vector<LargeGroup> groups;
        for (const Slot slot : large) {
            const Bounds3T<float> box = whole_box(scene_, slot);
            auto group = std::find_if(groups.begin(), groups.end(), [&](const LargeGroup& g) {
                return half_area(g.box.extended(box)) <=
                       kSame * std::max(half_area(g.box), half_area(box));
            });
            if (group == groups.end() && groups.size() < kMostGroups)
                group = groups.emplace(group);
            else if (group == groups.end())
                --group;
            group->box = group->box.extended(box);
            group->slots.push_back(slot);
        }
        return groups;
    }

    // Which leaf, by its first item's place, is nearest to an item's middle; and whether it is
    // small enough against it to be listed there only, as a whole.
    struct Home {
        std::uint32_t leaf = 0;
        float distance = kFloatInfinity;
        bool only = false;
    };
    void find_homes(std::uint32_t place, const Bounds3T<float>& bounds) {
        const CompactNode& node = octree_.nodes[place];
        if (node.is_leaf()) {
            const float width = max_norm(bounds.widths());
            for (std::uint32_t i = 0; i < node.item_count(); ++i) {
                const Slot slot = octree_.items[node.first_item() + i];
                const Bounds3T<float> box = whole_box(scene_, slot);
                const Vec3<float> middle = box.center();
                const Vec3<float> nearest = nuvo::min(nuvo::max(middle, bounds.min), bounds.max);
                const float distance = max_norm(middle - nearest);
                Home& home = homes_[slot];
                if (distance >= home.distance) continue;
                home = {node.first_item(), distance, max_norm(box.widths()) <= kLoose * width};
            }
            return;
        }
        node.for_each_child(bounds, [&](std::uint32_t child, const Bounds3T<float>& box) {
            find_homes(child, box);
        });
    }

    // The items of all octants without repetition, if they are few.
    void gather_items(const CompactNode& node, Voxel& voxel) {
        constexpr std::size_t kMostOfLeaf = 4 * kLeafLanes;
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

    // sum[i][k - 1]: the least cost of the first i + 1 octants in at most k lanes; infinite where
    // k is too small.
    using Forest = std::array<float, kWideLanes>;
    struct Sums {
        std::size_t octants;
        std::array<Forest, 8> sum;
        const Forest& all() const { return sum[octants - 1]; }
    };
    Sums sums_of(const CompactNode& node) const {
        Sums sums;
        sums.octants = static_cast<std::size_t>(std::popcount(node.mask()));
        sums.sum[0] = voxels_[node.first_child()].forest;
        for (std::size_t i = 1; i < sums.octants; ++i) {
            const Forest& forest =
                voxels_[node.first_child() + static_cast<std::uint32_t>(i)].forest;
            const Forest& before = sums.sum[i - 1];
            Forest& sum = sums.sum[i];
            sum.fill(kFloatInfinity);
            for (std::size_t j = i - 1; j + 1 < kWideLanes; ++j)
                for (std::size_t k = 0; j + k + 1 < kWideLanes; ++k)
                    sum[j + k + 1] = std::min(sum[j + k + 1], before[j] + forest[k]);
        }
        return sums;
    }

    // Appends the octants of a voxel, or what stands for them, in at most `lanes` lanes.
    void distribute(const Inner& voxel, std::size_t lanes, std::vector<Inner>& out) const {
        const CompactNode& node = octree_.nodes[voxel.place];
        const Sums sums = sums_of(node);
        unsigned rest = node.mask();
        for (std::size_t i = sums.octants; i-- > 0;) {
            const auto octant = static_cast<unsigned>(31 - std::countl_zero(rest));
            rest &= ~(1U << octant);
            const std::uint32_t child = node.child(octant);
            const std::size_t share =
                i == 0 ? lanes : share_of(sums.sum[i - 1], voxels_[child].forest, lanes, i);
            lanes -= share;
            const int shift = voxel.shift - 3;
            put({child, voxel.way | static_cast<std::uint64_t>(octant) << shift, shift}, share,
                out);
        }
    }
    // How many of the lanes the last octant gets where `others` octants come before it.
    static std::size_t share_of(const Forest& before, const Forest& last, std::size_t lanes,
                                std::size_t others) {
        std::size_t share = 1;
        for (std::size_t k = 2; k + others <= lanes; ++k)
            if (before[lanes - k - 1] + last[k - 1] < before[lanes - share - 1] + last[share - 1])
                share = k;
        return share;
    }
    void put(const Inner& voxel, std::size_t lanes, std::vector<Inner>& out) const {
        const Voxel& v = voxels_[voxel.place];
        if (v.box.empty()) return;
        // As one wherever that costs no more, or where there is no room for the way further down.
        if (v.forest[lanes - 1] >= v.forest[0] || voxel.shift < 3)
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
            // As many places on as there are nearer ones: no two ways are the same.
            for (std::size_t i = 0; i < voxels.size(); ++i) {
                const auto nearer =
                    std::count_if(voxels.begin(), voxels.end(), [&](const Inner& other) {
                        return (other.way ^ turned) < (voxels[i].way ^ turned);
                    });
                lanes[static_cast<std::size_t>(nearer)] = static_cast<std::uint32_t>(i);
            }
            for (std::size_t i = 0; i < kWideLanes; ++i)
                node.order[signs][i % 2] |= lanes[i] << (4 * (i / 2));
        }
    }

    void put_boxes(const std::vector<Inner>& voxels, WideNode& node) const {
        for (std::size_t lane = 0; lane < kWideLanes; ++lane) {
            const Bounds3T<float> box =
                lane < voxels.size() ? voxels_[voxels[lane].place].box : Bounds3T<float>{};
            for (int axis = 0; axis < 3; ++axis) {
                node.face[axis * kWideLanes + lane] = box.empty() ? kFloatInfinity : box.min[axis];
                node.face[(axis + 3) * kWideLanes + lane] =
                    box.empty() ? -kFloatInfinity : box.max[axis];
            }
        }
    }

    // Node `place` with these voxels, and all below it. Leaves first, so that those of a node stand
    // together.
    void fill(std::size_t place, const std::vector<Inner>& voxels) {
        put_boxes(voxels, out_.nodes[place]);
        put_orders(voxels, out_.nodes[place]);
        for (std::size_t lane = 0; lane < voxels.size(); ++lane) {
            const Voxel& voxel = voxels_[voxels[lane].place];
            if (!voxel.leaf) continue;
            const std::span<const Slot> slots(items_.data() + voxel.first, voxel.count);
            out_.nodes[place].child[lane] =
                append_leaf(scene_, slots, voxel.box, out_.leaves) | WideOctree::kLeaf;
        }
        for (std::size_t lane = 0; lane < voxels.size(); ++lane) {
            if (voxels_[voxels[lane].place].leaf) continue;
            const std::size_t next = out_.nodes.size();
            out_.nodes.emplace_back(WideNode{});
            out_.nodes[place].child[lane] = static_cast<std::uint32_t>(next);
            std::vector<Inner> inside;
            distribute({voxels[lane].place, 0, kFirstShift + 3}, kWideLanes, inside);
            fill(next, inside);
        }
    }

    const FastScene& scene_;
    const CompactOctree& octree_;
    WideOctree& out_;
    float byte_cost_;            // of a byte, in half areas
    std::vector<Voxel> voxels_;  // by place in the octree
    std::vector<Home> homes_;    // by slot
    std::vector<Slot> items_;
    std::vector<Slot> gathered_;
};

}  // namespace

WideOctree::WideOctree(const FastScene& scene) {
    const CompactOctree octree = scene.build_octree(octree_options());
    reach = std::max(max_norm(octree.bounds.min), max_norm(octree.bounds.max));
    WideBuilder(scene, octree, *this).build();
}

}  // namespace nuvo
