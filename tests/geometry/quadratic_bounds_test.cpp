#include <gtest/gtest.h>

#include <random>

#include "geometry/worst_case.h"
#include "predicates_quadratic.h"

// Each bound of the spheres' and ellipsoids' first stage against the worst that the roundings can
// do, in cases where each of its terms counts: never below it, and close to it somewhere.
namespace nuvo {
namespace {

using worst_case::Draw;
using worst_case::Number;
using worst_case::Tightness;
using worst_case::Vector;

constexpr unsigned kSeed = 20261129;

/// The quantities of a RoundedQuadratic with their worst errors.
struct Worst {
    Number a, b, c, depth;
    Vector l;
};
Worst worst_of(const Vector& f, const Vector& g, const Number& radius, bool by_inverse) {
    const Number a = dot(g, g);
    const Number b = dot(f, g);
    const Number s = by_inverse ? b * (Number(1) / a) : b / a;
    const Vector l = f - g * s;
    const Number rr = radius * radius;
    return {a, b, dot(f, f) - rr, rr - dot(l, l), l};
}

Vector direction_of(const ExactRay& ray) {
    return ray.tail() == Vector3{} ? Vector(ray.direction()) : Vector::rounded(ray.direction());
}
Worst worst_of(const ExactRay& ray, const Sphere& sphere) {
    return worst_of(Vector::rounded(ray.origin() - sphere.center), direction_of(ray),
                    Number(sphere.radius), true);
}

struct Adjugate {
    explicit Adjugate(const Matrix3& m) {
        const Vector r0(m.row[0]);
        const Vector r1(m.row[1]);
        const Vector r2(m.row[2]);
        columns[0] = cross(r1, r2);
        columns[1] = cross(r2, r0);
        columns[2] = cross(r0, r1);
    }
    Vector operator*(const Vector& v) const {
        const auto row = [&](int i) {
            return columns[0][i] * v.x + columns[1][i] * v.y + columns[2][i] * v.z;
        };
        return {row(0), row(1), row(2)};
    }
    Vector columns[3] = {Vector{0, 0, 0}, Vector{0, 0, 0}, Vector{0, 0, 0}};
};
Worst worst_of(const ExactRay& ray, const Ellipsoid& e) {
    const Adjugate adjugate(e.linear);
    const Number radius = dot(Vector(e.linear.row[0]), adjugate.columns[0]) * Number(e.radius);
    return worst_of(adjugate * Vector::rounded(ray.origin() - e.center),
                    adjugate * direction_of(ray), radius, false);
}

struct Bounds {
    Tightness a{"a"}, b{"b"}, c{"c"}, depth{"depth"}, offset{"offset"};

