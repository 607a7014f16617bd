#include "nuvo/octree/build.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "octree/random_boxes.h"

namespace nuvo {
namespace {

float published_area(const Bounds3& box) {
    const Vec3<float> w(box.widths());
    return 2 * (w.x * (w.z + w.y) + w.z * w.y);
}

// The published algorithm as written, without running sums: the whole tree is summed up before and
// after every trial split. [thesis 4.4.2]
class RecomputingBuilder {
  public:
    RecomputingBuilder(const std::vector<Bounds3>& boxes, const ThesisCosts& costs,
                       MidpointStrategy midpoint)
        : boxes_(boxes), costs_(costs), midpoint_(std::move(midpoint)) {
        Bounds3 root;
        std::vector<ItemId> all;
        for (const Bounds3& box : boxes) {
            root = root.extended(box);
            all.push_back(static_cast<ItemId>(all.size()));
        }
        leaves_[0] = {root, all};
        root_area_ = published_area(root);
        Voxel voxel = Voxel::centered(root);
        if (const auto sized = midpoint_({voxel, boxes})) voxel.midpoint = *sized;
        subdivide(0, voxel.midpoint);
    }
    std::set<Label> leaf_names() const {
        std::set<Label> names;
        for (const auto& [name, leaf] : leaves_) names.insert(name);
        return names;
    }

  private:
    struct Cell {
        Bounds3 box;
        std::vector<ItemId> items;
    };
    float score() const {
        SahTotals totals;
        for (const auto& [name, cell] : interiors_)
            totals.interior_area += published_area(cell.box);
        for (const auto& [name, cell] : leaves_) {
            const float area = published_area(cell.box);
            totals.leaf_area += area;
            totals.leaf_area_objects += area * static_cast<float>(cell.items.size());
        }
        totals.leaves = leaves_.size();
        return costs_.of_tree(totals, root_area_);
    }
    void subdivide(Label name, const Point3& centre) {
        const Cell cell = leaves_.at(name);
        if (cell.items.empty()) return;
        Voxel voxel{cell.box, centre};
        std::vector<Bounds3> inside;
        for (ItemId id : cell.items) inside.push_back(boxes_[id]);
        const auto midpoint = midpoint_({voxel, inside});
        if (!midpoint) return;
        voxel.midpoint = *midpoint;
        const float before = score();
        leaves_.erase(name);
        interiors_[name] = cell;
        for (int digit = 1; digit <= 8; ++digit) {
            Cell child{voxel.octant(digit), {}};
            for (ItemId id : cell.items)
                if (boxes_[id].overlaps(child.box)) child.items.push_back(id);
            leaves_[child_label(name, digit)] = child;
        }
        if (score() < before) {
            for (int digit = 1; digit <= 8; ++digit)
                subdivide(child_label(name, digit), voxel.octant(digit).center());
        } else {
            for (int digit = 1; digit <= 8; ++digit) leaves_.erase(child_label(name, digit));
            interiors_.erase(name);
            leaves_[name] = cell;
        }
    }

