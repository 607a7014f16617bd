#include "nuvo/octree/compact_build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace nuvo {
namespace {

using Box = Bounds3T<float>;

struct Leaf {
    Box box;
    std::vector<std::uint32_t> items;
};

// Walks the whole tree; fails where a node is malformed, met twice or not at all.
class Reader {
  public:
    explicit Reader(const CompactOctree& tree) : tree_(tree), met_(tree.nodes.size(), false) {
        read(0, tree.bounds, 1);
        EXPECT_EQ(std::count(met_.begin(), met_.end(), false), 0);
        EXPECT_EQ(references_, tree.items.size());
        EXPECT_LE(depth_, CompactOctree::kMaxDepth);
    }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    // Sums of eq. 10 in units of the root's area.
    double interior_area() const { return interior_area_ / area(tree_.bounds); }
    double cost(const CompactCosts& costs) const {
        double sum = costs.interior * interior_area_;
        for (const Leaf& leaf : leaves_)
            sum += area(leaf.box) * (costs.leaf + static_cast<double>(leaf.items.size()));
        return sum / area(tree_.bounds);
    }

  private:
    static double area(const Box& box) {
        return Bounds3{Point3(box.min), Point3(box.max)}.surface_area();
    }
    void read(std::uint32_t index, const Box& box, int level) {
        ASSERT_LT(index, tree_.nodes.size());
        ASSERT_FALSE(met_[index]);
        met_[index] = true;
        depth_ = std::max(depth_, level);
        const CompactNode& node = tree_.nodes[index];
        if (node.is_leaf()) {
            const auto first = tree_.items.begin() + node.first_item();
            leaves_.push_back({box, {first, first + node.item_count()}});
            references_ += node.item_count();
            return;
        }
        interior_area_ += area(box);
        for (unsigned o = 0; o < 8; ++o) {
            if ((node.mask() >> o & 1U) == 0) continue;
            Box child = box;
            for (int axis = 0; axis < 3; ++axis) {
                // Inside, or the upper face: not cut.
                ASSERT_TRUE(box.min[axis] < node.cut[axis] || node.cut[axis] == box.max[axis]);
                ASSERT_LE(node.cut[axis], box.max[axis]);
                ((o >> axis & 1U) != 0 ? child.min : child.max)[axis] = node.cut[axis];
            }
            read(node.child(o), child, level + 1);
        }
    }

    const CompactOctree& tree_;
    std::vector<bool> met_;
    std::vector<Leaf> leaves_;
    std::size_t references_ = 0;
    double interior_area_ = 0;
    int depth_ = 0;
};

std::vector<Leaf> leaves_of(const CompactOctree& tree) { return Reader(tree).leaves(); }

std::vector<Box> random_boxes(unsigned seed, std::size_t count, float size) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> place(0, 1);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3<float> p{place(random), place(random), place(random)};
        const Vec3<float> w{place(random) * size, place(random) * size, place(random) * size};
        boxes.push_back({p, p + w});
    }
    return boxes;
}

CompactBuildOptions options(CutRule rule, int threads = 1) {
    CompactBuildOptions result;
    result.rule = rule;
    result.threads = threads;
    return result;
}

// Every leaf lists, in order, exactly the boxes that touch it.
void expect_brute_force(const std::vector<Leaf>& leaves, const std::vector<Box>& boxes) {
    for (const Leaf& leaf : leaves) {
        std::vector<std::uint32_t> touching;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            if (boxes[i].overlaps(leaf.box)) touching.push_back(static_cast<std::uint32_t>(i));
        ASSERT_EQ(leaf.items, touching);
    }
}

constexpr CutRule kRules[] = {CutRule::kSpatial, CutRule::kSweep};

TEST(CompactBuild, LeavesListExactlyTheBoxesThatTouchThem) {
    for (const CutRule rule : kRules)
        for (const unsigned seed : {1U, 2U, 3U})
            for (const float size : {0.001F, 0.05F, 0.5F}) {
                SCOPED_TRACE("seed " + std::to_string(seed) + " size " + std::to_string(size));
                const std::vector<Box> boxes = random_boxes(seed, 1500, size);
                const CompactOctree tree = build_compact_octree(boxes, options(rule));
                const Reader reader(tree);
                EXPECT_GT(reader.leaves().size(), 8U);
                expect_brute_force(reader.leaves(), boxes);
            }
}

