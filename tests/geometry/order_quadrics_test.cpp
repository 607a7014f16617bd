// Which of two nearly coincident spheres or ellipsoids a ray meets first, in doubles: never against
// roots to 200 digits, and nearly always at all.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/predicates_oracle.h"
#include "predicates_quadratic.h"

namespace nuvo {
namespace {

class RandomQuadrics {
  public:
    explicit RandomQuadrics(unsigned seed) : random_(seed) {}

    Vector3 vector(double size) { return {number(size), number(size), number(size)}; }
    double number(double size) {
        return std::uniform_real_distribution<double>(-size, size)(random_);
    }
    int integer(int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random_);
    }

    Ellipsoid ellipsoid(double scale) {
        Ellipsoid e{vector(scale), {}, std::fabs(number(scale)) + scale / 8};
        for (Vector3& row : e.linear.row) row = row + vector(0.5);
        return e;
    }
    // Moved, turned and blown up by about 2^-bits of its size.
    Ellipsoid beside(const Ellipsoid& e, int bits) {
        const double change = std::ldexp(1.0, -bits);
        Ellipsoid out = e;
        out.center = out.center + vector(change * e.radius);
        out.radius *= 1 + number(change);
        for (Vector3& row : out.linear.row) row = row + vector(change);
        return out;
    }
    Sphere beside(const Sphere& s, int bits) {
        const double change = std::ldexp(1.0, -bits);
        return {s.center + vector(change * s.radius), s.radius * (1 + number(change))};
    }

  private:
    std::mt19937_64 random_;
};

struct Tally {
    int asked = 0;
    int sure = 0;
};

// Both roots of a against both of b.
template <typename Quadric>
void expect_right(const Ray& ray, const Quadric& a, const Quadric& b, Tally& tally) {
    const ExactRay exact(ray);
    const auto ball_of = [&](const Quadric& q) -> std::optional<oracle::Ball> {
        return oracle::ball(oracle::line(exact), q);
    };
    const auto ball_a = ball_of(a);
    const auto ball_b = ball_of(b);
    if (!ball_a || !ball_b) return;
    const auto roots_a = oracle::roots(*ball_a);
    const auto roots_b = oracle::roots(*ball_b);
    if (!roots_a || !roots_b) return;
    for (const SphereRoot at_a : {SphereRoot::kNear, SphereRoot::kFar})
        for (const SphereRoot at_b : {SphereRoot::kNear, SphereRoot::kFar}) {
            ++tally.asked;
            const auto found = detail::sure_order(exact, {&a, at_a}, {&b, at_b});
            if (!found) continue;
            ++tally.sure;
            const int expected =
                oracle::order(at_a == SphereRoot::kNear ? roots_a->near : roots_a->far,
                              at_b == SphereRoot::kNear ? roots_b->near : roots_b->far);
            EXPECT_EQ(*found, expected);
        }
}

TEST(OrderOfQuadrics, IsTheOneOfTheRootsToManyDigits) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomQuadrics random(seed);
    Tally spheres;
    Tally ellipsoids;
    for (int i = 0; i < 400; ++i) {
        const double scale = std::ldexp(1.0, random.integer(-200, 200));
        const int bits = random.integer(2, 56);
        const Ray ray{random.vector(4 * scale), random.vector(1)};
        const Ellipsoid e = random.ellipsoid(scale);
        const Sphere s{e.center, e.radius};
        const Ray towards{ray.origin, s.center + random.vector(e.radius / 2) - ray.origin};
        expect_right(towards, s, random.beside(s, bits), spheres);
        expect_right(towards, e, random.beside(e, bits), ellipsoids);
    }
    // As far as changes of 2^-53 leave anything to be told apart.
    EXPECT_GT(spheres.sure, spheres.asked * 9 / 10);
    EXPECT_GT(ellipsoids.sure, ellipsoids.asked * 7 / 10);
}

// Grazing, or from within, or where one is far from the other.
TEST(OrderOfQuadrics, IsRightWhereItIsSureAtAll) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomQuadrics random(seed);
    Tally tally;
    for (int i = 0; i < 300; ++i) {
        const Ellipsoid e = random.ellipsoid(1);
        const Sphere s{e.center, e.radius};
        const double number = std::fabs(random.number(1));
        const double off = 1 - std::ldexp(number, -random.integer(0, 50));
        Vector3 across = normalized(random.vector(1));
        const Vector3 d = normalized(cross(across, random.vector(1)));
        const Ray grazing{s.center + across * (off * s.radius) - d * random.number(4), d};
        expect_right(grazing, s, random.beside(s, random.integer(0, 56)), tally);
        expect_right(grazing, e, random.beside(e, random.integer(0, 56)), tally);
        expect_right(grazing, s, Sphere{random.vector(2), 1}, tally);
    }
    EXPECT_GT(tally.sure, 100);
}

// The nearer of two spheres whose centres differ by one unit in the last place.
TEST(OrderOfQuadrics, SeesOneUnitInTheLastPlace) {
    const Sphere a{{0, 0, 1}, 1};
    const Sphere b{{0, 0, std::nextafter(1.0, 2.0)}, 1};
    const ExactRay ray(Ray{{0.25, 0.125, 5}, {0, 0, -1}});
    const auto order = [&](const Sphere& x, const Sphere& y) {
        return detail::sure_order(ray, {&x, SphereRoot::kNear}, {&y, SphereRoot::kNear});
    };
    EXPECT_EQ(order(a, b), 1);
    EXPECT_EQ(order(b, a), -1);
    EXPECT_EQ(order(a, a), std::nullopt) << "equal is left to exact arithmetic";
}

}  // namespace
}  // namespace nuvo