    const std::vector<Bounds3>& boxes_;
    ThesisCosts costs_;
    MidpointStrategy midpoint_;
    std::map<Label, Cell> leaves_;
    std::map<Label, Cell> interiors_;
    double root_area_ = 0;
};

std::set<Label> leaf_names(const Octree& octree) {
    std::set<Label> names;
    for (const Node& node : octree.nodes())
        if (node.is_leaf()) names.insert(node.label);
    return names;
}

TEST(Sah, IsEquation10) {
    const SahTotals totals{3, 5, 7, 8};
    EXPECT_DOUBLE_EQ(sah(totals, 2, {11, 13, 17}), (11 * 3 + 13 * 5 + 17 * 7) / 2.0);
}

TEST(ThesisCosts, AreThoseOfSection541) {
    const SahCosts costs = ThesisCosts{1201, 2, 100}(15);
    EXPECT_EQ(costs.interior, 225);
    EXPECT_EQ(costs.leaf, 6);  // 100 / 15 in whole numbers
    EXPECT_EQ(costs.object, 2.0 * 1201 * 1201);
    EXPECT_EQ(ThesisCosts({1201, 2, 100})(101).leaf, 0);
}

TEST(ThesisCosts, PriceATreeInFloat) {
    const ThesisCosts costs{1201, 2, 100};
    // One leaf: its own price and that of its objects, whatever its area.
    EXPECT_EQ(costs.of_tree({0, 5, 500, 1}, 5), 100 + 100 * 2.0F * 1201 * 1201);
    const SahTotals totals{8, 7, 600, 8};
    EXPECT_EQ(costs.of_tree(totals, 7), static_cast<float>(sah(totals, 7, costs(8))));
    // Two trees that differ by less than float tells apart cost the same.
    EXPECT_EQ(costs.of_tree(totals, 7), costs.of_tree({8, 7, 600 * (1 + 1e-9), 8}, 7));
}

TEST(Build, RunningSumsDecideAsTheWholeTreeDoes) {
    for (const bool uniform : {true, false}) {
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const auto boxes = random_boxes(seed, 60, seed * 2.0);
            BuildOptions options;
            options.midpoint = uniform ? spatial_midpoint : published_midpoint;
            const ThesisCosts costs{480, 2, boxes.size()};
            options.worth = costs;
            const Octree octree = build_octree(boxes, options);
            const RecomputingBuilder oracle(boxes, costs, options.midpoint);
            EXPECT_GT(octree.leaf_count(), 8U);
            EXPECT_EQ(leaf_names(octree), oracle.leaf_names());
        }
    }
}

TEST(Build, PublishedPlacementIsStrict) {
    // Cut at 1 on each axis: the first box touches the plane, the second spans it, the third lies
    // in it and is lost, as published.
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}},
                                     {{0, 0, 0}, {2, 0.5, 0.5}},
                                     {{0, 1, 0}, {0.5, 1, 0.5}},
                                     {{1.5, 1.5, 1.5}, {2, 2, 2}}};
    BuildOptions options;
    options.worth = ThesisCosts{100, 2, boxes.size()};
    options.strict_placement = true;
    const Octree octree = build_octree(boxes, options);
    ASSERT_GE(octree.leaf_count(), 8U);
    std::map<ItemId, std::set<Label>> places;
    for (const Node& node : octree.nodes())
        for (ItemId id : octree.contents(node))
            if (node.is_leaf())
                places[id].insert(node.label / [&] {
                    Label unit = 1;
                    while (node.label / unit > 8) unit *= 10;
                    return unit;
                }());
    EXPECT_EQ(places[0], (std::set<Label>{5}));
    EXPECT_EQ(places[1], (std::set<Label>{5, 6}));
    EXPECT_EQ(places[2], (std::set<Label>{}));
    EXPECT_EQ(places[3], (std::set<Label>{4}));
}

TEST(Build, ThePublishedDepthIsTheDeepestLevelTried) {
    // One item in one leaf: a cut is tried below the root and taken back.
    BuildOptions options;
    options.worth = ThesisCosts{2, 1, 1};
    const Octree octree = build_octree(std::vector<Bounds3>{{{0, 0, 0}, {1, 1, 1}}}, options);
    EXPECT_EQ(octree.leaf_count(), 1U);
    EXPECT_EQ(octree.depth(), 1);
    EXPECT_EQ(octree.depth_tried(), 1);
    EXPECT_FALSE(build_octree(random_boxes(2, 50, 1), {}).depth_tried());
}

TEST(Build, LeavesTileTheRootAndListWhatTheyOverlap) {
    const auto boxes = random_boxes(9, 300, 3);
    for (const auto& midpoint :
         {MidpointStrategy(spatial_midpoint), MidpointStrategy(sweep_midpoint),
          MidpointStrategy(published_midpoint)}) {
        BuildOptions options;
        options.midpoint = midpoint;
        options.worth = CalibratedCosts{2};
        const Octree octree = build_octree(boxes, options);
        EXPECT_EQ(octree.leaf_count() % 7, 1U);
        double volume = 0;
        for (const Node& node : octree.nodes()) {
            if (!node.is_leaf()) continue;
            const Bounds3& box = node.voxel.bounds;
            const Vector3 w = box.widths();
            volume += w.x * w.y * w.z;
            std::set<ItemId> listed;
            for (ItemId id : octree.contents(node)) listed.insert(id);
            for (ItemId id = 0; id < boxes.size(); ++id)
                ASSERT_EQ(listed.count(id) == 1, boxes[id].overlaps(box));
        }
        const Vector3 w = octree.root().voxel.bounds.widths();
        EXPECT_NEAR(volume, w.x * w.y * w.z, 1e-9 * volume);
    }
}