// A block of upright slats stands in the middle of a floor.
std::vector<Box> slats_on_a_floor(float floor) {
    std::vector<Box> boxes;
    for (int i = 0; i < 32; ++i)
        for (int k = 0; k < 32; ++k) {
            const Vec3<float> p{static_cast<float>(i) / 32, 0, static_cast<float>(k) / 32};
            boxes.push_back({p, p + Vec3<float>{0x1p-6F, 1, 0x1p-6F}});
        }
    boxes.push_back({{-floor, -1, -floor}, {floor, -1, floor}});
    return boxes;
}

// Of a flat hall every voxel has the shape of the hall, unless it is cut on its long axes alone:
// the slats would be cut into as many slices as the hall is wider than it is high.
TEST(CompactBuild, AWideFloorDoesNotSliceWhatStandsOnIt) {
    for (const CutRule rule : kRules) {
        const auto references = [&](float floor) {
            const std::vector<Box> boxes = slats_on_a_floor(floor);
            const CompactOctree tree = build_compact_octree(boxes, options(rule));
            expect_brute_force(leaves_of(tree), boxes);
            return tree.items.size();
        };
        const std::size_t small = references(2);
        for (const float floor : {0x1p5F, 0x1p10F, 0x1p20F})
            EXPECT_LE(references(floor), 2 * small) << "floor " << floor;
    }
}

TEST(CompactBuild, BoxesThatEndOnACutAreListedOnBothSides) {
    // Spatial cuts depend on the whole box only: those of a first tree are edges in the second.
    std::vector<Box> boxes = random_boxes(4, 2000, 0.01F);
    boxes.push_back({{-1, -1, -1}, {2, 2, 2}});
    const CompactOctree first = build_compact_octree(boxes, options(CutRule::kSpatial));
    std::vector<float> planes[3];
    for (const CompactNode& node : first.nodes)
        if (!node.is_leaf())
            for (int axis = 0; axis < 3; ++axis) planes[axis].push_back(node.cut[axis]);
    std::mt19937_64 random(5);
    for (std::size_t i = 0; i < 500; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const float plane = planes[axis][random() % planes[axis].size()];
            (random() % 2 == 0 ? boxes[i].min : boxes[i].max)[axis] = plane;
            if (boxes[i].min[axis] > boxes[i].max[axis])
                std::swap(boxes[i].min[axis], boxes[i].max[axis]);
        }
    const CompactOctree second = build_compact_octree(boxes, options(CutRule::kSpatial));
    ASSERT_EQ(second.bounds, first.bounds);
    std::size_t on_a_plane = 0;
    const Reader reader(second);
    for (const Leaf& leaf : reader.leaves())
        for (const std::uint32_t item : leaf.items)
            on_a_plane += boxes[item].max.x == leaf.box.min.x ? 1 : 0;
    EXPECT_GT(on_a_plane, 10U);
    expect_brute_force(reader.leaves(), boxes);
}

TEST(CompactBuild, TheTestIsAskedWhereBoxesTouchMostOctantsAndObeyed) {
    // The boxes touch nearly all octants of the root.
    std::vector<Box> boxes = random_boxes(6, 3000, 1);
    for (Box& box : boxes) box.max = box.max + Vec3<float>{1, 1, 1};
    for (const CutRule rule : kRules) {
        CompactBuildOptions with_test = options(rule);
        // Item i has points in octant i % 8 only, unless its box does not touch that.
        with_test.overlaps = [&](const CutVoxel& voxel, std::span<const std::uint32_t> items,
                                 std::span<std::uint8_t> masks) {
            ASSERT_EQ(items.size(), masks.size());
            ASSERT_TRUE(std::is_sorted(items.begin(), items.end()));
            std::size_t octants = 0;
            for (std::size_t i = 0; i < items.size(); ++i) {
                octants += static_cast<std::size_t>(std::popcount(masks[i]));
                ASSERT_TRUE(boxes[items[i]].overlaps(voxel.bounds));
                const unsigned only = masks[i] & 1U << items[i] % 8;
                if (only != 0) masks[i] = static_cast<std::uint8_t>(only);
            }
            ASSERT_GT(octants, (items.size() >= 128 ? 2 : 4) * items.size());
        };
        const CompactOctree tree = build_compact_octree(boxes, with_test);
        ASSERT_GT(tree.nodes.size(), 8U);
        const float(&cut)[3] = tree.nodes[0].cut;
        std::size_t listed = 0;
        for (const Leaf& leaf : leaves_of(tree)) {
            unsigned octant = 0;
            for (unsigned axis = 0; axis < 3; ++axis)
                octant |= (leaf.box.min[axis] >= cut[axis] ? 1U : 0U) << axis;
            for (const std::uint32_t i : leaf.items) {
                Box own = tree.bounds;
                for (unsigned axis = 0; axis < 3; ++axis)
                    ((i >> axis & 1) != 0 ? own.min : own.max)[axis] = cut[axis];
                ASSERT_TRUE(i % 8 == octant || !boxes[i].overlaps(own)) << i;
                listed += i % 8 == octant ? 1 : 0;
            }
        }
        EXPECT_GT(listed, boxes.size() / 2);
    }
}

