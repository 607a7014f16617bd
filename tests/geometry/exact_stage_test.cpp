#include <gtest/gtest.h>

#include "geometry/predicates_oracle.h"
#include "predicates_exact.h"

// The last stage against the definitions, for all small integers: ties, tangency and zeros that
// the stages before it never hand on.
namespace nuvo {
namespace {

using detail::ExactQuadratic;
using detail::OriginPlace;

constexpr double kEndless = std::numeric_limits<double>::infinity();

ExactQuadratic quadratic(int a, int b, int c) {
    ExactQuadratic q{};
    q.a = Exact(a);
    q.b = Exact(b);
    q.c = Exact(c);
    q.empty = false;
    return q;
}

/// Roots of a t^2 + 2 b t + c in order; none where they are not real.
std::vector<double> roots(int a, int b, int c) {
    const int d = b * b - a * c;
    if (a == 0 || d < 0) return {};
    const double root = std::sqrt(d);
    return {(-b - root) / a, (-b + root) / a};
}

template <typename Visit>
void for_each_quadratic(Visit&& visit) {
    for (int a = 0; a <= 4; ++a)
        for (int b = -5; b <= 5; ++b)
            for (int c = -5; c <= 5; ++c) {
                SCOPED_TRACE(::testing::Message() << a << " t^2 + 2 " << b << " t + " << c);
                visit(a, b, c);
            }
}

TEST(ExactStage, SeesTheLeastRootAhead) {
    for_each_quadratic([](int a, int b, int c) {
        const std::vector<double> r = roots(a, b, c);
        const bool near = !r.empty() && r[0] > 0;
        const bool far = !r.empty() && r[1] > 0;
        for (const Sides sides : {Sides::kBoth, Sides::kFront}) {
            const std::optional<SphereHit> hit = detail::exact_hit(quadratic(a, b, c), sides);
            ASSERT_EQ(hit.has_value(), near || (far && sides == Sides::kBoth));
            if (!hit) continue;
            EXPECT_EQ(hit->which, near ? SphereRoot::kNear : SphereRoot::kFar);
            const double t = near ? r[0] : r[1];
            EXPECT_NEAR(hit->root.t, t, 1e-14 * t);
            EXPECT_LT(hit->root.low, hit->root.t);
            EXPECT_GT(hit->root.high, hit->root.t);
        }
        ExactQuadratic none = quadratic(a, b, c);
        none.empty = true;
        EXPECT_FALSE(detail::exact_hit(none, Sides::kBoth));
        EXPECT_FALSE(detail::exact_blocks(none, 1, OriginPlace::kClear, Sides::kBoth));
    });
}

// Ends at k / 8 are never within a rounding of an irrational root; rational ones are exact.
TEST(ExactStage, BlocksByRootsBetweenBothEnds) {
    for_each_quadratic([](int a, int b, int c) {
        const std::vector<double> r = roots(a, b, c);
        for (const double end :
             {0.125, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 8.0, 10.0, kEndless}) {
            SCOPED_TRACE(::testing::Message() << "end " << end);
            const auto within = [&](int i) { return !r.empty() && r[i] > 0 && r[i] < end; };
            const auto found = [&](OriginPlace place, Sides sides) {
                return detail::exact_blocks(quadratic(a, b, c), end, place, sides);
            };
            if (c != 0) {  // an origin on the surface touches it
                EXPECT_EQ(found(OriginPlace::kClear, Sides::kBoth), within(0) || within(1));
                EXPECT_EQ(found(OriginPlace::kClear, Sides::kFront), within(1));
            }
            // What touches blocks where the way leads inwards and comes out before the end.
            const bool inwards = a > 0 && b < 0;
            for (const Sides sides : {Sides::kBoth, Sides::kFront}) {
                EXPECT_EQ(found(OriginPlace::kTouching, sides), inwards && within(1));
                // On it c stands for 0, but for the end's side.
                const bool outside = std::isinf(end) || end * (end * a + 2 * b) + c > 0;
                EXPECT_EQ(found(OriginPlace::kOnIt, sides), inwards && outside);
            }
        }
    });
}

/// The sign of p + s sqrt(x) + r sqrt(y) is that of an order of roots; here of all small spheres on
/// a line, whose roots are (integer +- sqrt(integer)) / integer.
TEST(ExactStage, OrdersRootsOfSmallSpheresAndPlanes) {
    struct Item {
        std::variant<Sphere, Triangle, Ellipsoid> shape;
        SphereRoot which;
        oracle::Real t;
    };
    const ExactRay ray(Ray{{0, 0, 0}, {1, 1, 0}});
    std::vector<Item> items;
    for (const double x : {1.0, 2.0, 3.0})
        for (const double y : {0.0, 1.0, 2.0})
            for (const double radius : {1.0, 1.5, 2.0}) {
                const Sphere sphere{{x, y, 0.5}, radius};
                const std::optional<oracle::Roots> r =
                    oracle::roots(oracle::ball(oracle::line(ray), sphere));
                if (!r) continue;
                items.push_back({sphere, SphereRoot::kNear, r->near});
                items.push_back({sphere, SphereRoot::kFar, r->far});
                // The same ball, its polynomial larger and mirrored.
                const Ellipsoid same{
                    sphere.center, {{{0, -2, 0}, {2, 0, 0}, {0, 0, -2}}}, radius / 2};
                items.push_back({same, SphereRoot::kNear, r->near});
                items.push_back({same, SphereRoot::kFar, r->far});
            }
    for (const double x : {0.5, 1.0, 1.5, 2.0}) {
        items.push_back({Triangle{{x, 0, 0}, {x, 1, 0}, {x, 0, 1}}, {}, oracle::Real(x)});
        items.push_back({Triangle{{x, 0, 0}, {x, 0, 1}, {x, 1, 0}}, {}, oracle::Real(x)});
    }
    StageCounts counts;
    int equal = 0;
    for (const Item& a : items)
        for (const Item& b : items) {
            const auto primitive = [](const Item& item) {
                return std::visit(
                    [&](const auto& s) {
                        return HitPrimitive{&s, item.which};
                    },
                    item.shape);
            };
            const int truth = oracle::order(a.t, b.t);
            equal += truth == 0;
            ASSERT_EQ(compare_roots(ray, primitive(a), primitive(b), counts), truth)
                << static_cast<double>(a.t) << " and " << static_cast<double>(b.t);
        }
    EXPECT_EQ(counts.wider, items.size() * items.size());
    EXPECT_GT(equal, 2 * static_cast<int>(items.size()));
}

}  // namespace
}  // namespace nuvo
