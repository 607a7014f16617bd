#include "fast/scene/fast_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace nuvo {
namespace {

// The check of the tree's promise works in long double, by other means than the builder: triangles
// are clipped instead of separated. What it calls touching is touching by more than kSure, which
// exceeds the error of a few dozen long double operations on coordinates of about 1.
using Wide = long double;
using WidePoint = std::array<Wide, 3>;
constexpr Wide kSure = 0x1p-52L;

struct WideBox {
    WidePoint min;
    WidePoint max;
};

struct Leaf {
    WideBox box;
    std::vector<Slot> items;
};

void read_leaves(const CompactOctree& tree, std::uint32_t index, const WideBox& box,
                 std::vector<Leaf>& leaves) {
    const CompactNode& node = tree.nodes[index];
    if (node.is_leaf()) {
        const auto first = tree.items.begin() + node.first_item();
        leaves.push_back({box, {first, first + node.item_count()}});
        EXPECT_TRUE(std::is_sorted(leaves.back().items.begin(), leaves.back().items.end()));
        return;
    }
    for (unsigned o = 0; o < 8; ++o) {
        WideBox child = box;
        bool there = true;  // not the upper side of an axis that is not cut
        for (unsigned axis = 0; axis < 3; ++axis) {
            ((o >> axis & 1U) != 0 ? child.min : child.max)[axis] = node.cut[axis];
            there &= child.min[axis] < child.max[axis];
        }
        if (!there) {
            ASSERT_EQ(node.mask() >> o & 1U, 0U);
            continue;
        }
        if ((node.mask() >> o & 1U) != 0)
            read_leaves(tree, node.child(o), child, leaves);
        else
            leaves.push_back({child, {}});  // as if it were there: nothing may touch it
    }
}

std::vector<Leaf> leaves_of(const CompactOctree& tree) {
    std::vector<Leaf> leaves;
    const auto wide = [](const Vec3<float>& v) { return WidePoint{v.x, v.y, v.z}; };
    read_leaves(tree, 0, {wide(tree.bounds.min), wide(tree.bounds.max)}, leaves);
    return leaves;
}

WidePoint local(const LocalFrame& frame, const Point3& p) {
    WidePoint q;
    for (int axis = 0; axis < 3; ++axis)
        q[static_cast<std::size_t>(axis)] =
            (static_cast<Wide>(p[axis]) - static_cast<Wide>(frame.center[axis])) *
            static_cast<Wide>(frame.scale);
    return q;
}

// Whether a convex polygon has a point in the box shrunk by kSure. (Sutherland and Hodgman)
bool surely_touches(std::vector<WidePoint> polygon, const WideBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Wide side : {Wide{1}, Wide{-1}}) {
            const Wide limit = (side > 0 ? box.max[axis] : -box.min[axis]) - kSure;
            std::vector<WidePoint> kept;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const WidePoint& p = polygon[i];
                const WidePoint& q = polygon[(i + 1) % polygon.size()];
                const Wide inside_p = limit - side * p[axis];
                const Wide inside_q = limit - side * q[axis];
                if (inside_p >= 0) kept.push_back(p);
                if ((inside_p < 0) == (inside_q < 0)) continue;
                const Wide share = inside_p / (inside_p - inside_q);
                WidePoint cut;
                for (std::size_t k = 0; k < 3; ++k) cut[k] = p[k] + share * (q[k] - p[k]);
                kept.push_back(cut);
            }
            polygon = kept;
        }
    return !polygon.empty();
}

bool surely_touches(const WidePoint& center, Wide radius, const WideBox& box) {
    Wide nearest = 0;
    Wide farthest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Wide below = box.min[k] - center[k];
        const Wide above = center[k] - box.max[k];
        const Wide outside = std::max({Wide{0}, below, above});
        const Wide across = std::max(std::abs(below), std::abs(above));
        nearest += outside * outside;
        farthest += across * across;
    }
    return std::sqrt(nearest) < radius - kSure && std::sqrt(farthest) > radius + kSure;
}

bool contains(const WideBox& box, const WidePoint& p) {
    for (std::size_t k = 0; k < 3; ++k)
        if (p[k] < box.min[k] + kSure || p[k] > box.max[k] - kSure) return false;
    return true;
}

// Points of an ellipsoid's surface, in a regular pattern.
std::vector<WidePoint> surface_points(const LocalFrame& frame, const Ellipsoid& e) {
    std::vector<WidePoint> points;
    for (int i = 0; i < 400; ++i) {
        const double z = 1 - 2 * (i + 0.5) / 400;
        const double r = std::sqrt(1 - z * z);
        const Vector3 n = normalized(Vector3{r * std::cos(2.4 * i), r * std::sin(2.4 * i), z});
        points.push_back(local(frame, e.center + e.linear * (n * e.radius)));
    }
    return points;
}

