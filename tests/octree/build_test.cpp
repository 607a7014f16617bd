#include "nuvo/octree/build.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <sstream>

namespace nuvo {
namespace {

std::vector<Bounds3> random_boxes(unsigned seed, std::size_t count, double size) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0, 100);
    std::vector<Bounds3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 p{place(random), place(random), place(random)};
        boxes.push_back({p, p + Vector3{size, size, size}});
    }
    return boxes;
}

// The published algorithm as written, without running sums: the whole tree is summed up before and
// after every trial split. [thesis 4.4.2]
class RecomputingBuilder {
  public:
    RecomputingBuilder(const std::vector<Bounds3>& boxes, const CostModel& costs,
                       MidpointStrategy midpoint, int max_depth)
        : boxes_(boxes), costs_(costs), midpoint_(std::move(midpoint)), max_depth_(max_depth) {
        Bounds3 root;
        std::vector<ItemId> all;
        for (const Bounds3& box : boxes) {
            root = root.extended(box);
            all.push_back(static_cast<ItemId>(all.size()));
        }
        leaves_[0] = {root, all};
        root_area_ = root.surface_area();
        subdivide(0, 1);
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
    double score() const {
        SahTotals totals;
        for (const auto& [name, cell] : interiors_) totals.interior_area += cell.box.surface_area();
        for (const auto& [name, cell] : leaves_) {
            totals.leaf_area += cell.box.surface_area();
            totals.leaf_area_objects +=
                cell.box.surface_area() * static_cast<double>(cell.items.size());
        }
        return sah(totals, root_area_, costs_(leaves_.size()));
    }
    void subdivide(Label name, int level) {
        if (level >= max_depth_) return;
        const Cell cell = leaves_.at(name);
        Voxel voxel = Voxel::centered(cell.box);
        std::vector<Bounds3> inside;
        for (ItemId id : cell.items) inside.push_back(boxes_[id]);
        const auto midpoint = midpoint_({voxel, inside});
        if (!midpoint) return;
        voxel.midpoint = *midpoint;
        const double before = score();
        leaves_.erase(name);
        interiors_[name] = cell;
        for (int digit = 1; digit <= 8; ++digit) {
            Cell child{voxel.octant(digit), {}};
            for (ItemId id : cell.items)
                if (boxes_[id].overlaps(child.box)) child.items.push_back(id);
            leaves_[child_label(name, digit)] = child;
        }
        if (score() < before) {
            for (int digit = 1; digit <= 8; ++digit) subdivide(child_label(name, digit), level + 1);
        } else {
            for (int digit = 1; digit <= 8; ++digit) leaves_.erase(child_label(name, digit));
            interiors_.erase(name);
            leaves_[name] = cell;
        }
    }

    const std::vector<Bounds3>& boxes_;
    CostModel costs_;
    MidpointStrategy midpoint_;
    int max_depth_;
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
    const SahCosts costs = ThesisCosts{1000, 2}(15);
    EXPECT_DOUBLE_EQ(costs.interior, 225);
    EXPECT_DOUBLE_EQ(costs.leaf, 1000.0 / 15);
    EXPECT_DOUBLE_EQ(costs.object, 2e6);
}

TEST(Build, RunningSumsDecideAsTheWholeTreeDoes) {
    for (const bool uniform : {true, false}) {
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const auto boxes = random_boxes(seed, 60, seed * 2.0);
            BuildOptions options;
            options.midpoint = uniform ? spatial_midpoint : mlsl_sbplx_midpoint;
            options.worth = CostModel(ThesisCosts{480, 2});
            options.max_depth = 6;
            const Octree octree = build_octree(boxes, options);
            const RecomputingBuilder oracle(boxes, ThesisCosts{480, 2}, options.midpoint, 6);
            EXPECT_GT(octree.leaf_count(), 8U);
            EXPECT_EQ(leaf_names(octree), oracle.leaf_names());
        }
    }
}

