#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "gap.h"
#include "measure.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::study {
namespace {

Scene scene_of(const std::string& name) {
    return x3d::read_file(std::string(NUVO_SOURCE_DIR) + "/testfiles/" + name + ".x3d");
}

std::vector<const Method*> all_methods() {
    std::vector<const Method*> all;
    for (const Method& method : methods()) all.push_back(&method);
    return all;
}

/// Voxels of a random scene: boxes of mixed sizes, some larger than the voxel.
AskedVoxel random_voxel(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    AskedVoxel asked;
    asked.voxel = Voxel::centered({{-1, -2, -3}, {2, 1, 2}});
    const std::size_t count = 2 + random() % 30;
    for (std::size_t i = 0; i < count; ++i) {
        Bounds3 box;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = -4 + 7 * unit(random);
            box.min[axis] = low;
            box.max[axis] = low + unit(random) * unit(random) * 4;
        }
        asked.boxes.push_back(box);
    }
    return asked;
}

/// Values of one objective differ by the roundings of a few operations.
constexpr double kRounding = 0x1p-40;

SplitQuery query_of(const AskedVoxel& asked) { return {asked.voxel, asked.boxes, asked.margin}; }

class OnScene : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Study, OnScene,
                         testing::Values("trianglemesh", "both", "concentric", "clumped"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(OnScene, EveryPictureIsBruteForces) {
    const Scene scene = scene_of(GetParam());
    for (const bool in_program : {false, true}) {
        MeasureOptions options;
        options.tree.in_program = in_program;
        options.tree.leaves = in_program ? LeafContent::kPrimitives : LeafContent::kShapes;
        options.resolution = {80, 45};
        options.brute_resolution = {32, 18};
        options.random_rays = 200;
        options.rounds = 0;
        const std::vector<const Method*> all = all_methods();
        for (const Row& row : measure(scene, all, true, options)) {
            EXPECT_TRUE(row.same_as_brute) << row.name;
            EXPECT_TRUE(row.same_picture) << row.name;
            EXPECT_GT(row.camera.tests, 0U) << row.name;
        }
    }
}

TEST_P(OnScene, NoMethodIsBelowTheExactOptimumOnAnyVoxel) {
    const Scene scene = scene_of(GetParam());
    TreeOptions options;
    options.leaves = LeafContent::kShapes;
    const Primitives primitives = flatten(scene, options.leaves);
    const std::vector<AskedVoxel> voxels = asked_voxels(scene, primitives, options, 300);
    ASSERT_GT(voxels.size(), 20U);
    for (const Method& method : methods()) {
        const MidpointStrategy strategy = method.make(nullptr);
        for (const AskedVoxel& asked : voxels) {
            const SplitQuery query = query_of(asked);
            const std::optional<Point3> planes = strategy(query);
            if (!planes) continue;
            for (int axis = 0; axis < 3; ++axis) {
                const double plane = (*planes)[axis];
                for (const Weight weight : {Weight::kShare, Weight::kArea})
                    for (const Space space : {Space::kMedians, Space::kVoxel}) {
                        const Interval interval = interval_of(query, axis, space);
                        if (!(interval.low <= plane && plane <= interval.high)) continue;
                        const AxisObjective objective(query, axis, weight);
                        EXPECT_LE(objective.least(interval).value,
                                  objective(plane) * (1 + kRounding))
                            << method.name;
                    }
            }
        }
    }
}

TEST(Objective, IsLeastOfAllPlanesTried) {
    constexpr unsigned kSeed = 20181;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 200; ++round) {
        const AskedVoxel asked = random_voxel(random);
        const SplitQuery query = query_of(asked);
        for (const Weight weight : {Weight::kShare, Weight::kArea})
            for (const Space space : {Space::kMedians, Space::kVoxel})
                for (int axis = 0; axis < 3; ++axis) {
                    const Interval interval = interval_of(query, axis, space);
                    if (interval.empty()) continue;
                    const AxisObjective objective(query, axis, weight);
                    const auto least = objective.least(interval);
                    EXPECT_EQ(least.value, objective(least.plane));
                    EXPECT_LE(interval.low, least.plane);
                    EXPECT_LE(least.plane, interval.high);
                    for (int i = 0; i < 200; ++i)
                        EXPECT_LE(least.value,
                                  objective(interval.low +
                                            unit(random) * (interval.high - interval.low)) *
                                      (1 + kRounding));
                }
    }
}

