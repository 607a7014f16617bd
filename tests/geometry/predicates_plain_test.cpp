#include <gtest/gtest.h>

#include <random>

#include "nuvo/geometry/plain_tests.h"
#include "nuvo/geometry/predicates.h"

namespace nuvo {
namespace {

constexpr std::uint64_t kSeed = 20250351;

TEST(PlainTests, AnswerByHand) {
    using V = Vec3<float>;
    const RayT<float> down{{0.25F, 0.5F, 2}, {0, 0, -2}};
    const auto triangle = plain::hit<float>(down, V{0, 0, 0}, V{1, 0, 0}, V{0, 1, 0});
    ASSERT_TRUE(triangle);
    EXPECT_EQ(triangle->t, 1);
    EXPECT_EQ(triangle->uv, (Vec2<float>{0.25F, 0.5F}));
    EXPECT_FALSE(plain::hit<float>(down, V{0, 0, 3}, V{1, 0, 3}, V{0, 1, 3})) << "behind";
    EXPECT_FALSE(plain::hit<float>(down, V{0.25F, 0, 0}, V{0.25F, 1, 0}, V{0.25F, 0, 1}));
    const RayT<double> along{{-3, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(plain::hit<double>(along, {0, 0, 0}, 1.0)->t, 2);
    EXPECT_EQ(plain::hit<double>({{0, 0, 0}, {1, 0, 0}}, {0, 0, 0}, 1.0)->t, 1);
    EXPECT_FALSE(plain::hit<double>({{2, 0, 0}, {1, 0, 0}}, {0, 0, 0}, 1.0));
    const Ellipsoid e{{1, 0, 0}, {{{4, 0, 0}, {0, 2, 0}, {0, 0, 0.25}}}, 0.5};
    EXPECT_EQ(plain::hit(along, plain::LocalEllipsoid<double>(e))->t, 2);
    EXPECT_TRUE(plain::blocks(along, 2.5, Point3{0, 0, 0}, 1.0));
    EXPECT_FALSE(plain::blocks(along, 2.0, Point3{0, 0, 0}, 1.0));
    EXPECT_TRUE(plain::blocks<float>(down, 1.5F, V{0, 0, 0}, V{1, 0, 0}, V{0, 1, 0}));
}

TEST(PlainTests, AgreeWithTheExactOnesAwayFromEdges) {
    std::mt19937_64 engine(kSeed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto point = [&] { return Point3{uniform(engine), uniform(engine), uniform(engine)}; };
    StageCounts counts;
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", case " << i);
        const Triangle t{point(), point(), point()};
        const Ray ray{point() * 3, point()};
        const std::optional<Root> exact = hit(ExactRay(ray, t.bounds()), t, counts);
        const auto plain = plain::hit<double>(ray, t.a, t.b, t.c);
        ASSERT_EQ(plain.has_value(), exact.has_value());
        if (!exact) continue;
        ++hits;
        EXPECT_NEAR(plain->t, exact->t, 1e-6 * exact->t);
        const SurfacePoint p = surface_point(ExactRay(ray), t);
        EXPECT_NEAR(plain->uv.x, p.uv.x, 1e-6);
        EXPECT_NEAR(plain->uv.y, p.uv.y, 1e-6);
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(counts.wider, 2000U) << "the cheap stage decides nearly all";
}

TEST(ClosedMesh, LeaksNoRayAtVerticesAndEdges) {
    // An icosahedron's faces over corners in general position, seen from inside.
    constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double g = (1 + std::sqrt(5.0)) / 2;
    const Point3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::mt19937_64 engine(kSeed + 1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    StageCounts counts;
    for (int mesh = 0; mesh < 100; ++mesh) {
        Point3 moved[12];
        Bounds3 box;
        for (int i = 0; i < 12; ++i) {
            moved[i] = corners[i] * (1 + 0.25 * uniform(engine));
            box = box.extended(moved[i]);
        }
        for (int i = 0; i < 1000; ++i) {
            const Point3 eye{0.2 * uniform(engine), 0.2 * uniform(engine), 0.2 * uniform(engine)};
            const int* face = kFaces[engine() % 20];
            const Point3& a = moved[face[0]];
            const Point3& b = moved[face[1]];
            const Point3 aim = i % 2 != 0 ? a : a + (b - a) * std::fabs(uniform(engine));
            const ExactRay ray = i % 4 < 2 ? ExactRay::between(eye, aim, box)
                                           : ExactRay(Ray{eye, normalized(aim - eye)}, box);
            int hits = 0;
            for (const auto& f : kFaces)
                hits +=
                    hit(ray, Triangle{moved[f[0]], moved[f[1]], moved[f[2]]}, counts).has_value();
            ASSERT_GE(hits, 1) << "seed " << kSeed + 1 << ", mesh " << mesh << ", ray " << i;
            if (i % 4 == 1) {
                ASSERT_EQ(hits, 5) << "exactly through a vertex";
            }
        }
    }
    EXPECT_GT(counts.exact, 10000U);
}

}  // namespace
}  // namespace nuvo
