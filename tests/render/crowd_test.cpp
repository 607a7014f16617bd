#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "direction_cells.h"
#include "leaf_boxes.h"

// What a crowd leaves out must not be hit. Truth: the exact predicate of every triangle.
namespace nuvo {
namespace {

constexpr std::uint64_t kSeed = 20261128;

// Coordinates of one scene, many of them powers of two apart.
class Scales {
  public:
    explicit Scales(std::uint64_t seed) : engine_(seed) {
        for (int& exponent : exponents_)
            exponent = static_cast<int>(engine_() % 3) == 0
                           ? 0
                           : static_cast<int>(engine_() % 1800) - 1000;
    }
    double coordinate() {
        const int exponent = engine_() % 4 == 0 ? exponents_[engine_() % 3] : 0;
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(engine_), exponent);
    }
    Vector3 vector() { return {coordinate(), coordinate(), coordinate()}; }
    // Thin, long, small and plain ones.
    Triangle triangle() {
        const Point3 a = vector();
        switch (engine_() % 3) {
            case 0:
                return {a, vector(), vector()};
            case 1:
                return {a, a + vector() * 0x1p-10, a + vector() * 0x1p-10};
            default: {
                const Vector3 along = vector();
                return {a, a + along, a + along * 0.5 + vector() * 0x1p-12};
            }
        }
    }
    // Towards a point of the triangle, or anywhere.
    Vector3 towards(const Triangle& t, const Point3& from) {
        if (engine_() % 4 == 0) return vector();
        const double v = std::uniform_real_distribution<double>(0, 1)(engine_);
        const double w = std::uniform_real_distribution<double>(0, 1 - v)(engine_);
        return t.a + (t.b - t.a) * v + (t.c - t.a) * w - from;
    }
    std::size_t below(std::size_t n) { return engine_() % n; }

  private:
    std::mt19937_64 engine_;
    int exponents_[3];
};

bool finite(const Vector3& v) { return std::isfinite(max_norm(v)); }

TEST(Crowd, BoxesLeaveOutNothingThatIsHit) {
    std::size_t hits = 0, asked = 0, listed = 0;
    for (std::uint64_t scene = 0; scene < 150; ++scene) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", scene " << scene);
        Scales scales(kSeed + scene);
        std::vector<Triangle> triangles(100);
        std::vector<Bounds3> boxes;
        std::vector<ItemId> items;
        for (Triangle& t : triangles) {
            t = scales.triangle();
            items.push_back(static_cast<ItemId>(boxes.size()));
            boxes.push_back(t.bounds());
        }
        const LeafBoxes leaf(items, boxes);
        StageCounts counts;
        for (int k = 0; k < 40; ++k) {
            const Point3 origin = scales.vector();
            const Vector3 d = scales.towards(triangles[scales.below(triangles.size())], origin);
            if (!finite(d)) continue;
            const ExactRay ray(Ray{origin, d});
            std::vector<bool> visited(triangles.size());
            const double end = k % 2 == 0 ? std::numeric_limits<double>::infinity() : 1;
            leaf.visit(
                ray, [&] { return end; }, [&](ItemId item) { return visited[item] = true, false; });
            asked += triangles.size();
            listed += static_cast<std::size_t>(std::count(visited.begin(), visited.end(), true));
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                const std::optional<Root> root = hit(ray, triangles[i], counts);
                if (!root || root->low > end) continue;
                ++hits;
                ASSERT_TRUE(visited[i]) << "ray " << k << ", triangle " << i;
            }
        }
    }
    EXPECT_GT(hits, 2000u);
    EXPECT_LT(listed, asked / 2);
}

TEST(Crowd, CellsLeaveOutNothingThatIsHit) {
    std::size_t hits = 0, asked = 0, listed = 0;
    for (std::uint64_t scene = 0; scene < 100; ++scene) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", scene " << scene);
        Scales scales(kSeed + 1000 + scene);
        const Point3 point = scales.vector();
        DirectionCells cells(point), of_boxes(point);
        std::vector<Triangle> triangles(100);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            triangles[i] = scales.triangle();
            cells.add(static_cast<ItemId>(i), triangles[i]);
            of_boxes.add(static_cast<ItemId>(i), triangles[i].bounds());
        }
        ASSERT_LE(cells.size(), of_boxes.size());
        StageCounts counts;
        for (int k = 0; k < 60; ++k) {
            const Vector3 d = scales.towards(triangles[scales.below(triangles.size())], point);
            if (!finite(d) || d == Vector3{0, 0, 0}) continue;
            const ExactRay ray(Ray{point, d});
            const auto some = cells.towards(d, [&](ItemId i) { cells.add(i, triangles[i]); });
            const auto by_box =
                of_boxes.towards(d, [&](ItemId i) { of_boxes.add(i, triangles[i].bounds()); });
            asked += triangles.size();
            listed += some.size();
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                if (!hit(ray, triangles[i], counts)) continue;
                ++hits;
                ASSERT_EQ(std::count(some.begin(), some.end(), i), 1) << "ray " << k << ", " << i;
                ASSERT_EQ(std::count(by_box.begin(), by_box.end(), i), 1) << k << ", " << i;
            }
        }
    }
    EXPECT_GT(hits, 1000u);
    EXPECT_LT(listed, asked / 2);
}

// By hand: a unit square's half before the point, in the middle of the upper face.
TEST(Crowd, CellsOfATriangleStraightAbove) {
    DirectionCells cells({0, 0, 0});
    cells.add(7, Triangle{{-0.1, -0.1, 1}, {0.1, -0.1, 1}, {0, 0.1, 1}});
    EXPECT_EQ(cells.size(), 4u);  // those that meet in the middle
    const auto towards = [&](const Vector3& d) {
        return cells.towards(d, [](ItemId) { FAIL() << "one item is few"; });
    };
    EXPECT_EQ(towards({0, 0, 1}).size(), 1u);
    EXPECT_EQ(towards({0, 0, 5e-324}).size(), 1u);
    EXPECT_TRUE(towards({0, 0, -1}).empty());
    EXPECT_TRUE(towards({0.5, 0, 1}).empty());
    EXPECT_TRUE(towards({1, 0, 0}).empty());
}

// A thousand triangles in a narrow view: all in a few cells, until rays have asked for those.
TEST(Crowd, CellsThatAreAskedForAreDivided) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-0.1, 0.1);
    DirectionCells cells({0, 0, 0});
    std::vector<Triangle> triangles;
    for (ItemId i = 0; i < 1000; ++i) {
        const double x = place(random), y = place(random);
        triangles.push_back({{x, y, 1}, {x + 0.002, y, 1}, {x, y + 0.002, 1}});
        cells.add(i, triangles.back());
    }
    std::size_t first = 0, last = 0, hits = 0;
    StageCounts counts;
    for (int k = 0; k < 4000; ++k) {
        const Vector3 d{place(random), place(random), 1};
        const auto some = cells.towards(d, [&](ItemId i) { cells.add(i, triangles[i]); });
        if (k < 10) first += some.size();
        if (k >= 3990) last += some.size();
        for (ItemId i = 0; i < 1000; ++i) {
            if (!hit(ExactRay(Ray{{0, 0, 0}, d}), triangles[i], counts)) continue;
            ++hits;
            ASSERT_EQ(std::count(some.begin(), some.end(), i), 1) << "ray " << k << ", " << i;
        }
    }
    EXPECT_GT(hits, 100u);
    EXPECT_GT(first, 2000u);
    EXPECT_LT(last, 200u);
}

}  // namespace
}  // namespace nuvo
