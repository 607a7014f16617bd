#include <gtest/gtest.h>

#include "geometry/predicates_cases.h"
#include "geometry/predicates_oracle.h"

namespace nuvo {
namespace {

using cases::Random;

constexpr std::uint64_t kSeed = 20250301;

/// |found - truth| <= bound, all exact.
::testing::AssertionResult within(double found, const oracle::Real& truth, double bound) {
    const oracle::Real error = abs(oracle::Real(oracle::Real(found) - truth));
    if (error <= oracle::Real(bound)) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << found << " is off by " << static_cast<double>(error) << ", more than " << bound;
}

class TrianglePredicate : public ::testing::TestWithParam<cases::Placement> {};

TEST_P(TrianglePredicate, AnswersWhatRationalsAnswer) {
    constexpr int kCases = 3000;
    Random random(kSeed, GetParam());
    StageCounts counts;
    int hits = 0;
    int on_edges = 0;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kTriangleKinds;
        const auto [ray, triangle] = cases::triangle_case(random, kind);
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed << ", case " << i
                                          << ", kind " << kind);
        const std::optional<oracle::PlaneHit> truth =
            oracle::plane_hit(oracle::line(ray), triangle);
        const bool expected = truth && truth->inside() && truth->t > 0;
        const std::optional<Root> found = hit(ray, triangle, counts);
        ASSERT_EQ(found.has_value(), expected);
        if (!expected) continue;
        ++hits;
        on_edges += truth->u == 0 || truth->v == 0 || truth->u + truth->v == 1;
        const oracle::Real t = oracle::real(truth->t);
        if (t > oracle::Real(1e-290) && t < oracle::Real(1e290)) {
            ASSERT_TRUE(within(found->t, t, 1e-13 * found->t));
        }
        ASSERT_LE(oracle::Real(found->low), t);
        ASSERT_GE(oracle::Real(found->high), t);
    }
    EXPECT_GT(hits, kCases / 5);
    if (GetParam().float_exact && GetParam().offset == 0) {
        EXPECT_GT(on_edges, kCases / 25);
    }
    RecordProperty("exact", static_cast<int>(counts.exact));
}

// The planes through edges and the eye, or a light, or along a direction are kept from the second
// time on.
TEST_P(TrianglePredicate, AnswersTheSameToRaysThatShareAPoint) {
    constexpr int kCases = 500;
    Random random(kSeed + 2, GetParam());
    StageCounts counts;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kTriangleKinds;
        const auto [ray, triangle] = cases::triangle_case(random, kind);
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed + 2 << ", case "
                                          << i << ", kind " << kind);
        const Point3 end = ray.origin() + ray.direction();
        Point3 beside = end;
        beside.x = std::nextafter(beside.x, 2 * max_norm(end) + 1);
        const ExactRay rays[] = {ray,
                                 ray,
                                 ExactRay(Ray{ray.origin(), ray.direction()}),
                                 ExactRay(Ray{ray.origin(), beside - ray.origin()}),
                                 ExactRay(Ray{ray.origin() + (beside - end), ray.direction()}),
                                 ExactRay::between(ray.origin(), end),
                                 ExactRay::between(beside, end),
                                 ExactRay::between(ray.origin() + ray.direction() * 0.25, end)};
        for (const ExactRay& asked : rays) {
            if (asked.direction() == Vector3{0, 0, 0}) continue;
            const std::optional<oracle::PlaneHit> truth =
                oracle::plane_hit(oracle::line(asked), triangle);
            const bool meets = truth && truth->inside() && truth->t > 0;
            ASSERT_EQ(hit(asked, triangle, counts).has_value(), meets);
            ASSERT_EQ(blocks(asked, 1, 0, triangle, counts), meets && truth->t < 1);
        }
    }
}

TEST_P(TrianglePredicate, SurfacePointKeepsItsBound) {
    constexpr int kCases = 3000;
    Random random(kSeed + 1, GetParam());
    StageCounts counts;
    for (int i = 0; i < kCases; ++i) {
        const auto [ray, triangle] = cases::triangle_case(random, i % cases::kTriangleKinds);
        if (!hit(ray, triangle, counts)) continue;
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed + 1 << ", case "
                                          << i << ", kind " << i % cases::kTriangleKinds);
        const oracle::ExactLine line = oracle::line(ray);
        const oracle::PlaneHit truth = *oracle::plane_hit(line, triangle);
        const oracle::RationalVector p = line.o + line.d * truth.t;
        const SurfacePoint found = surface_point(ray, triangle);
        const double corners =
            std::fmax(max_norm(triangle.a), std::fmax(max_norm(triangle.b), max_norm(triangle.c)));
        ASSERT_LE(found.error, 1.01 * surface_tolerance() * corners + 2 * kUnderflow);
        ASSERT_TRUE(within(found.point.x, oracle::real(p.x), found.error));
        ASSERT_TRUE(within(found.point.y, oracle::real(p.y), found.error));
        ASSERT_TRUE(within(found.point.z, oracle::real(p.z), found.error));
        ASSERT_TRUE(found.uv.x >= 0 && found.uv.x <= 1 && found.uv.y >= 0 && found.uv.y <= 1);
        const oracle::RationalVector a = oracle::rational(triangle.a);
        const oracle::RealVector n =
            oracle::real(cross(oracle::rational(triangle.b) - a, oracle::rational(triangle.c) - a));
        const oracle::Real size = sqrt(dot(n, n));
        ASSERT_TRUE(within(found.normal.x, n.x / size, 1e-6));
        ASSERT_TRUE(within(found.normal.y, n.y / size, 1e-6));
        ASSERT_TRUE(within(found.normal.z, n.z / size, 1e-6));
    }
}

INSTANTIATE_TEST_SUITE_P(Placements, TrianglePredicate, ::testing::ValuesIn(cases::kPlacements));

TEST(TrianglePredicateByHand, VertexEdgeAndPlane) {
    const Triangle t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    StageCounts counts;
    const auto down = [&](double x, double y) {
        return hit(ExactRay(Ray{{x, y, 2}, {0, 0, -1}}), t, counts);
    };
    ASSERT_TRUE(down(0, 0));
    EXPECT_EQ(down(0, 0)->t, 2);
    EXPECT_TRUE(down(0.5, 0.5));
    EXPECT_FALSE(down(std::nextafter(0.5, 1), 0.5));
    EXPECT_FALSE(down(-kUnderflow, 0));
    EXPECT_FALSE(hit(ExactRay(Ray{{-1, 0.25, 0}, {1, 0, 0}}), t, counts)) << "in the plane";
    EXPECT_FALSE(hit(ExactRay(Ray{{0.25, 0.25, 0}, {0, 0, 1}}), t, counts)) << "t = 0";
    EXPECT_FALSE(hit(ExactRay(Ray{{0.25, 0.25, -1}, {0, 0, 0}}), t, counts)) << "no direction";
}

}  // namespace
}  // namespace nuvo