TEST(CompactBuild, TheTreeDoesNotDependOnTheNumberOfThreads) {
    const std::vector<Box> boxes = random_boxes(7, 30000, 0.02F);
    for (const CutRule rule : kRules) {
        const CompactOctree one = build_compact_octree(boxes, options(rule, 1));
        for (const int threads : {2, 7}) {
            const CompactOctree many = build_compact_octree(boxes, options(rule, threads));
            EXPECT_EQ(many.items, one.items);
            ASSERT_EQ(many.nodes.size(), one.nodes.size());
            for (std::size_t i = 0; i < one.nodes.size(); ++i) {
                ASSERT_EQ(many.nodes[i].children, one.nodes[i].children);
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(many.nodes[i].cut[axis]),
                              std::bit_cast<std::uint32_t>(one.nodes[i].cut[axis]));
            }
        }
    }
}

TEST(CompactBuild, ErrorsInAThreadReachTheCaller) {
    const std::vector<Box> boxes = random_boxes(8, 10000, 1.5F);
    CompactBuildOptions failing = options(CutRule::kSpatial, 3);
    failing.overlaps = [](const CutVoxel&, std::span<const std::uint32_t>,
                          std::span<std::uint8_t>) { throw std::bad_alloc(); };
    EXPECT_THROW(build_compact_octree(boxes, failing), std::bad_alloc);
}

TEST(CompactBuild, ReferencesStayWithinTheirLimit) {
    // Needles through the whole scene: each cut doubles them.
    std::mt19937_64 random(9);
    std::uniform_real_distribution<float> place(0, 1);
    std::vector<Box> boxes;
    for (int i = 0; i < 6000; ++i) {
        const float y = place(random);
        const float z = place(random);
        boxes.push_back({{0, y, z}, {1, y + 1e-5F, z + 1e-5F}});
    }
    for (const CutRule rule : kRules)
        for (const double limit : {1.0, 3.0, 20.0}) {
            CompactBuildOptions limited = options(rule);
            limited.max_references_per_item = limit;
            limited.free_references = 0;
            const CompactOctree tree = build_compact_octree(boxes, limited);
            EXPECT_LE(static_cast<double>(tree.items.size()), limit * 6000);
            if (rule == CutRule::kSpatial) {
                EXPECT_EQ(tree.nodes.size() > 1, limit >= 2);
            }
        }
}

TEST(CompactBuild, ItemsThatCutsDoNotPartTakeNothingFromOthers) {
    std::vector<Box> boxes(2000, Box{{0, 0, 0}, {0.9F, 0.9F, 0.9F}});
    for (Box box : random_boxes(10, 2000, 0.001F)) {
        for (Vec3<float>* corner : {&box.min, &box.max}) corner->x += 2;
        boxes.push_back(box);
    }
    for (const CutRule rule : kRules) {
        CompactBuildOptions limited = options(rule);
        limited.max_references_per_item = 3;
        limited.free_references = 0;
        const CompactOctree tree = build_compact_octree(boxes, limited);
        for (const Leaf& leaf : leaves_of(tree)) {
            if (!leaf.items.empty() && leaf.items.front() >= 2000) {
                EXPECT_LT(leaf.items.size(), 64U);
            }
        }
    }
}

TEST(CompactBuild, NothingAndOneItemMakeALeaf) {
    for (const CutRule rule : kRules) {
        const CompactOctree none = build_compact_octree({}, options(rule));
        ASSERT_EQ(none.nodes.size(), 1U);
        EXPECT_TRUE(none.nodes[0].is_leaf());
        EXPECT_EQ(none.nodes[0].item_count(), 0U);
        EXPECT_TRUE(none.bounds.min == (Vec3<float>{}) && none.bounds.max == (Vec3<float>{}));
        const std::vector<Box> box{{{1, 2, 3}, {2, 3, 4}}};
        const CompactOctree one = build_compact_octree(box, options(rule));
        ASSERT_EQ(one.nodes.size(), 1U);
        EXPECT_EQ(one.items, std::vector<std::uint32_t>{0});
        EXPECT_TRUE(one.bounds.contains(box[0].min) && one.bounds.contains(box[0].max));
    }
}