// Calls `touches(box)` of every primitive.
template <typename Use>
void with_touch_test(const FastScene& fast, Slot slot, const Use& use) {
    const PrimitiveSource& source = fast.source(slot);
    const Shape& shape = fast.scene().objects[source.object].shape;
    const LocalFrame& frame = fast.frame();
    if (slot < fast.triangle_end()) {
        const Triangle t = std::get<TriangleMesh>(shape).triangle(source.triangle);
        const std::vector<WidePoint> corners{local(frame, t.a), local(frame, t.b),
                                             local(frame, t.c)};
        use([&](const WideBox& box) { return surely_touches(corners, box); });
    } else if (slot < fast.sphere_end()) {
        const Sphere& s = std::get<Sphere>(shape);
        const WidePoint center = local(frame, s.center);
        const Wide radius = static_cast<Wide>(s.radius) * static_cast<Wide>(frame.scale);
        use([&](const WideBox& box) { return surely_touches(center, radius, box); });
    } else {
        const auto points = surface_points(frame, std::get<Ellipsoid>(shape));
        use([&](const WideBox& box) {
            return std::any_of(points.begin(), points.end(),
                               [&](const WidePoint& p) { return contains(box, p); });
        });
    }
}

struct Touches {
    std::size_t sure = 0;    // pairs of a leaf and a primitive that surely touch
    std::size_t listed = 0;  // pairs that are listed
};

Touches expect_complete(const FastScene& fast) {
    const std::vector<Leaf> leaves = leaves_of(fast.octree());
    Touches touches;
    for (const Leaf& leaf : leaves) touches.listed += leaf.items.size();
    for (Slot slot = 0; slot < fast.slot_end(); ++slot)
        with_touch_test(fast, slot, [&](const auto& touching) {
            bool anywhere = false;
            for (const Leaf& leaf : leaves) {
                const bool listed = std::binary_search(leaf.items.begin(), leaf.items.end(), slot);
                const bool sure = touching(leaf.box);
                anywhere |= listed;
                touches.sure += sure ? 1 : 0;
                ASSERT_TRUE(listed || !sure) << "slot " << slot;
            }
            ASSERT_TRUE(anywhere) << "slot " << slot;
        });
    return touches;
}

constexpr OctreeType kTypes[] = {OctreeType::kUniform, OctreeType::kNonuniform};

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    Point3 point(double size) {
        return {number(-size, size), number(-size, size), number(-size, size)};
    }

  private:
    std::mt19937_64 engine_;
};

// Triangles of all sizes, many thin, some large.
Object random_mesh(Random& random, int count, const Point3& place, double scale) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double size = std::exp2(random.number(-9, 0));
        const Point3 a = random.point(1);
        const Vector3 e = random.point(size);
        const Vector3 along = i % 3 == 0 ? e * random.number(0, 1) : Vector3{};
        const Vector3 f = along + random.point(i % 3 == 0 ? size * 1e-4 : size);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Point3& p : {a, a + e, a + f}) mesh.positions.push_back(place + p * scale);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    Object object;
    object.shape = mesh;
    return object;
}

Object random_sphere(Random& random, const Point3& place, double scale) {
    Object object;
    object.shape = Sphere{place + random.point(1) * scale, std::exp2(random.number(-8, 0)) * scale};
    return object;
}

Scene mixed_scene(unsigned seed, const Point3& place, double scale) {
    Random random(seed);
    Scene scene;
    for (int i = 0; i < 40; ++i) {
        scene.objects.push_back(random_sphere(random, place, scale));
        scene.objects.push_back(random_mesh(random, 10, place, scale));
        Ellipsoid e{place + random.point(1) * scale, {}, 0.2 * scale};
        for (int row = 0; row < 3; ++row) e.linear.row[row] = random.point(0.5);
        Object object;
        object.shape = e;
        if (i % 4 == 0) scene.objects.push_back(object);
    }
    return scene;
}

TEST(FastScene, EveryLeafListsWhatTouchesIt) {
    for (const OctreeType type : kTypes)
        for (const unsigned seed : {1U, 2U, 3U}) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random random(seed);
            Scene scene;
            scene.objects.push_back(random_mesh(random, 1200, {1, 2, 3}, 1));
            for (int i = 0; i < 300; ++i)
                scene.objects.push_back(random_sphere(random, {1, 2, 3}, 1));
            const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
            const Touches touches = expect_complete(FastScene(scene, primitives, type, 1));
            EXPECT_GT(touches.sure, 3000U);
            // The boxes of a leaf's items mostly decide: these are thin or large ones.
            EXPECT_LT(static_cast<double>(touches.listed), 1.5 * static_cast<double>(touches.sure));
        }
}