TEST(Objective, OfEquation19IsTheProgramsScore) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 50; ++round) {
        const AskedVoxel asked = random_voxel(random);
        const SplitQuery query = query_of(asked);
        const Point3 center = asked.voxel.bounds.center();
        const double score = MidpointScore(query).product(center);
        EXPECT_NEAR(objective(query, center, Weight::kShare), score, kRounding * score);
    }
}

// The minimum of the sum and of the product over a box is the same point: three searches on one
// axis each.
TEST(Objective, Equation16And19HaveOneMinimum) {
    std::mt19937_64 random(16);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 50; ++round) {
        const AskedVoxel asked = random_voxel(random);
        const SplitQuery query = query_of(asked);
        Point3 best;
        for (int axis = 0; axis < 3; ++axis)
            best[axis] = AxisObjective(query, axis, Weight::kShare)
                             .least(interval_of(query, axis, Space::kVoxel))
                             .plane;
        const MidpointScore score(query);
        for (int i = 0; i < 200; ++i) {
            Point3 other;
            for (int axis = 0; axis < 3; ++axis)
                other[axis] =
                    asked.voxel.bounds.min[axis] + unit(random) * asked.voxel.bounds.widths()[axis];
            EXPECT_LE(score.sum(best), score.sum(other) * (1 + kRounding));
            EXPECT_LE(score.product(best), score.product(other) * (1 + kRounding));
        }
    }
}

// What a method counts on both sides of its planes is what the builder lists there.
TEST_P(OnScene, ReferencesPlacedEqualTheCounted) {
    const Scene scene = scene_of(GetParam());
    const Primitives primitives = flatten(scene, LeafContent::kShapes);
    struct Asked {
        AskedVoxel voxel;
        Point3 planes;
    };
    for (const char* name : {"octree-r", "eq19-voxel", "sweep", "mlsl-lds-sbplx"}) {
        std::vector<Asked> asked;
        const MidpointStrategy strategy = find_method(name)->make(nullptr);
        BuildOptions build;
        build.midpoint = [&](const SplitQuery& query) {
            const std::optional<Point3> planes = strategy(query);
            if (planes)
                asked.push_back(
                    {{query.voxel, {query.boxes.begin(), query.boxes.end()}, query.margin},
                     *planes});
            return planes;
        };
        build.worth = costs_of(primitives, 6);
        build.margin = margin_of(primitives);
        const Octree octree = build_octree(primitives.item_boxes, build);
        std::size_t checked = 0;
        for (const Node& node : octree.nodes()) {
            if (node.is_leaf()) continue;
            const auto found = std::ranges::find_if(asked, [&](const Asked& a) {
                return a.voxel.voxel.bounds == node.voxel.bounds && a.planes == node.voxel.midpoint;
            });
            if (found == asked.end()) continue;  // an axis was left uncut
            ++checked;
            for (int axis = 0; axis < 3; ++axis) {
                if (!(found->planes[axis] < node.voxel.bounds.max[axis])) continue;  // uncut
                // Every item below, as the leaves list them.
                std::vector<ItemId> lower, upper;
                const auto collect = [&](auto&& self, const Node& n,
                                         std::vector<ItemId>& out) -> void {
                    if (n.is_leaf()) {
                        const auto items = octree.contents(n);
                        out.insert(out.end(), items.begin(), items.end());
                        return;
                    }
                    for (int digit = 1; digit <= 8; ++digit)
                        self(self, octree.nodes()[n.child(digit)], out);
                };
                for (int digit = 1; digit <= 8; ++digit)
                    collect(collect, octree.nodes()[node.child(digit)],
                            (octant_bits(digit) >> axis & 1) != 0 ? upper : lower);
                for (std::vector<ItemId>* side : {&lower, &upper}) {
                    std::ranges::sort(*side);
                    side->erase(std::unique(side->begin(), side->end()), side->end());
                }
                const AxisEdges edges(found->voxel.boxes, axis);
                EXPECT_EQ(lower.size(), edges.left_of(found->planes[axis])) << name;
                EXPECT_EQ(upper.size(), edges.right_of(found->planes[axis])) << name;
            }
        }
        EXPECT_GT(checked, 0U) << name;
    }
}