TEST(Build, MaxObjectsCutsUntilNoLeafHoldsMore) {
    const auto boxes = random_boxes(5, 500, 0.01);
    BuildOptions options;
    options.worth = MaxObjects{3};
    const Octree octree = build_octree(boxes, options);
    for (const Node& node : octree.nodes()) {
        if (node.is_leaf()) {
            EXPECT_LE(node.item_count, 3U);
        }
    }
    options.worth = MaxObjects{500};
    EXPECT_EQ(build_octree(boxes, options).leaf_count(), 1U);
}

TEST(Build, ThesisCostsCutNothingMoreOnceTheReferencesAreSpent) {
    const auto boxes = random_boxes(6, 400, 10);
    BuildOptions options;
    options.worth = ThesisCosts{40000, 2, boxes.size()};  // tests are dear
    options.max_depth = 6;
    const std::size_t unlimited = build_octree(boxes, options).reference_count();
    options.max_references = unlimited / 2;
    const std::size_t limited = build_octree(boxes, options).reference_count();
    EXPECT_GE(limited, unlimited / 2);
    EXPECT_LT(limited, unlimited / 2 + 8 * boxes.size());  // the last cut may overshoot
    EXPECT_LT(limited, unlimited);
    options.max_references = unlimited;
    EXPECT_EQ(build_octree(boxes, options).reference_count(), unlimited);
}

TEST(Build, MaxDepthIsTheNumberOfLevels) {
    const auto boxes = random_boxes(3, 300, 1);
    BuildOptions options;
    for (const auto& worth :
         {decltype(options.worth)(CalibratedCosts{}), decltype(options.worth)(MaxObjects{1}),
          decltype(options.worth)(ThesisCosts{1201, 2, 100})}) {
        options.worth = worth;
        options.max_depth = kMaxLabelDigits + 1;
        const int whole = build_octree(boxes, options).depth();
        ASSERT_GE(whole, 3) << worth.index();
        for (int depth = 1; depth < whole; ++depth) {
            options.max_depth = depth;
            EXPECT_EQ(build_octree(boxes, options).depth(), depth) << worth.index();
        }
    }
}

TEST(Build, StopsAtNineteenDigits) {
    // Two boxes that no cut above level 19 can tell apart.
    const double tiny = 0x1p-60;
    const std::vector<Bounds3> boxes{
        {{0, 0, 0}, {0, 0, 0}}, {{tiny, 0, 0}, {tiny, 0, 0}}, {{1, 1, 1}, {1, 1, 1}}};
    BuildOptions options;
    options.worth = MaxObjects{1};
    const Octree octree = build_octree(boxes, options);
    EXPECT_EQ(octree.depth(), kMaxLabelDigits + 1);
    Label longest = 0;
    for (const Node& node : octree.nodes()) {
        EXPECT_LE(label_digits(node.label), kMaxLabelDigits);
        longest = std::max(longest, node.label);
        EXPECT_EQ(octree.find_name(node.label), &node - octree.nodes().data());
    }
    EXPECT_EQ(label_digits(longest), 19);
}

// Under prices by which each cut around two objects pays, whichever corner they stand in: cuts go
// depth first, and the last of what is left weighs most.
TEST(Build, ThesisCostsStopAtNineteenDigits) {
    int deepest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Point3 at{static_cast<double>(corner & 1), static_cast<double>(corner >> 1 & 1),
                        static_cast<double>(corner >> 2)};
        const Point3 opposite = Point3{1, 1, 1} - at;
        const Vector3 tiny = (opposite - at) * 0x1p-50;
        BuildOptions options;
        options.worth = ThesisCosts{1, 1e30, 3};
        const std::vector<Bounds3> boxes{{at, at}, {at + tiny, at + tiny}, {opposite, opposite}};
        const Octree octree = build_octree(boxes, options);
        for (const Node& node : octree.nodes())
            ASSERT_LE(label_digits(node.label), kMaxLabelDigits);
        deepest = std::max(deepest, octree.depth());
    }
    EXPECT_EQ(deepest, kMaxLabelDigits + 1);
}