TEST(FastScene, PlaceAndScaleChangeNothing) {
    const struct {
        Point3 place;
        double scale;
    } cases[] = {{{0, 0, 0}, 1e-300}, {{0, 0, 0}, 1e300},         {{1e6, -1e6, 1e6}, 1},
                 {{1e9, 0, 0}, 1e-3}, {{0, 0, 0}, 1e-15},         {{0, 0, 0}, 1.5e308},
                 {{0, 0, 0}, 1e-307}, {{-1e300, 0, 1e300}, 1e290}};
    for (const OctreeType type : kTypes)
        for (const auto& [place, scale] : cases) {
            SCOPED_TRACE("scale " + std::to_string(std::log10(scale)));
            const Scene scene = mixed_scene(4, place, scale * 0.5);
            const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
            const FastScene fast(scene, primitives, type, 1);
            int exponent = 0;
            EXPECT_EQ(std::frexp(fast.frame().scale, &exponent), 0.5) << "no power of two";
            const Bounds3T<float>& root = fast.octree().bounds;
            EXPECT_LT(max_norm(root.min), 1.01F);
            EXPECT_LT(max_norm(root.max), 1.01F);
            EXPECT_GT(max_norm(root.widths()), 0.99F);
            EXPECT_GT(fast.octree().nodes.size(), 50U);
            expect_complete(fast);
        }
}

TEST(FastScene, SlotsAreTrianglesThenSpheresThenEllipsoidsInDocumentOrder) {
    const Scene scene = mixed_scene(5, {0, 0, 0}, 1);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    EXPECT_EQ(fast.triangle_end(), 400U);
    EXPECT_EQ(fast.sphere_end(), 440U);
    EXPECT_EQ(fast.slot_end(), 450U);
    std::vector<bool> met(primitives.sources.size(), false);
    for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
        const Shape& shape = scene.objects[fast.source(slot).object].shape;
        ASSERT_EQ(shape.index(), slot < fast.triangle_end() ? 2U
                                 : slot < fast.sphere_end() ? 0U
                                                            : 1U);
        ASSERT_FALSE(met[fast.id(slot)]);
        met[fast.id(slot)] = true;
        if (slot != 0 && slot != fast.triangle_end() && slot != fast.sphere_end()) {
            ASSERT_LT(fast.id(slot - 1), fast.id(slot));
        }
    }
}

TEST(FastScene, TheTreeDoesNotDependOnTheNumberOfThreads) {
    Random random(6);
    Scene scene;
    scene.objects.push_back(random_mesh(random, 12000, {0, 0, 0}, 1));
    for (int i = 0; i < 3000; ++i) scene.objects.push_back(random_sphere(random, {0, 0, 0}, 1));
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    for (const OctreeType type : kTypes) {
        const FastScene one(scene, primitives, type, 1);
        for (const int threads : {2, 7}) {
            const FastScene many(scene, primitives, type, threads);
            EXPECT_EQ(many.octree().bounds, one.octree().bounds);
            EXPECT_EQ(many.octree().items, one.octree().items);
            ASSERT_EQ(many.octree().nodes.size(), one.octree().nodes.size());
            for (std::size_t i = 0; i < one.octree().nodes.size(); ++i)
                ASSERT_EQ(many.octree().nodes[i].children, one.octree().nodes[i].children);
        }
    }
}

// Calls use(leaf) for each leaf of both octrees of a mesh.
template <typename Use>
void for_each_leaf(const TriangleMesh& mesh, Use&& use) {
    Scene scene;
    scene.objects.push_back({mesh});
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    for (const OctreeType type : kTypes) {
        const FastScene fast(scene, primitives, type, 1);
        for (const Leaf& leaf : leaves_of(fast.octree())) use(leaf);
    }
}

TEST(FastScene, TrianglesAsLargeAsTheSceneAreParted) {
    // One cut does not pay: each of them touches more than half of the octants.
    Random random(10);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(random.point(1));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    for_each_leaf(mesh, [](const Leaf& leaf) { EXPECT_LT(leaf.items.size(), 1000U); });
}

TEST(FastScene, SliversThatShareACornerAreParted) {
    // The box of one touches half of the octants of a voxel that it crosses, the sliver two.
    Random random(11);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const Vector3 along = normalized(random.point(1) - Point3{});
        mesh.positions.push_back({0, 0, 0});
        mesh.positions.push_back(Point3{} + along);
        mesh.positions.push_back(Point3{} + along + (random.point(1) - Point3{}) * 0.01);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    for_each_leaf(mesh, [](const Leaf& leaf) {
        Wide away = 0;
        for (unsigned axis = 0; axis < 3; ++axis)
            away = std::max({away, leaf.box.min[axis], -leaf.box.max[axis]});
        // Apart from their common corner few are near each other.
        if (away > 0.0625) {
            EXPECT_LT(leaf.items.size(), 500U);
        }
    });
}

TEST(FastScene, AnEmptySceneIsAnEmptyLeaf) {
    const Scene scene;
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kNonuniform, 2);
    EXPECT_EQ(fast.slot_end(), 0U);
    ASSERT_EQ(fast.octree().nodes.size(), 1U);
    EXPECT_EQ(fast.octree().nodes[0].item_count(), 0U);
}

}  // namespace
}  // namespace nuvo
