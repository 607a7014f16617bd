// The hierarchy of single rays: all of every primitive lies in boxes above leaves that list it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "fast/rays/ray_items.h"
#include "fast/rays/wide_bvh.h"
#include "fast_cases.h"

namespace nuvo::testing {
namespace {

using Box = Bounds3T<float>;

/// Walks all of it; notes in which boxes the leaves lie that list a slot, the finest units of their
/// grids, and how deep nodes lie.
class Reader {
  public:
    Reader(const FastScene& scene, const WideBvh& tree)
        : boxes(scene.slot_end()), units(scene.slot_end()), tree_(tree) {
        constexpr float kMost = std::numeric_limits<float>::max();
        read_node(0, {{-kMost, -kMost, -kMost}, {kMost, kMost, kMost}}, 1);
    }

    std::vector<std::vector<Box>> boxes;     ///< by slot
    std::vector<std::vector<double>> units;  ///< the same
    int levels = 0;
    std::size_t nodes = 0;

  private:
    void read_node(std::uint32_t place, const Box& around, int level) {
        ASSERT_LT(place, tree_.nodes.size());
        levels = std::max(levels, level);
        ++nodes;
        const WideNode& node = tree_.nodes[place];
        expect_orders(node);
        for (std::size_t lane = 0; lane < kWideLanes; ++lane) {
            Box box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.min[static_cast<int>(axis)] = node.face[axis * kWideLanes + lane];
                box.max[static_cast<int>(axis)] = node.face[(axis + 3) * kWideLanes + lane];
            }
            if (box.empty()) continue;
            EXPECT_LE(std::max(max_norm(box.min), max_norm(box.max)), tree_.reach);
            box = {max(box.min, around.min), min(box.max, around.max)};
            if ((node.child[lane] & WideBvh::kLeaf) != 0)
                read_leaf(node.child[lane] & ~WideBvh::kLeaf, box);
            else
                read_node(node.child[lane], box, level + 1);
        }
    }

    static void expect_orders(const WideNode& node) {
        for (const auto& words : node.order) {
            std::uint32_t seen = 0;
            for (std::size_t i = 0; i < kWideLanes; ++i)
                seen |= 1U << (words[i % 2] >> (4 * (i / 2)) & 15);
            EXPECT_EQ(seen, 0xffffU);
        }
    }

    void read_leaf(std::uint32_t place, const Box& around) {
        WideLeafHead head;
        std::memcpy(&head, tree_.leaves.data() + place, sizeof head);
        const std::size_t count = std::size_t{head.triangles} + head.spheres + head.others;
        EXPECT_GE(count, 1U);
        EXPECT_LE(count, kMostOfLeaf);
        for (std::size_t i = 0; i < count; ++i) {
            const Slot slot = tree_.leaves[place + kLeafHeadWords + i] & ~kFrontOnly;
            ASSERT_LT(slot, boxes.size());
            boxes[slot].push_back(around);
            units[slot].push_back(static_cast<double>(head.finest_unit()));
        }
    }

    const WideBvh& tree_;
};

bool is_in_any(const std::vector<Box>& boxes, const Point3& p) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
        return Bounds3{Point3(box.min), Point3(box.max)}.contains(p);
    });
}

void expect_all_of_triangle(const Triangle& t, const std::vector<Box>& boxes,
                            std::mt19937_64& random) {
    for (const Point3& corner : {t.a, t.b, t.c}) EXPECT_TRUE(is_in_any(boxes, corner));
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 20; ++i) {
        const double v = unit(random);
        const double w = unit(random) * (1 - v);
        EXPECT_TRUE(is_in_any(boxes, t.a + (t.b - t.a) * v + (t.c - t.a) * w));
    }
}

struct Figures {
    int levels = 0;
    std::size_t most_leaves = 0;  ///< that list one slot
};

Figures expect_sound(const Scene& scene) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const WideBvh tree(fast);
    const Reader reader(fast, tree);
    EXPECT_EQ(reader.nodes, tree.nodes.size());
    EXPECT_LE(reader.levels, WideBvh::kMostLevels);
    Figures figures{reader.levels};
    std::mt19937_64 random(1);
    for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
        SCOPED_TRACE("slot " + std::to_string(slot));
        const std::vector<Box>& boxes = reader.boxes[slot];
        figures.most_leaves = std::max(figures.most_leaves, boxes.size());
        if (slot < fast.triangle_end()) {
            expect_all_of_triangle(local_triangle(fast, slot), boxes, random);
            continue;
        }
        EXPECT_EQ(boxes.size(), 1U);
        const Bounds3& world = primitives.item_boxes[fast.id(slot)];
        EXPECT_TRUE(is_in_any(boxes, fast.frame().local(world.min)));
        EXPECT_TRUE(is_in_any(boxes, fast.frame().local(world.max)));
    }
    return figures;
}