// Closed boxes on a lattice, of which many end on the planes of the cuts.
TEST(Build, WhatEndsOnACutIsListedOnBothSides) {
    std::mt19937_64 random(21);
    std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{15, 15, 15}, {16, 16, 16}}};
    for (int i = 0; i < 40; ++i) {
        Bounds3 box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = static_cast<double>(random() % 16);
            box.max[axis] = box.min[axis] + static_cast<double>(random() % 2);
        }
        boxes.push_back(box);
    }
    BuildOptions options;
    for (const auto& worth :
         {decltype(options.worth)(CalibratedCosts{}), decltype(options.worth)(MaxObjects{4}),
          decltype(options.worth)(ThesisCosts{1201, 2, 42})}) {
        options.worth = worth;
        options.max_depth = 6;
        const Octree octree = build_octree(boxes, options);
        EXPECT_GE(octree.leaf_count(), 8U);
        for (const Node& node : octree.nodes()) {
            if (!node.is_leaf()) continue;
            std::vector<ItemId> near;
            for (std::size_t i = 0; i < boxes.size(); ++i)
                if (boxes[i].overlaps(node.voxel.bounds)) near.push_back(static_cast<ItemId>(i));
            const auto listed = octree.contents(node);
            EXPECT_EQ(std::vector<ItemId>(listed.begin(), listed.end()), near);
        }
    }
}

// A scene so flat that its third axis is not cut.
TEST(Build, OctantsWithoutWidthHoldNothing) {
    auto boxes = random_boxes(9, 300, 1);
    for (Bounds3& box : boxes) box.min.z = box.max.z = 1e9;
    BuildOptions options;
    options.margin = 1e-7;
    for (const auto& worth :
         {decltype(options.worth)(CalibratedCosts{}), decltype(options.worth)(MaxObjects{2}),
          decltype(options.worth)(ThesisCosts{1201, 2, 300})}) {
        options.worth = worth;
        const Octree octree = build_octree(boxes, options);
        EXPECT_GT(octree.leaf_count(), 8U);
        std::size_t without_width = 0;
        for (const Node& node : octree.nodes())
            if (node.is_leaf() && node.voxel.bounds.min.z == node.voxel.bounds.max.z) {
                ++without_width;
                EXPECT_EQ(node.item_count, 0U);
            }
        EXPECT_EQ(without_width, octree.nodes().size() / 2);  // 4 of each 8
    }
}

TEST(Build, ObjectsAtOnePointEndInOneLeaf) {
    const std::vector<Bounds3> boxes(100, Bounds3{{1, 2, 3}, {1, 2, 3}});
    BuildOptions options;
    options.worth = MaxObjects{1};
    EXPECT_EQ(build_octree(boxes, options).leaf_count(), 1U);
    EXPECT_EQ(build_octree({}, {}).leaf_count(), 1U);
}

TEST(Build, AFlatSceneIsStillATree) {
    std::vector<Bounds3> boxes;
    for (int x = 0; x < 16; ++x)
        for (int z = 0; z < 16; ++z)
            boxes.push_back({{x + 0.1, 5, z + 0.1}, {x + 0.9, 5, z + 0.9}});
    for (const auto& midpoint :
         {MidpointStrategy(spatial_midpoint), MidpointStrategy(sweep_midpoint)}) {
        BuildOptions options;
        options.midpoint = midpoint;
        options.worth = CalibratedCosts{2};
        options.margin = 0x1p-46;
        const Octree octree = build_octree(boxes, options);
        EXPECT_GT(octree.leaf_count(), 20U);
        std::size_t most = 0;
        for (const Node& node : octree.nodes())
            if (node.is_leaf()) most = std::max<std::size_t>(most, node.item_count);
        EXPECT_LE(most, 16U);
    }
}

}  // namespace
}  // namespace nuvo