TEST(Build, LeavesTileTheRootAndListWhatTheyOverlap) {
    const auto boxes = random_boxes(9, 300, 3);
    for (const auto& midpoint :
         {MidpointStrategy(spatial_midpoint), MidpointStrategy(sweep_midpoint),
          MidpointStrategy(mlsl_sbplx_midpoint)}) {
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

TEST(Build, CutsNothingMoreOnceItsReferencesAreSpent) {
    const auto boxes = random_boxes(6, 400, 60);  // each spans most of the root
    BuildOptions options;
    // A price under which every cut seems worth it.
    options.worth = CostModel([](std::size_t leaves) {
        return SahCosts{0, 1.0 / (static_cast<double>(leaves) * static_cast<double>(leaves)), 0};
    });
    options.max_depth = 4;
    const std::size_t unlimited = build_octree(boxes, options).reference_count();
    options.max_references = 4000;
    const std::size_t limited = build_octree(boxes, options).reference_count();
    EXPECT_GT(unlimited, 15000U);
    EXPECT_LT(limited, 4000U + 8 * boxes.size());  // the last cut may overshoot
    EXPECT_GE(limited, 400U);
    options.max_references = unlimited;
    EXPECT_EQ(build_octree(boxes, options).reference_count(), unlimited);
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

TEST(Octree, FindLeafReturnsTheHalfOpenLeaf) {
    const auto boxes = random_boxes(3, 200, 2);
    BuildOptions options;
    options.worth = MaxObjects{4};
    const Octree octree = build_octree(boxes, options);
    std::mt19937_64 random(77);
    std::uniform_real_distribution<double> place(0, 100);
    for (int i = 0; i < 2000; ++i) {
        // Half of the points on stored faces.
        Point3 p{place(random), place(random), place(random)};
        if (i % 2 == 0) p = octree.nodes()[random() % octree.nodes().size()].voxel.bounds.min;
        const auto leaf = octree.find_leaf(p);
        ASSERT_EQ(leaf.has_value(), octree.root().voxel.contains(p));
        if (leaf) {
            EXPECT_TRUE(octree.nodes()[*leaf].is_leaf());
            EXPECT_TRUE(octree.nodes()[*leaf].voxel.contains(p));
        }
    }
}

TEST(Octree, SmallestWidthIsTheNarrowestLeafs) {
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{7, 7, 7}, {8, 16, 32}}};
    BuildOptions options;
    options.worth = MaxObjects{1};
    const Octree octree = build_octree(boxes, options);
    double narrowest = 1e300;
    for (const Node& node : octree.nodes()) {
        const Vector3 w = node.voxel.bounds.widths();
        if (node.is_leaf()) narrowest = std::min({narrowest, w.x, w.y, w.z});
    }
    EXPECT_EQ(octree.smallest_width(), narrowest);
    EXPECT_EQ(octree.smallest_width(), 4);
}

TEST(Octree, NextVoxelPointLiesInTheNextLeafOfTheRay) {
    const auto boxes = random_boxes(3, 100, 2);
    BuildOptions options;
    options.worth = MaxObjects{4};
    const Octree octree = build_octree(boxes, options);
    std::mt19937_64 random(78);
    std::uniform_real_distribution<double> place(1, 99);
    for (int i = 0; i < 1000; ++i) {
        // Along an axis the next leaf is the face neighbour, so the answer is plain to see.
        const Point3 p{place(random), place(random), place(random)};
        const int axis = i % 3;
        Ray ray{p, {}};
        ray.direction[axis] = i % 2 == 0 ? 2.0 : -0.5;
        const Node& leaf = octree.nodes()[*octree.find_leaf(p)];
        const Point3 next = octree.point_next_voxel(ray);
        const double beyond = i % 2 == 0 ? next[axis] - leaf.voxel.bounds.max[axis]
                                         : leaf.voxel.bounds.min[axis] - next[axis];
        EXPECT_GT(beyond, 0);
        EXPECT_LT(beyond, octree.smallest_width());
    }
}

TEST(Octree, PrintsANodeALineIndentedByLevel) {
    const std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{7, 7, 7}, {8, 8, 8}}};
    BuildOptions options;
    options.worth = MaxObjects{1};
    std::ostringstream text;
    print(text, build_octree(boxes, options));
    EXPECT_EQ(text.str().substr(0, text.str().find('\n', text.str().find('\n') + 1)),
              "0 node [0 0 0] [8 8 8] midpoint [4 4 4]\n  1 leaf [0 4 0] [4 8 4] 0 items");
}

}  // namespace
}  // namespace nuvo
