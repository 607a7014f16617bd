#include <gtest/gtest.h>

#include "geometry/worst_case.h"
#include "plane_root.h"
#include "predicates_quadratic.h"

// Triple products, and the points where rays meet surfaces: their bounds against the worst that the
// roundings can do.
namespace nuvo {
namespace {

using worst_case::Draw;
using worst_case::Number;
using worst_case::Tightness;
using worst_case::Vector;

constexpr unsigned kSeed = 20261131;

Vector direction_of(const ExactRay& ray) {
    return ray.tail() == Vector3{} ? Vector(ray.direction()) : Vector::rounded(ray.direction());
}
Vector3 far_vector(Draw& draw, double least, double most) {
    const Vector3 way = draw.vector();
    return way * draw.size(least, most);
}
/// A ray from `from` through `to`, half of them with a tail.
ExactRay ray_through(Draw& draw, const Point3& from, const Point3& to) {
    return draw.below(2) != 0 ? ExactRay(Ray{from, to - from}) : ExactRay::between(from, to);
}

/// A triangle, of which other terms count by kind, and a ray at a point of it.
struct TriangleCase {
    Triangle triangle;
    ExactRay ray;
};
constexpr int kTriangles = 7;
TriangleCase triangle_case(Draw& draw, int kind) {
    Triangle t{draw.vector(), draw.vector(), draw.vector()};
    Point3 from = draw.vector() * 2;
    const double small = draw.size(-6, -2);
    if (kind < 3) {  // nearly in a coordinate plane: one component of the normal outweighs
        for (Point3* p : {&t.a, &t.b, &t.c}) (*p)[kind] *= small;
        from[(kind + 1) % 3] *= small;
        from[(kind + 2) % 3] *= small;
    }
    if (kind == 3) t.b = t.a + (t.b - t.a) * small;
    if (kind == 4) t.c = t.a + (t.c - t.a) * small;
    if (kind == 5) from *= draw.size(2, 6);
    if (kind == 6) {  // all far from 0
        const Vector3 far = far_vector(draw, 16, 24);
        for (Point3* p : {&t.a, &t.b, &t.c, &from}) *p = *p + far;
    }
    const double u = draw.uniform(0.1, 0.8);
    const double v = (1 - u) * draw.uniform(0.1, 0.9);
    const ExactRay ray = ray_through(draw, from, t.a + (t.b - t.a) * u + (t.c - t.a) * v);
    return {t, ray};
}

TEST(SurfaceBounds, OfPlanesAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed);
    Tightness numerator{"numerator"};
    Tightness denominator{"denominator"};
    Tightness normal{"normal"};
    for (int i = 0; i < 300 * kTriangles; ++i) {
        const auto [t, ray] = triangle_case(draw, i % kTriangles);
        const detail::PlaneRoot<double> root = detail::plane_root<double>(ray, t);
        const Vector n = cross(Vector::rounded(t.b - t.a), Vector::rounded(t.c - t.a));
        numerator.add(root.numerator.error, dot(n, Vector::rounded(t.a - ray.origin())).error());
        denominator.add(root.denominator.error, dot(n, direction_of(ray)).error());
        for (int axis = 0; axis < 3; ++axis)
            normal.add(gamma(4) * root.normal_magnitude[axis], n[axis].error());
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    EXPECT_LT(numerator.least, 1.14);
    EXPECT_LT(denominator.least, 1.14);
    EXPECT_LE(normal.least, 1.001);
}

/// One bound for the three edge functions of all triangles within a reach.
TEST(SurfaceBounds, OfEdgesAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 1);
    Draw draw(kSeed + 1);
    Tightness edge{"edge"};
    for (int i = 0; i < 2000; ++i) {
        Vector3 d = draw.vector();
        Vector3 b = draw.vector();
        Vector3 c = draw.vector();
        if (i % 2 != 0)  // all largest, in the signs that let all six terms add up
            for (int axis = 0; axis < 3; ++axis)
                for (Vector3* v : {&d, &b, &c}) {
                    const double size = draw.uniform(0.99, 1);
                    (*v)[axis] = draw.below(2) != 0 ? size : -size;
                }
        const double bound =
            detail::edge_error_bound(max_norm(d), std::fmax(max_norm(b), max_norm(c)));
        const Vector q = cross(Vector::rounded(d), Vector::rounded(c));
        edge.add(bound, dot(Vector::rounded(b), q).error());
        edge.add(bound,
                 dot(Vector::rounded(d), cross(Vector::rounded(b), Vector::rounded(c))).error());
    }
    EXPECT_LT(edge.least, 1.6);
}

Vector unit(const Vector& v) {
    const Vector3 size = v.value();
    const int largest = std::fabs(size.x) >= max_norm(size)   ? 0
                        : std::fabs(size.y) >= max_norm(size) ? 1
                                                              : 2;
    const Number scale = size[largest] < 0 ? -v[largest] : v[largest];
    const Vector scaled{v.x / scale, v.y / scale, v.z / scale};
    const Number length = sqrt(dot(scaled, scaled));
    return {scaled.x / length, scaled.y / length, scaled.z / length};
}
double worst(const Vector& point) {
    return std::fmax(point.x.error(), std::fmax(point.y.error(), point.z.error()));
}

TEST(SurfaceBounds, OfPointsOfTrianglesAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 2);
    Draw draw(kSeed + 2);
    Tightness points[kTriangles] = {{"0"}, {"1"}, {"2"}, {"3"}, {"4"}, {"5"}, {"6"}};
    for (int i = 0; i < 300 * kTriangles; ++i) {
        const auto [t, ray] = triangle_case(draw, i % kTriangles);
        const SurfacePoint found = surface_point(ray, t);
        const Vector d = direction_of(ray);
        const Vector e1 = Vector::rounded(t.b - t.a);
        const Vector e2 = Vector::rounded(t.c - t.a);
        const Vector from = Vector::rounded(t.a - ray.origin());
        const Number s = dot(d, -cross(e1, e2));
        const Number x = dot(d, cross(from, e2)) / s;
        const Number y = dot(d, cross(e1, from)) / s;
        const double most = worst(Vector(t.a) + (e1 * x + e2 * y));
        if (most > surface_tolerance() *
                       std::fmax(max_norm(t.a), std::fmax(max_norm(t.b), max_norm(t.c))) / 8)
            continue;
        points[i % kTriangles].add(found.error, most);
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    for (const Tightness& p : points) EXPECT_LT(p.least, 3.1) << p.name;
}

/// A sphere about 0 times `stretch`, and a ray that meets it; kinds as for the triangles: other
/// terms count.
struct RoundCase {
    Sphere sphere;
    ExactRay ray;
    SphereRoot which;
};
constexpr int kRounds = 6;
RoundCase round_case(Draw& draw, int kind) {
    Sphere sphere{{}, draw.uniform(0.5, 1)};
    Point3 from = draw.vector() * 3;
    Point3 to = draw.vector() * 0.3;
    if (kind == 1) sphere.center = far_vector(draw, 2, 8);
    if (kind == 2) from *= draw.size(2, 6);
    if (kind == 3) sphere.radius *= draw.size(3, 6);  // from within
    if (kind == 4) {                                  // grazing
        const Vector3 side = normalized(cross(from, draw.vector()));
        to = side * (sphere.radius * (1 - draw.size(-6, -2)));
    }
    if (dot(from, from) < 2 && kind != 3) from *= 4;
    if (kind == 5) sphere.center = far_vector(draw, 16, 24);
    const SphereRoot which = draw.below(2) != 0 ? SphereRoot::kNear : SphereRoot::kFar;
    return {sphere, ray_through(draw, sphere.center + from, sphere.center + to), which};
}
/// f + t g at a root, in the order of the first stage.
Vector offset(const Vector& f, const Vector& g, const Number& radius, bool by_inverse,
              SphereRoot which) {
    const Number a = dot(g, g);
    const Number b = dot(f, g);
    const Number s = by_inverse ? b * (Number(1) / a) : b / a;
    const Vector l = f - g * s;
    const Number depth = radius * radius - dot(l, l);
    const Vector part = g * (sqrt(a) * sqrt(depth) / a);
    return which == SphereRoot::kNear ? l - part : l + part;
}

TEST(SurfaceBounds, OfPointsOfSpheresAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 3);
    Draw draw(kSeed + 3);
    Tightness points[kRounds] = {{"0"}, {"1"}, {"2"}, {"3"}, {"4"}, {"5"}};
    for (int i = 0; i < 300 * kRounds; ++i) {
        const auto [sphere, ray, which] = round_case(draw, i % kRounds);
        const Vector f = Vector::rounded(ray.origin() - sphere.center);
        const Vector p = offset(f, direction_of(ray), Number(sphere.radius), true, which);
        const Vector point = Vector(sphere.center) + unit(p) * Number(sphere.radius);
        const double most = worst(point);
        if (most > surface_tolerance() * (max_norm(sphere.center) + sphere.radius) / 32) continue;
        points[i % kRounds].add(surface_point(ray, sphere, which).error, most);
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    for (const Tightness& p : points) EXPECT_LT(p.least, 7) << p.name;
    EXPECT_LT(points[5].least, 2.01);
}

TEST(SurfaceBounds, OfPointsOfEllipsoidsAreAtLeastTheWorstRoundings) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 4);
    Draw draw(kSeed + 4);
    Tightness points[kRounds] = {{"0"}, {"1"}, {"2"}, {"3"}, {"4"}, {"5"}};
    int later = 0;
    for (int i = 0; i < 300 * kRounds; ++i) {
        const auto [sphere, at, which] = round_case(draw, i % kRounds);
        Matrix3 m{{draw.vector(), draw.vector(), draw.vector()}};
        if (draw.below(2) != 0) m.row[draw.below(3)] *= draw.size(-6, -2);
        const Point3 from = m * at.origin();
        const Ellipsoid e{m * sphere.center, m, sphere.radius};
        const ExactRay ray = ray_through(draw, from, from + m * at.direction());
        const Vector r0(m.row[0]);
        const Vector r1(m.row[1]);
        const Vector r2(m.row[2]);
        const Vector columns[3] = {cross(r1, r2), cross(r2, r0), cross(r0, r1)};
        const auto local = [&](const Vector& v) {
            const auto row = [&](int k) {
                return columns[0][k] * v.x + columns[1][k] * v.y + columns[2][k] * v.z;
            };
            return Vector{row(0), row(1), row(2)};
        };
        const Number determinant = dot(r0, columns[0]);
        const Vector p =
            unit(offset(local(Vector::rounded(ray.origin() - e.center)), local(direction_of(ray)),
                        determinant * Number(e.radius), false, which)) *
            Number(determinant.value() < 0 ? -e.radius : e.radius);
        const Vector point = Vector{dot(r0, p), dot(r1, p), dot(r2, p)} + Vector(e.center);
        const double found = surface_point(ray, e, which).error;
        double reach = 0;
        for (const Vector3& row : m.row)
            reach = std::fmax(reach, std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z));
        reach *= e.radius;
        // A later stage took the point from the ray.
        const detail::RoundedOffset first =
            detail::rounded_offset(detail::rounded_quadratic(ray, e), which);
        if (!(found >= first.error / std::fabs(determinant.value() * e.radius) * reach)) {
            ++later;
            continue;
        }
        points[i % kRounds].add(found, worst(point));
        ASSERT_FALSE(HasFailure()) << "case " << i;
    }
    EXPECT_LT(later, 900);
    // The last kind is so far away that nearly all of them have their points from the ray.
    for (int kind = 0; kind < 5; ++kind) EXPECT_LT(points[kind].least, 50) << kind;
}

}  // namespace
}  // namespace nuvo
