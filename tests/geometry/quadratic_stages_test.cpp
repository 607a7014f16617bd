#include <gtest/gtest.h>

#include "geometry/predicates_oracle.h"
#include "geometry/worst_case.h"
#include "predicates_quadratic.h"

// The stages of spheres and ellipsoids in double and long double against rationals: thin, sheared
// and huge surfaces, seen from near and far, grazed, and from within.
namespace nuvo {
namespace {

using oracle::Rational;
using oracle::Real;
using oracle::RealVector;
using worst_case::Draw;

constexpr unsigned kSeed = 20261130;

ExactRay ray_through(Draw& draw, const Point3& from, const Point3& to) {
    return draw.below(2) != 0 ? ExactRay(Ray{from, to - from}) : ExactRay::between(from, to);
}

struct Case {
    ExactRay ray;
    Ellipsoid ellipsoid;
};
/// An ellipsoid of that aspect (needle, disc or between), turned, stretched again after that in a
/// third of the cases, and a ray at it: at its middle, or past its rim so that it just meets it.
Case thin_case(Draw& draw, double aspect) {
    const double thin = 1 / aspect;
    Matrix3 m{{{thin, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (draw.below(2) != 0) m.row[1][1] = draw.below(2) != 0 ? thin : std::sqrt(thin);
    m = rotation(draw.vector(), draw.uniform(0, 6)) * m;
    if (draw.below(3) == 0) {  // sheared
        const Matrix3 stretch{{{1, 0, 0}, {draw.uniform(-1, 1), 0.5, 0}, {0, 0, 2}}};
        m = stretch * m;
    }
    const Ellipsoid ellipsoid{draw.below(2) != 0 ? Point3{} : draw.vector() * 8, m,
                              draw.uniform(0.1, 2)};
    // In the unit sphere's space: a point of the surface or within, from where the ray comes.
    const Vector3 at = normalized(draw.vector());
    Vector3 target = at * draw.uniform(0, 1);
    if (draw.below(3) == 0) target = at * (1 - draw.size(-20, -2));  // grazing, from some sides
    const Point3 to = ellipsoid.center + m * (target * ellipsoid.radius);
    const Point3 from = draw.below(4) == 0
                            ? ellipsoid.center + m * (draw.vector() * 4)
                            : to + draw.vector() * draw.size(-2, draw.below(2) != 0 ? 4 : 20);
    return {ray_through(draw, from, to), ellipsoid};
}

struct Tally {
    int hits = 0;
    double exact = 0;  ///< share of hits that exact arithmetic found
    double worst_normal = 0;
};
double difference(const Vector3& n, const RealVector& truth) {
    const Real size = sqrt(dot(truth, truth));
    return static_cast<double>(abs(Real(truth.x / size - n.x)) + abs(Real(truth.y / size - n.y)) +
                               abs(Real(truth.z / size - n.z)));
}
/// adj(M)^T adj(M) (p - c), to 200 digits.
RealVector normal_at(const Ellipsoid& e, const RealVector& p) {
    const RealVector m[3] = {oracle::real(oracle::rational(e.linear.row[0])),
                             oracle::real(oracle::rational(e.linear.row[1])),
                             oracle::real(oracle::rational(e.linear.row[2]))};
    const RealVector columns[3] = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const RealVector v = p - oracle::real(oracle::rational(e.center));
    const RealVector f = columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
    return {dot(columns[0], f), dot(columns[1], f), dot(columns[2], f)};
}
Tally tally(double aspect) {
    Draw draw(kSeed + static_cast<unsigned>(std::log2(aspect)));
    Tally result;
    StageCounts counts;
    for (int i = 0; i < 300; ++i) {
        const auto [ray, e] = thin_case(draw, aspect);
        SCOPED_TRACE(::testing::Message() << "aspect " << aspect << ", case " << i);
        const oracle::ExactLine line = oracle::line(ray);
        const std::optional<oracle::BallHit> truth = oracle::first_hit(oracle::ball(line, e));
        const std::optional<SphereHit> found = hit(ray, e, counts);
        EXPECT_EQ(found.has_value(), truth.has_value());
        if (!found || !truth) continue;
        ++result.hits;
        EXPECT_EQ(found->which, truth->which);
        EXPECT_LE(Real(found->root.low), truth->t);
        EXPECT_GE(Real(found->root.high), truth->t);
        const SurfacePoint surface = surface_point(ray, e, found->which);
        const RealVector p = oracle::real(line.o) + oracle::real(line.d) * truth->t;
        for (const Real& off : {Real(p.x - surface.point.x), Real(p.y - surface.point.y),
                                Real(p.z - surface.point.z)})
            EXPECT_LE(abs(off), Real(surface.error));
        double reach = 0;
        for (const Vector3& row : e.linear.row)
            reach = std::fmax(reach, std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z));
        const double allowed = surface_tolerance() * (max_norm(e.center) + reach * e.radius);
        EXPECT_LE(surface.error, 1.01 * allowed);
        result.worst_normal =
            std::fmax(result.worst_normal, difference(surface.normal, normal_at(e, p)));
    }
    result.exact = static_cast<double>(counts.exact) / result.hits;
    return result;
}

TEST(QuadraticStages, PointsOfThinEllipsoidsKeepTheirBounds) {
    for (const double aspect : {1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6}) {
        const Tally t = tally(aspect);
        EXPECT_GT(t.hits, 150) << aspect;
        if (detail::kLongDoubleIsWider) {
            EXPECT_LT(t.exact, aspect > 1e4 ? 0.5 : 0.1) << aspect;
        }
        EXPECT_LE(t.worst_normal, 512 * surface_tolerance()) << aspect;
        if (HasFailure()) return;
    }
}

/// Every quantity of the stage in long double against its true value.
template <typename Surface>
void expect_bounds(const ExactRay& ray, const Surface& surface, const oracle::RationalVector& f,
                   const oracle::RationalVector& g, const Rational& r) {
    const auto q = detail::rounded_quadratic<long double>(ray, surface);
    const auto within = [](long double value, const Real& truth, long double error) {
        EXPECT_LE(abs(Real(Real(value) - truth)), Real(error));
    };
    const Rational a = dot(g, g);
    const Rational b = dot(f, g);
    within(q.a, oracle::real(a), q.a * q.a_relative);
    within(q.b, oracle::real(b), q.b_error);
    within(q.c, oracle::real(Rational(dot(f, f) - r * r)), q.c_error);
    within(q.depth, oracle::real(Rational(r * r - dot(f, f) + b * b / a)), q.depth_error);
    const oracle::RationalVector l = f - g * Rational(b / a);
    const RealVector off{Real(q.l.x) - oracle::real(l.x), Real(q.l.y) - oracle::real(l.y),
                         Real(q.l.z) - oracle::real(l.z)};
    EXPECT_LE(sqrt(dot(off, off)), Real(q.offset_error) * Real(1.5));  // each along an axis
}

TEST(QuadraticStages, InLongDoubleKeepTheirBounds) {
    Draw draw(kSeed);
    for (int i = 0; i < 400; ++i) {
        const auto [ray, e] = thin_case(draw, draw.size(0, 20));
        SCOPED_TRACE(::testing::Message() << "case " << i);
        const oracle::ExactLine line = oracle::line(ray);
        const oracle::RationalVector f = line.o - oracle::rational(e.center);
        const oracle::RationalVector m[3] = {oracle::rational(e.linear.row[0]),
                                             oracle::rational(e.linear.row[1]),
                                             oracle::rational(e.linear.row[2])};
        const oracle::RationalVector columns[3] = {cross(m[1], m[2]), cross(m[2], m[0]),
                                                   cross(m[0], m[1])};
        const auto local = [&](const oracle::RationalVector& v) {
            return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
        };
        expect_bounds(ray, e, local(f), local(line.d),
                      Rational(dot(m[0], columns[0]) * Rational(e.radius)));
        // A sphere of any size that the origin is near.
        const double radius = draw.size(-10, 40);
        const Point3 center = ray.origin() + normalized(draw.vector()) * radius *
                                                 (1 + draw.uniform(-1, 1) * draw.size(-60, 2));
        expect_bounds(ray, Sphere{center, radius}, line.o - oracle::rational(center), line.d,
                      Rational(radius));
        if (HasFailure()) return;
    }
}

// A sphere of radius 1e7 as the ground, seen from a man's height: no exact arithmetic but at its
// horizon, where only the direction counts.
TEST(QuadraticStages, GroundsAreMetWithoutExactArithmetic) {
    if (!detail::kLongDoubleIsWider) GTEST_SKIP() << "long double is no wider than double";
    Draw draw(kSeed);
    StageCounts counts;
    for (int i = 0; i < 1000; ++i) {
        const Sphere ground{{draw.uniform(-5, 5), -1e7, draw.uniform(-5, 5)}, 1e7};
        const Point3 eye = draw.vector() + Vector3{0, 3, 0};
        const ExactRay ray(Ray{eye, draw.vector() + Vector3{0, -1.01, 0}});
        const std::optional<SphereHit> found = hit(ray, ground, counts, Sides::kFront);
        const auto truth = oracle::first_hit(oracle::ball(oracle::line(ray), ground));
        ASSERT_EQ(found.has_value(), truth.has_value());
        if (!found) continue;
        ASSERT_LE(Real(found->root.low), truth->t);
        ASSERT_GE(Real(found->root.high), truth->t);
    }
    EXPECT_GT(counts.wider, 900U);
    EXPECT_LT(counts.exact, 10U);
}

}  // namespace
}  // namespace nuvo