TEST(Study, SweepPartsTheGridOfTest1) {
    const Scene scene = scene_of("trianglemesh");
    MeasureOptions options;
    options.tree.leaves = LeafContent::kShapes;
    options.tree.thesis_costs = true;
    options.random_rays = 0;
    options.rounds = 0;
    const std::vector<const Method*> two{find_method("spatial"), find_method("sweep")};
    const std::vector<Row> rows = measure(scene, two, false, options);
    const double rays = options.resolution.width * options.resolution.height;
    EXPECT_GT(static_cast<double>(rows[0].camera.tests) / rays, 8);
    EXPECT_LT(static_cast<double>(rows[1].camera.tests) / rays, 1.1);
}

TEST_P(OnScene, PruningNeverRaisesTheExpectedCost) {
    const Scene scene = scene_of(GetParam());
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    TreeOptions options;
    options.step = 1;
    const Octree deep = build_tree(scene, primitives, *find_method("spatial"), options);
    const CalibratedCosts costs{6};
    const Octree octree = pruned(deep, costs);
    const double area = deep.root().voxel.bounds.surface_area();
    EXPECT_LT(octree.leaf_count(), deep.leaf_count());
    EXPECT_LE(sah(sah_totals(octree), area, costs.costs()),
              sah(sah_totals(deep), area, costs.costs()));
}

std::vector<Bounds3> points(const std::vector<Point3>& centers) {
    std::vector<Bounds3> boxes;
    for (const Point3& p : centers) boxes.push_back({p, p});
    return boxes;
}

TEST(MlslSbplx, StaysBetweenTheMediansAndIsDeterministic) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {8, 4, 2}});
    constexpr unsigned kSeed = 7;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 200; ++i) {
        const Point3 low{2.5 * unit(random), 3.5 * unit(random), 1.5 * unit(random)};
        boxes.push_back(
            {low, low + Vector3{0.5 * unit(random), 0.5 * unit(random), 0.5 * unit(random)}});
    }
    const SplitQuery query{voxel, boxes};
    const auto midpoint = mlsl_lds_sbplx(nullptr)(query);
    ASSERT_TRUE(midpoint);
    for (int axis = 0; axis < 3; ++axis) {
        const double median = object_median(boxes, axis);
        EXPECT_GE((*midpoint)[axis], std::min(median, voxel.midpoint[axis]));
        EXPECT_LE((*midpoint)[axis], std::max(median, voxel.midpoint[axis]));
    }
    EXPECT_EQ(mlsl_lds_sbplx(nullptr)(query), midpoint);
    const MidpointScore score(query);
    EXPECT_LE(score.product(*midpoint), score.product(voxel.midpoint));
}

TEST(MlslSbplx, DoesNotCutWhereTheMedianIsOnOrOutsideAFace) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {1, 1, 1}});
    EXPECT_FALSE(mlsl_lds_sbplx(nullptr)({voxel, points({{1, 0.5, 0.5}})}));
    EXPECT_FALSE(mlsl_lds_sbplx(nullptr)({voxel, points({{0.5, -2, 0.5}})}));
    EXPECT_FALSE(mlsl_lds_sbplx(nullptr)({voxel, {}}));
}

TEST(MlslSbplx, TakesTheCommonPointWhereTheMediansCoincide) {
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {2, 2, 2}});
    const auto same = points({{0.5, 1, 1}, {1.5, 1, 1}});  // mean of the middle two is the centre
    EXPECT_EQ(mlsl_lds_sbplx(nullptr)({voxel, same}), (Point3{1, 1, 1}));
    const auto one_axis = points({{0.5, 1, 1}, {0.7, 1, 1}});  // y and z bounds are equal
    const auto midpoint = mlsl_lds_sbplx(nullptr)({voxel, one_axis});
    ASSERT_TRUE(midpoint);
    EXPECT_EQ(midpoint->y, 1);
    EXPECT_EQ(midpoint->z, 1);
}

}  // namespace
}  // namespace nuvo::study
