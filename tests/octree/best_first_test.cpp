#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "nuvo/octree/build.h"

namespace nuvo {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

// Long, flat and small boxes in one another, of which cuts part some hardly.
std::vector<Bounds3> crowded_boxes(std::mt19937_64& random, std::size_t count) {
    std::vector<Bounds3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 p{uniform(random, 0, 10), uniform(random, 0, 10), uniform(random, 0, 10)};
        Vector3 size{0.1, 0.1, 0.1};
        if (i % 3 != 0) size[static_cast<int>(random() % 3)] = uniform(random, 0, 8);
        if (i % 3 == 2) size[static_cast<int>(random() % 3)] = uniform(random, 0, 8);
        boxes.push_back({p, p + size});
    }
    return boxes;
}

double expected_cost(const Octree& octree) {
    const SahCosts costs = CalibratedCosts{}.costs();
    return sah(sah_totals(octree), octree.root().voxel.bounds.surface_area(), costs);
}

bool without_width(const Bounds3& box) {
    const Vector3 w = box.widths();
    return w.x == 0 || w.y == 0 || w.z == 0;
}

TEST(BestFirst, AnyBudgetGivesATreeNoWorseThanSmallerOnes) {
    for (const unsigned seed : {11U, 12U, 13U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::vector<Bounds3> boxes = crowded_boxes(random, 600);
        for (const double margin : {0.0, 1e-12}) {
            BuildOptions options;
            options.margin = margin;
            const Octree unlimited = build_octree(boxes, options);
            EXPECT_FALSE(unlimited.out_of_budget());
            double before = 1e300;
            for (std::size_t budget = 1; budget < 2 * unlimited.reference_count(); budget *= 2) {
                options.max_references = budget;
                const Octree octree = build_octree(boxes, options);
                const double cost = expected_cost(octree);
                EXPECT_LE(cost, before * (1 + 1e-12)) << budget;
                // The last cut may add 7 for each item of its voxel.
                EXPECT_LT(octree.reference_count(), budget + 8 * boxes.size());
                EXPECT_EQ(octree.out_of_budget(),
                          budget <= boxes.size() ||
                              octree.reference_count() < unlimited.reference_count());
                before = cost;
            }
            EXPECT_DOUBLE_EQ(before, expected_cost(unlimited));
        }
    }
}

TEST(BestFirst, ACrowdThatCutsHardlyPartLeavesTheBudgetToOthers) {
    // 400 equal bars from corner to corner of their part stand first in label order.
    std::mt19937_64 random(21);
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 400; ++i) {
        const double d = uniform(random, 0, 1e-9);
        boxes.push_back({{d, 5 + d, d}, {4 + d, 9 + d, 0.01 + d}});
    }
    for (int i = 0; i < 400; ++i) {
        const Point3 p{uniform(random, 6, 10), uniform(random, 0, 4), uniform(random, 6, 10)};
        boxes.push_back({p, p + Vector3{0.01, 0.01, 0.01}});
    }
    BuildOptions options;
    options.margin = 1e-12;
    options.max_references = 2000;
    const Octree octree = build_octree(boxes, options);
    for (const Node& node : octree.nodes()) {
        const auto items = octree.contents(node);
        const auto loose =
            std::count_if(items.begin(), items.end(), [](ItemId i) { return i >= 400; });
        if (node.is_leaf()) {
            EXPECT_LE(loose, 20) << node.label;  // of 400, and no cut pays for 6
        }
    }
}

TEST(BestFirst, LeavesTileTheRootListWhatComesNearAndStandDepthFirst) {
    std::size_t uncut_axes = 0;
    for (const unsigned seed : {31U, 32U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::vector<Bounds3> boxes = crowded_boxes(random, 300);
        BuildOptions options;
        options.margin = 0x1p-40;
        options.midpoint = shrinking(spatial_midpoint);
        options.fallback = sweep_midpoint;
        const Octree octree = build_octree(boxes, options);
        double volume = 0;
        std::uint32_t next_item = 0;
        std::vector<NodeIndex> open{0};
        NodeIndex next_child = 1;
        while (!open.empty()) {
            const Node& node = octree.nodes()[open.back()];
            open.pop_back();
            const Bounds3& box = node.voxel.bounds;
            if (!node.is_leaf()) {
                ASSERT_EQ(node.first_child, next_child);
                next_child += 8;
                for (int digit = 8; digit >= 1; --digit) open.push_back(node.child(digit));
                continue;
            }
            ASSERT_EQ(node.first_item, next_item);
            next_item += node.item_count;
            if (without_width(box)) {
                ++uncut_axes;
                ASSERT_EQ(node.item_count, 0U);
                continue;
            }
            const Vector3 w = box.widths();
            volume += w.x * w.y * w.z;
            const auto items = octree.contents(node);
            const std::set<ItemId> listed(items.begin(), items.end());
            for (ItemId id = 0; id < boxes.size(); ++id)
                ASSERT_EQ(listed.count(id) == 1, boxes[id].inflated(options.margin).overlaps(box));
        }
        const Vector3 w = octree.root().voxel.bounds.widths();
        EXPECT_NEAR(volume, w.x * w.y * w.z, 1e-9 * volume);
    }
    EXPECT_GT(uncut_axes, 0U);
}

TEST(BestFirst, ASmallObjectOnAWideGroundIsReachedByTwoCuts) {
    // 8 x 8 x 8 items 1/8 apart, on grounds 2^4 to 2^30 as wide: halving would take as many levels.
    for (const double wide : {0x1p4, 0x1p20, 0x1p30}) {
        std::vector<Bounds3> boxes{{{-wide, -1, -wide}, {wide, -1, wide}}};
        for (int i = 0; i < 512; ++i) {
            const Point3 p{(i & 7) / 8.0, (i >> 3 & 7) / 8.0, (i >> 6) / 8.0};
            boxes.push_back({p, p + Vector3{0.1, 0.1, 0.1}});
        }
        BuildOptions options;
        options.margin = 0x1p-20;
        options.midpoint = shrinking(spatial_midpoint);
        const Octree octree = build_octree(boxes, options);
        EXPECT_LE(octree.depth(), 1 + 2 + 3 + 2) << wide;  // root, to the box, halvings, spare
        for (const Node& node : octree.nodes())
            if (node.is_leaf()) {
                EXPECT_LE(node.item_count, 16U) << wide;
            }
    }
}

TEST(Shrinking, PutsThePlaneAtTheBoxOfItemsThatEndWithin) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {100, 100, 100}});
    const std::vector<Bounds3> boxes{
        {{-5, 1, -5}, {105, 1, 105}}, {{10, 1, 40}, {12, 30, 45}}, {{20, 60, 47}, {22, 70, 50}}};
    const SplitQuery query{voxel, boxes, 0.25};
    // x: items in 10..22, most room above; y: in 1..70, the centre; z: in 40..50, above again.
    EXPECT_EQ(*shrinking(spatial_midpoint)(query), (Point3{23, 50, 51}));
}

}  // namespace
}  // namespace nuvo