    void add(const detail::RoundedQuadratic<double>& q, const Worst& w) {
        a.add(q.a_relative * q.a, w.a.error());
        b.add(q.b_error, w.b.error());
        c.add(q.c_error, w.c.error());
        // The part of l's error along g counts by its square.
        const double along = w.l.error_along(normalized(q.g));
        depth.add(q.depth_error, w.depth.error());
        depth.add(q.depth_error, along * along);
        offset.add(q.offset_error, along);
        offset.add(q.offset_error, w.l.error_along(normalized(q.l)));
    }
};

Number norm1(const Vector& v) { return abs(v.x) + abs(v.y) + abs(v.z); }
/// What an origin that is off by e can add to |c|.
Number band_of(const ExactRay& ray, const Sphere& sphere, double e) {
    const Vector f = Vector::rounded(ray.origin() - sphere.center);
    return Number(e) * (Number(2) * norm1(f) + Number(3) * Number(e));
}
Number band_of(const ExactRay& ray, const Ellipsoid& ellipsoid, double e) {
    const Adjugate adjugate(ellipsoid.linear);
    const Vector f = adjugate * Vector::rounded(ray.origin() - ellipsoid.center);
    const Vector* c = adjugate.columns;
    const Vector rho{abs(c[0].x) + abs(c[1].x) + abs(c[2].x),
                     abs(c[0].y) + abs(c[1].y) + abs(c[2].y),
                     abs(c[0].z) + abs(c[1].z) + abs(c[2].z)};
    const Vector size{abs(f.x), abs(f.y), abs(f.z)};
    return Number(e) * (Number(2) * dot(rho, size) + Number(e) * dot(rho, rho));
}
template <typename Surface>
void add_band(Tightness& tightness, const ExactRay& ray, const Surface& surface, double error) {
    const detail::Bounded<double> band =
        detail::rounded_touch_band(detail::rounded_quadratic(ray, surface), surface, error);
    const Number worst = band_of(ray, surface, error);
    EXPECT_DOUBLE_EQ(band.value, worst.value());
    tightness.add(band.error, worst.error());
}

/// An origin seen from the centre, a direction and a radius; each kind lets other terms count.
struct Line {
    Vector3 f, d;
    double radius;
};
constexpr int kKinds = 7;
Line line(Draw& draw, int kind) {
    Line l{draw.vector() * 3, draw.vector(), draw.uniform(0.1, 1)};
    if (kind == 1) l.radius *= draw.size(20, 40);
    if (kind == 2) l.f *= draw.size(10, 40);
    if (kind == 3) l.f *= draw.size(10, 70);
    if (kind == 3 || kind == 4) l.d = l.f * draw.size(-3, 3);  // at the centre
    if (kind == 5) l.f = {l.f.x, l.f.y * 0x1p-20, 0};
    if (kind == 5) l.d = {l.d.x, l.d.y * 0x1p-30, 0};
    if (kind == 6) l.d = cross(l.f, l.d);  // nearest at the origin, and grazing
    if (kind == 6) l.radius = length(l.f);
    return l;
}
ExactRay ray_of(Draw& draw, const Line& l) {
    return draw.below(2) != 0 ? ExactRay(Ray{l.f, l.d}) : ExactRay::between(l.f, l.f + l.d);
}
Point3 center(Draw& draw) { return draw.below(2) != 0 ? Point3{} : draw.vector() * 0.1; }

TEST(QuadraticBounds, OfSpheresAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed);
    Bounds bounds;
    Tightness band{"band"};
    for (int i = 0; i < 500 * kKinds; ++i) {
        const Line l = line(draw, i % kKinds);
        const ExactRay ray = ray_of(draw, l);
        const Sphere sphere{center(draw), l.radius};
        bounds.add(detail::rounded_quadratic(ray, sphere), worst_of(ray, sphere));
        add_band(band, ray, sphere, draw.size(-50, 5));
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    EXPECT_LT(bounds.a.least, 1.21);
    EXPECT_LT(bounds.b.least, 1.41);
    EXPECT_LT(bounds.c.least, 1.35);
    EXPECT_LT(bounds.depth.least, 1.36);
    EXPECT_LT(bounds.offset.least, 2.2);
    EXPECT_LT(band.least, 1.4);
}

constexpr int kMatrices = 7;
Matrix3 matrix(Draw& draw, int kind) {
    Matrix3 m{{draw.vector(), draw.vector(), draw.vector()}};
    if (kind == 0)
        m = {{{draw.uniform(1, 2), 0, 0}, {0, draw.uniform(1, 2), 0}, {0, 0, draw.uniform(-2, 2)}}};
    const double small = draw.size(-30, -10);
    if (kind < 3) {  // one row of the adjugate outweighs the others
        for (Vector3& row : m.row) row[kind] *= small;
    } else if (kind == 3) {
        m.row[draw.below(3)] *= small;
    } else if (kind == 4) {  // nearly flat: cancellation in the adjugate
        m.row[2] = m.row[0] * 0.75 + m.row[1] * 0.5 + draw.vector() * small;
    }
    return m;
}

TEST(QuadraticBounds, OfEllipsoidsAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed);
    Bounds bounds;
    Tightness band{"band"};
    int judged = 0;
    for (int i = 0; i < 40 * kKinds * kMatrices; ++i) {
        const Matrix3 m = matrix(draw, i / kKinds % kMatrices);
        Line l = line(draw, i % kKinds);
        if (draw.below(2) != 0) l = {m * l.f, m * l.d, l.radius};
        const ExactRay ray = ray_of(draw, l);
        const Ellipsoid ellipsoid{center(draw), m, l.radius};
        const detail::RoundedQuadratic<double> q = detail::rounded_quadratic(ray, ellipsoid);
        if (std::isnan(q.b_error)) continue;
        ++judged;
        bounds.add(q, worst_of(ray, ellipsoid));
        add_band(band, ray, ellipsoid, draw.size(-50, 5));
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    EXPECT_GT(judged, 36 * kKinds * kMatrices);
    EXPECT_LT(bounds.a.least, 1.6);
    EXPECT_LT(bounds.b.least, 1.6);
    EXPECT_LT(bounds.c.least, 1.41);
    EXPECT_LT(bounds.depth.least, 2);
    EXPECT_LT(bounds.offset.least, 8.5);
    EXPECT_LT(band.least, 3);
}

// Where squares or their products may leave the range nothing is decided, whichever of the numbers
// is at fault.
TEST(QuadraticBounds, DecideNothingOutOfRange) {
    const Matrix3 one;
    const auto known = [&](double f, double d, double radius) {
        const ExactRay ray(Ray{{f, f, f}, {d, d, d}});
        const detail::RoundedQuadratic<double> sphere =
            detail::rounded_quadratic(ray, Sphere{{}, radius});
        const detail::RoundedQuadratic<double> ellipsoid =
            detail::rounded_quadratic(ray, Ellipsoid{{}, one, radius});
        SphereHit hit;
        for (const detail::RoundedQuadratic<double>& q : {sphere, ellipsoid})
            if (std::isnan(q.b_error)) {
                EXPECT_EQ(detail::rounded_hit(q, Sides::kBoth, hit), detail::Decision::kUnsure);
                EXPECT_EQ(detail::rounded_blocks(q, 1, {0, 0}, false, Sides::kBoth),
                          detail::Decision::kUnsure);
            }
        EXPECT_EQ(std::isnan(sphere.b_error), std::isnan(ellipsoid.b_error));
        return !std::isnan(sphere.b_error);
    };
    for (const double in : {0x1p-390, 1.0, 0x1p390}) EXPECT_TRUE(known(in, in, in));
    EXPECT_FALSE(known(0x1p451, 1, 1));
    EXPECT_FALSE(known(1, 1, 0x1p451));
    EXPECT_FALSE(known(0x1p-452, 1, 0x1p-452));
    EXPECT_FALSE(known(1, 0x1p401, 1));
    EXPECT_FALSE(known(1, 0x1p-402, 1));
}

}  // namespace
}  // namespace nuvo