Object triangles_of(std::vector<Point3> corners) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3)
        mesh.triangles.push_back({i, i + 1, i + 2});
    mesh.positions = std::move(corners);
    Object object;
    object.shape = std::move(mesh);
    return object;
}

Scene scene_of(std::vector<Point3> corners) {
    Scene scene;
    scene.objects.push_back(triangles_of(std::move(corners)));
    return scene;
}

void add_triangle(std::vector<Point3>& corners, const Point3& at, double size) {
    corners.insert(corners.end(), {at, at + Vector3{size, 0, 0}, at + Vector3{0, size, size / 2}});
}

TEST(WideBvh, HoldsAllOfEachPrimitive) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expect_sound(random_scene(seed, 700));
    }
    for (std::uint64_t seed = 200; seed < 240; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expect_sound(SceneMaker(seed).scene());
    }
}

TEST(WideBvh, OfNothingIsOneNodeWithoutChildren) { EXPECT_EQ(expect_sound(Scene{}).levels, 1); }

TEST(WideBvh, OfThousandsInOnePlaceIsShallow) {
    std::vector<Point3> corners;
    for (int i = 0; i < 5000; ++i) add_triangle(corners, {1, 2, 3}, 1);
    EXPECT_LE(expect_sound(scene_of(corners)).levels, 4);  // 5,000 / 8 leaves, 16 to a node
}

// Whatever is cut off first is an outermost part of what is left: each of 40 places is half as far
// from the corner as the one before, and so is the size of the triangles there.
TEST(WideBvh, StaysShallowWhereSizesAndDistancesHalveAgainAndAgain) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point3> corners;
    for (int place = 0; place < 40; ++place) {
        const double size = std::ldexp(1.0, -place);
        for (int i = 0; i < 60; ++i)
            add_triangle(corners, {size * unit(random), size * unit(random), size * unit(random)},
                         size / 16);
    }
    EXPECT_LE(expect_sound(scene_of(corners)).levels, 12);
}

// Of a ground that lies in a plane across an axis parts would have no smaller boxes together.
TEST(WideBvh, CutsWhatLiesAcrossOctantsAndNothingElse) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Point3> needles;
    for (int i = 0; i < 500; ++i) {
        const Point3 at{unit(random), unit(random), unit(random)};
        const Vector3 along{unit(random), unit(random), unit(random)};
        needles.insert(needles.end(), {at - along, at + along, at + Vector3{0.001, 0.002, 0}});
    }
    EXPECT_GT(expect_sound(scene_of(needles)).most_leaves, 10U);
    std::vector<Point3> town{{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}};
    for (int i = 0; i < 3000; ++i)
        add_triangle(town, {9 * unit(random), 0.1 * unit(random), 9 * unit(random)}, 0.05);
    EXPECT_EQ(expect_sound(scene_of(town)).most_leaves, 1U);
}

// On the grid of a leaf that it shares a triangle has at least 2^16 / 64 units, or a third of that
// where triangles reach out of the box.
TEST(WideBvh, PartsSmallTrianglesFromLargeOnes) {
    std::vector<Point3> corners;
    for (int i = 0; i < 4; ++i) add_triangle(corners, {0, 0, 0.001 * i}, 1);
    for (int i = 0; i < 4; ++i) add_triangle(corners, {0.25, 0.25, 0.0001 * i}, 0.001);
    const Scene scene = scene_of(corners);
    expect_sound(scene);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const WideBvh tree(fast);
    const Reader reader(fast, tree);
    for (Slot slot = 4; slot < fast.slot_end(); ++slot) {
        const Bounds3 box = local_triangle(fast, slot).bounds();
        ASSERT_FALSE(reader.units[slot].empty());
        for (const double unit : reader.units[slot])
            EXPECT_GE(max_norm(box.widths()), 170 * unit) << "slot " << slot;
    }
}

}  // namespace
}  // namespace nuvo::testing
