#include <gtest/gtest.h>

#include "geometry/predicates_cases.h"
#include "geometry/predicates_oracle.h"

namespace nuvo {
namespace {

using cases::Random;

constexpr std::uint64_t kSeed = 20250311;
constexpr int kCases = 2400;

class SpherePredicate : public ::testing::TestWithParam<cases::Placement> {};
class EllipsoidPredicate : public ::testing::TestWithParam<cases::Placement> {};

struct Tally {
    int hits = 0;
    int near = 0;
    int tangent = 0;
};

void expect_component(double found, const oracle::Real& truth, double bound) {
    const oracle::Real error = abs(oracle::Real(oracle::Real(found) - truth));
    EXPECT_LE(error, oracle::Real(bound)) << found << " off by " << static_cast<double>(error);
}

/// One ray against one surface: hit or miss, which root, t, and the surface point.
template <typename Primitive>
void expect_the_truth(const ExactRay& ray, const Primitive& primitive, double reach,
                      StageCounts& counts, Tally& tally) {
    const oracle::ExactLine line = oracle::line(ray);
    const std::optional<oracle::Ball> ball = oracle::ball(line, primitive);
    const std::optional<oracle::BallHit> truth = oracle::first_hit(ball);
    const std::optional<SphereHit> found = hit(ray, primitive, counts);
    ASSERT_EQ(found.has_value(), truth.has_value());
    if (!found) return;
    ++tally.hits;
    const oracle::Roots both = *oracle::roots(*ball);
    const bool tangent = both.discriminant == 0;
    tally.tangent += tangent;
    tally.near += found->which == SphereRoot::kNear;
    if (!tangent) {
        ASSERT_EQ(found->which, truth->which);
    }
    ASSERT_LE(oracle::Real(found->root.low), truth->t);
    ASSERT_GE(oracle::Real(found->root.high), truth->t);
    if (truth->t > oracle::Real(1e-290) && truth->t < oracle::Real(1e290)) {
        expect_component(found->root.t, truth->t, 1e-13 * found->root.t);
    }
    const SurfacePoint surface = surface_point(ray, primitive, found->which);
    const oracle::RealVector p = oracle::real(line.o) + oracle::real(line.d) * truth->t;
    expect_component(surface.point.x, p.x, surface.error);
    expect_component(surface.point.y, p.y, surface.error);
    expect_component(surface.point.z, p.z, surface.error);
    const double size = max_norm(primitive.center) + reach;
    EXPECT_LE(surface.error, 1.01 * surface_tolerance() * size + 2 * kUnderflow);
    EXPECT_NEAR(length(surface.normal), 1, 1e-15);
}

TEST_P(SpherePredicate, AnswersWhatRationalsAnswer) {
    Random random(kSeed, GetParam());
    StageCounts counts;
    Tally tally;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kSphereKinds;
        const auto [ray, sphere] = cases::sphere_case(random, kind);
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed << ", case " << i
                                          << ", kind " << kind);
        expect_the_truth(ray, sphere, sphere.radius, counts, tally);
        if (HasFailure()) return;
    }
    EXPECT_GT(tally.hits, kCases / 4);
    EXPECT_GT(tally.near, kCases / 10);
    if (GetParam().float_exact && GetParam().offset == 0 && GetParam().scale > 0x1p-1000) {
        EXPECT_GT(tally.tangent, kCases / 40);
    }
}

TEST_P(EllipsoidPredicate, AnswersWhatRationalsAnswer) {
    Random random(kSeed + 1, GetParam());
    StageCounts counts;
    Tally tally;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kSphereKinds;
        const auto [ray, ellipsoid] = cases::ellipsoid_case(random, kind);
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed + 1 << ", case "
                                          << i << ", kind " << kind);
        double reach = 0;
        for (const Vector3& row : ellipsoid.linear.row)
            reach = std::fmax(reach, std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z));
        expect_the_truth(ray, ellipsoid, reach * ellipsoid.radius, counts, tally);
        if (HasFailure()) return;
    }
    EXPECT_GT(tally.hits, kCases / 4);
    EXPECT_GT(tally.near, kCases / 10);
}

INSTANTIATE_TEST_SUITE_P(Placements, SpherePredicate, ::testing::ValuesIn(cases::kPlacements));
INSTANTIATE_TEST_SUITE_P(Placements, EllipsoidPredicate, ::testing::ValuesIn(cases::kPlacements));

TEST(SpherePredicateByHand, TangencyInsideAndBehind) {
    const Sphere unit{{0, 0, 0}, 1};
    StageCounts counts;
    const auto along_x = [&](double x, double y) {
        return hit(ExactRay(Ray{{x, y, 0}, {2, 0, 0}}), unit, counts);
    };
    ASSERT_TRUE(along_x(-3, 0));
    EXPECT_EQ(along_x(-3, 0)->root.t, 1);
    EXPECT_EQ(along_x(-3, 0)->which, SphereRoot::kNear);
    EXPECT_EQ(along_x(0, 0)->root.t, 0.5);
    EXPECT_EQ(along_x(0, 0)->which, SphereRoot::kFar);
    EXPECT_EQ(along_x(-1, 0)->root.t, 1) << "from the surface to the other side";
    EXPECT_FALSE(along_x(1, 0)) << "from the surface outwards";
    EXPECT_FALSE(along_x(2, 0));
    EXPECT_EQ(along_x(-2, 1)->root.t, 1) << "tangency is a hit";
    EXPECT_FALSE(along_x(0, 1)) << "tangent at t = 0";
    EXPECT_FALSE(along_x(-2, std::nextafter(1, 2)));
    EXPECT_FALSE(hit(ExactRay(Ray{{-2, 0, 0}, {1, 0, 0}}), Sphere{{0, 0, 0}, 0}, counts));
}

TEST(EllipsoidPredicateByHand, MirroredAndFlat) {
    StageCounts counts;
    const Ellipsoid e{{1, 0, 0}, {{{-4, 0, 0}, {0, 2, 0}, {0, 0, 0.25}}}, 0.5};  // axes 2, 1, 1/8
    const ExactRay ray(Ray{{-3, 0, 0}, {1, 0, 0}});
    ASSERT_TRUE(hit(ray, e, counts));
    EXPECT_EQ(hit(ray, e, counts)->root.t, 2);
    const SurfacePoint p = surface_point(ray, e, SphereRoot::kNear);
    EXPECT_EQ(p.point, Point3(-1, 0, 0));
    EXPECT_EQ(p.normal, Vector3(-1, 0, 0));
    const Ellipsoid flat{{0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, 1};
    EXPECT_FALSE(hit(ray, flat, counts)) << "no volume";
}

}  // namespace
}  // namespace nuvo
