#include <gtest/gtest.h>

#include "geometry/predicates_cases.h"
#include "geometry/predicates_oracle.h"

namespace nuvo {
namespace {

using cases::Random;

constexpr std::uint64_t kSeed = 20250321;

class HitOrder : public ::testing::TestWithParam<cases::Placement> {};

/// A primitive with its true root.
struct Candidate {
    std::variant<Triangle, Sphere, Ellipsoid> shape;
    SphereRoot which = SphereRoot::kNear;
    oracle::Real t;

    HitPrimitive primitive() const {
        return std::visit([this](const auto& s) { return HitPrimitive{&s, which}; }, shape);
    }
};

/// What `ray` meets of `shape`, wherever on the line: both roots of a sphere.
void add_candidates(const ExactRay& ray, const std::variant<Triangle, Sphere, Ellipsoid>& shape,
                    std::vector<Candidate>& candidates) {
    const oracle::ExactLine line = oracle::line(ray);
    if (const Triangle* triangle = std::get_if<Triangle>(&shape)) {
        const std::optional<oracle::PlaneHit> hit = oracle::plane_hit(line, *triangle);
        if (hit) candidates.push_back({shape, {}, oracle::real(hit->t)});
        return;
    }
    const std::optional<oracle::Ball> ball =
        std::holds_alternative<Sphere>(shape)
            ? std::optional(oracle::ball(line, std::get<Sphere>(shape)))
            : oracle::ball(line, std::get<Ellipsoid>(shape));
    const std::optional<oracle::Roots> roots = ball ? oracle::roots(*ball) : std::nullopt;
    if (!roots) return;
    candidates.push_back({shape, SphereRoot::kNear, roots->near});
    candidates.push_back({shape, SphereRoot::kFar, roots->far});
}

TEST_P(HitOrder, IsThatOfTheRoots) {
    Random random(kSeed, GetParam());
    StageCounts counts;
    int equal = 0;
    int compared = 0;
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE(::testing::Message()
                     << GetParam().name << ", seed " << kSeed << ", case " << i);
        const auto [ray, sphere] = cases::sphere_case(random, i % cases::kSphereKinds);
        std::vector<Candidate> candidates;
        add_candidates(ray, sphere, candidates);
        add_candidates(ray, sphere, candidates);  // coincident
        Sphere close = sphere;
        close.center.x += close.radius * 0x1p-44;
        add_candidates(ray, close, candidates);
        // The same ball as an ellipsoid: equal roots of different polynomials.
        Ellipsoid same{sphere.center, {}, sphere.radius};
        if (random.below(2) != 0) {
            same.linear = Matrix3{{{0, 4, 0}, {-4, 0, 0}, {0, 0, 4}}};
            same.radius = sphere.radius / 4;
        }
        add_candidates(ray, same, candidates);
        // Triangles: about the point of the near root, and, where it is exact, through it.
        const Point3 p = ray.origin() + ray.direction();
        const double size = sphere.radius;
        for (int k = 0; k < 2; ++k)
            add_candidates(ray, Triangle{p, p + random.vector() * size, p + random.vector() * size},
                           candidates);
        for (const Candidate& a : candidates)
            for (const Candidate& b : candidates) {
                const int truth = oracle::order(a.t, b.t);
                ASSERT_EQ(compare_roots(ray, a.primitive(), b.primitive(), counts), truth);
                equal += truth == 0 && &a != &b;
                ++compared;
            }
    }
    EXPECT_GT(compared, 10000);
    EXPECT_GT(equal, 500);
}

INSTANTIATE_TEST_SUITE_P(Placements, HitOrder, ::testing::ValuesIn(cases::kPlacements));

TEST(HitOrderByHand, EqualRootsOfDifferentPrimitives) {
    const ExactRay ray(Ray{{0, 0, 0}, {1, 0, 0}});
    const Triangle at_two{{2, -1, -1}, {2, 1, -1}, {2, 0, 3}};
    const Triangle turned{{2, 1, -1}, {2, -1, -1}, {2, 0, 5}};
    const Triangle leaning{{2, 0, 0}, {3, 1, 0}, {3, 0, 1}};
    const Sphere near_two{{5, 0, 0}, 3};
    const Sphere far_two{{0, 0, 0}, 2};
    const Sphere tangent{{2, 0, 1}, 1};
    const Ellipsoid ellipsoid{{4, 0, 0}, {{{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 1};
    const HitPrimitive all[] = {{&at_two},
                                {&turned},
                                {&leaning},
                                {&near_two},
                                {&far_two, SphereRoot::kFar},
                                {&tangent},
                                {&tangent, SphereRoot::kFar},
                                {&ellipsoid}};
    StageCounts counts;
    for (const HitPrimitive& a : all)
        for (const HitPrimitive& b : all) EXPECT_EQ(compare_roots(ray, a, b, counts), 0);
    const Sphere later{{5, 0, 0}, std::nextafter(3, 0)};
    EXPECT_EQ(compare_roots(ray, all[0], {&later}, counts), -1);
    EXPECT_EQ(compare_roots(ray, {&later}, all[3], counts), 1);
    EXPECT_EQ(compare_roots(ray, {&later, SphereRoot::kFar}, {&near_two, SphereRoot::kFar}, counts),
              -1);
}

// All corners of one on one side of the other, by less than 64 bits of t can tell.
TEST(HitOrderByHand, ParallelPlanesThatDifferBelowLongDouble) {
    const ExactRay ray(Ray{{0, 0, -1}, {0, 0, 1}});
    constexpr double kNear = 0x1p-50;
    constexpr double kFar = kNear + 0x1p-102;
    const Triangle near{{-1, -1, kNear}, {1, -1, kNear}, {0, 1, kNear}};
    const Triangle far{{-1, -1, kFar}, {1, -1, kFar}, {0, 1, kFar}};
    const Triangle turned{near.a, near.c, near.b};
    const Triangle far_turned{far.a, far.c, far.b};
    StageCounts counts;
    for (const Triangle* first : {&near, &turned})
        for (const Triangle* second : {&far, &far_turned}) {
            EXPECT_EQ(compare_roots(ray, {first}, {second}, counts), -1);
            EXPECT_EQ(compare_roots(ray, {second}, {first}, counts), 1);
        }
    EXPECT_EQ(compare_roots(ray, {&near}, {&turned}, counts), 0);
    EXPECT_EQ(counts.exact, 8U) << "two in one plane need no exact root";
}

TEST(HitOrderByHand, SurdsThatDifferInTheLastDigits) {
    // Near roots 10 - sqrt(2 + e) of balls whose squares differ by one roundoff of a tiny offset.
    const ExactRay ray(Ray{{0, 0, 0}, {1, 0, 0}});
    const Sphere one{{10, 1, 1}, 2};
    const Sphere other{{10, 1, 1 + 0x1p-52}, 2};
    StageCounts counts;
    EXPECT_EQ(compare_roots(ray, {&one}, {&other}, counts), -1);
    EXPECT_EQ(compare_roots(ray, {&one, SphereRoot::kFar}, {&other, SphereRoot::kFar}, counts), 1);
}

}  // namespace
}  // namespace nuvo