TEST(CompactBuild, ItemsAtOnePointStayInOneLeaf) {
    const std::vector<Box> points(5000, Box{{0.25F, 0.5F, 0.75F}, {0.25F, 0.5F, 0.75F}});
    const std::vector<Box> boxes(5000, Box{{0, 0, 0}, {1, 1, 1}});
    for (const CutRule rule : kRules)
        for (const auto& items : {points, boxes}) {
            const CompactOctree tree = build_compact_octree(items, options(rule));
            EXPECT_EQ(tree.nodes.size(), 1U);
            EXPECT_EQ(tree.items.size(), 5000U);
        }
}

TEST(CompactBuild, AFlatSceneIsCutOnItsTwoAxes) {
    for (int axis = 0; axis < 3; ++axis)
        for (const CutRule rule : kRules) {
            std::vector<Box> boxes = random_boxes(11, 4000, 0.003F);
            for (Box& box : boxes) box.min[axis] = box.max[axis] = 0.125F;
            const CompactOctree tree = build_compact_octree(boxes, options(rule));
            const Reader reader(tree);
            EXPECT_GT(reader.leaves().size(), 200U);
            EXPECT_LT(tree.items.size(), 2 * boxes.size());
            expect_brute_force(reader.leaves(), boxes);
        }
}

// Boards side by side, and sheets in a stack: nothing is parted along the wide axes.
TEST(CompactBuild, ItemsAsLongAsTheSceneAreCutAcross) {
    constexpr int kCount = 1000;
    std::vector<Box> boards;
    std::vector<Box> sheets;
    for (int i = 0; i < kCount; ++i) {
        const float from = 0.01F * static_cast<float>(i) / kCount - 0.005F;
        const float to = from + 0.009F / kCount;
        boards.push_back({{from, 0, -0.5F}, {to, 0, 0.5F}});
        sheets.push_back({{-0.5F, -0.5F, 40 * from}, {0.5F, 0.5F, 40 * to}});
    }
    for (const std::vector<Box>& boxes : {boards, sheets}) {
        const CompactOctree tree = build_compact_octree(boxes, {});
        const Reader reader(tree);
        for (const Leaf& leaf : reader.leaves()) EXPECT_LE(leaf.items.size(), kCount / 4);
        EXPECT_LE(tree.items.size(), kCount * 5 / 4);
    }
}

TEST(CompactBuild, SmallAndLargeScenesAreCutLikeOthers) {
    const std::vector<Box> boxes = random_boxes(12, 2000, 0.01F);
    for (const CutRule rule : kRules)
        for (const float scale : {0x1p-30F, 0x1p-10F, 0x1p10F, 0x1p30F}) {
            std::vector<Box> scaled = boxes;
            for (Box& box : scaled) box = {box.min * scale, box.max * scale};
            const CompactOctree tree = build_compact_octree(scaled, options(rule));
            EXPECT_GT(tree.nodes.size(), 300U);
            expect_brute_force(leaves_of(tree), scaled);
        }
}

TEST(CompactBuild, TheSweepCutsThroughTheGap) {
    // Two clouds of touching boxes on a lattice, with a gap in x that is far from the centre.
    std::vector<Box> boxes;
    for (int i = 0; i < 1000; ++i) {
        const Vec3<float> p{static_cast<float>(i % 10), static_cast<float>(i / 10 % 10),
                            static_cast<float>(i / 100)};
        const float moved = p.x >= 3 ? p.x + 0.125F : p.x;
        boxes.push_back({{moved, p.y, p.z}, {moved + 0.75F, p.y + 0.75F, p.z + 0.75F}});
    }
    const CompactOctree tree = build_compact_octree(boxes, options(CutRule::kSweep));
    // Whatever gaps it chose, no box was cut.
    EXPECT_EQ(tree.items.size(), boxes.size());
    EXPECT_GT(tree.nodes.size(), 100U);
}

TEST(CompactBuild, WhatDoesNotPayIsNotKept) {
    for (const unsigned seed : {13U, 14U})
        for (const float size : {0.01F, 0.2F, 0.6F})
            for (const CutRule rule : kRules) {
                const std::vector<Box> boxes = random_boxes(seed, 1000, size);
                const CompactBuildOptions usual = options(rule);
                const CompactOctree tree = build_compact_octree(boxes, usual);
                // A single leaf: the price of a leaf and of each item.
                EXPECT_LE(Reader(tree).cost(usual.costs), usual.costs.leaf + 1000);
                CompactBuildOptions dear = usual;
                dear.costs.interior = 2000;
                EXPECT_EQ(build_compact_octree(boxes, dear).nodes.size(), 1U);
            }
}

// Sheets across the scene: a cut through the centre lists half of them in each octant, each of a
// quarter of the area, so that it saves no test and costs a step. It is tried, for other items are
// parted further down; with 20,000 of them above the subtrees that threads share, too.
TEST(CompactBuild, CutsThatWereTriedInVainAreTakenBack) {
    for (const std::size_t count : {1000U, 20'000U}) {
        std::mt19937_64 random(15);
        std::uniform_real_distribution<float> place(0, 1);
        std::vector<Box> boxes;
        while (boxes.size() < count) {
            const float z = place(random);
            boxes.push_back({{0, 0, z}, {1, 1, z}});
        }
        const CompactOctree tree = build_compact_octree(boxes, options(CutRule::kSpatial));
        EXPECT_EQ(tree.nodes.size(), 1U);
        EXPECT_EQ(tree.items.size(), count);
    }
}

std::size_t largest_leaf(const CompactOctree& tree) {
    std::size_t largest = 0;
    for (const Leaf& leaf : leaves_of(tree)) largest = std::max(largest, leaf.items.size());
    return largest;
}

// What a scene is cut into does not depend on how far its floor reaches.
TEST(CompactBuild, AClusterInAWideSceneIsCutAboutAsFinely) {
    const std::vector<Box> cluster = random_boxes(16, 4000, 0.01F);
    for (const CutRule rule : kRules) {
        const std::size_t alone = largest_leaf(build_compact_octree(cluster, options(rule)));
        for (const float width : {10.0F, 600.0F, 5000.0F}) {
            std::vector<Box> boxes = cluster;
            boxes.push_back({{-width, -0.5F, -width}, {width, -0.5F, width}});
            const CompactOctree tree = build_compact_octree(boxes, options(rule));
            EXPECT_LE(largest_leaf(tree), 4 * alone) << width;
            EXPECT_LT(tree.items.size(), 6 * boxes.size()) << width;
        }
    }
}

TEST(CompactBuild, CutsThroughCentresUnlessThatListsItemsMuchMoreOften) {
    // 11 x 11 x 11 boxes with gaps, most of which no centre of a voxel meets.
    std::vector<Box> lattice;
    for (int i = 0; i < 11 * 11 * 11; ++i) {
        const Vec3<float> p{static_cast<float>(i % 11), static_cast<float>(i / 11 % 11),
                            static_cast<float>(i / 121)};
        lattice.push_back({p, {p.x + 0.9F, p.y + 0.9F, p.z + 0.9F}});
    }
    CompactBuildOptions measured;
    measured.rule = std::nullopt;
    const CompactOctree tree = build_compact_octree(lattice, measured);
    EXPECT_EQ(tree.rule, CutRule::kSweep);
    EXPECT_EQ(tree.items, build_compact_octree(lattice, options(CutRule::kSweep)).items);
    const std::vector<Box> small = random_boxes(17, 5000, 0.0001F);
    EXPECT_EQ(build_compact_octree(small, measured).rule, CutRule::kSpatial);
    EXPECT_EQ(build_compact_octree({}, measured).rule, CutRule::kSpatial);
}

TEST(CompactBuild, DearerStepsMakeSmallerTrees) {
    const std::vector<Box> boxes = random_boxes(15, 5000, 0.02F);
    for (const CutRule rule : kRules) {
        std::size_t last = std::numeric_limits<std::size_t>::max();
        for (const double price : {3.0, 12.0, 48.0}) {
            CompactBuildOptions priced = options(rule);
            priced.costs.interior = price;
            const std::size_t nodes = build_compact_octree(boxes, priced).nodes.size();
            EXPECT_LT(nodes, last);
            last = nodes;
        }
    }
}

}  // namespace
}  // namespace nuvo
