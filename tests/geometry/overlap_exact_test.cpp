#include <gtest/gtest.h>

#include "geometry/predicates_oracle.h"
#include "geometry/worst_case.h"
#include "nuvo/geometry/overlap.h"

// Overlap tests where triangles, spheres and boxes just touch, at scales from subnormal to near
// overflow, against the separating axes
// in 200 digits, which hold every product here exactly: never no where they touch, and no where
// they are further apart than some roundings.
namespace nuvo {
namespace {

using oracle::Real;
using oracle::RealVector;
using worst_case::Draw;

constexpr unsigned kSeed = 20261132;

RealVector exactly(const Point3& p) { return {Real(p.x), Real(p.y), Real(p.z)}; }

struct Interval {
    Real low, high;
};
Interval shadow(const RealVector& axis, const std::vector<RealVector>& points) {
    Interval i{dot(axis, points[0]), dot(axis, points[0])};
    for (const RealVector& p : points) {
        const Real at = dot(axis, p);
        if (at < i.low) i.low = at;
        if (at > i.high) i.high = at;
    }
    return i;
}

/// The 13 axes of which one separates a triangle and a box that have no point in common.
std::vector<RealVector> axes_of(const Triangle& t) {
    const RealVector unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const RealVector a = exactly(t.a);
    const RealVector b = exactly(t.b);
    const RealVector c = exactly(t.c);
    std::vector<RealVector> axes = {unit[0], unit[1], unit[2], cross(b - a, c - a)};
    for (const RealVector& edge : {b - a, c - b, a - c})
        for (const RealVector& u : unit) axes.push_back(cross(edge, u));
    return axes;
}
std::vector<RealVector> corners_of(const Bounds3& box, const Real& more) {
    const RealVector low = exactly(box.min) - RealVector{more, more, more};
    const RealVector high = exactly(box.max) + RealVector{more, more, more};
    std::vector<RealVector> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    return corners;
}
bool truly_overlaps(const Triangle& t, const Bounds3& box, const Real& more) {
    const std::vector<RealVector> corners = corners_of(box, more);
    const std::vector<RealVector> points = {exactly(t.a), exactly(t.b), exactly(t.c)};
    for (const RealVector& axis : axes_of(t)) {
        const Interval p = shadow(axis, points);
        const Interval q = shadow(axis, corners);
        if (p.low > q.high || p.high < q.low) return false;
    }
    return true;
}

/// The triangle moved along the axis that separates it most, until it touches the box up to
/// rounding.
Triangle moved_to_touch(const Triangle& t, const Bounds3& box) {
    const Vector3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<Vector3> axes = {unit[0], unit[1], unit[2], cross(t.b - t.a, t.c - t.a)};
    for (const Vector3& edge : {t.b - t.a, t.c - t.b, t.a - t.c})
        for (const Vector3& u : unit) axes.push_back(cross(edge, u));
    double most = -std::numeric_limits<double>::infinity();
    Vector3 way;
    for (const Vector3& axis : axes) {
        const Vector3 n = normalized(axis);
        if (n == Vector3{}) continue;
        const double p[3] = {dot(n, t.a), dot(n, t.b), dot(n, t.c)};
        const double center = dot(n, box.center());
        const Vector3 half = box.widths() * 0.5;
        const double reach =
            std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z;
        const double above = std::fmin(p[0], std::fmin(p[1], p[2])) - (center + reach);
        const double below = (center - reach) - std::fmax(p[0], std::fmax(p[1], p[2]));
        if (above > most) {
            most = above;
            way = -n * above;
        }
        if (below > most) {
            most = below;
            way = n * below;
        }
    }
    return {t.a + way, t.b + way, t.c + way};
}

class Overlap : public ::testing::TestWithParam<double> {};

TEST_P(Overlap, OfTrianglesThatJustTouch) {
    const double scale = GetParam();
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", scale " << scale);
    Draw draw(kSeed);
    int touching = 0;
    int apart = 0;
    for (int i = 0; i < 900; ++i) {
        Vector3 far;
        if (i % 3 == 0) {
            far = draw.vector();
            far = far * draw.size(0, 20);
        }
        Bounds3 box;
        for (const Vector3& p : {draw.vector(), draw.vector()}) box = box.extended(p + far);
        const Vector3 size = Vector3{1, 1, 1} * draw.size(-4, 4);
        Triangle t{draw.vector() * size + far, draw.vector() * size + far,
                   draw.vector() * size + far};
        t = moved_to_touch(t, box);
        // Some roundings more or less, and sometimes many.
        const double largest = std::fmax(max_norm(box.min), max_norm(box.max)) +
                               max_norm(t.b - t.a) + max_norm(t.c - t.a);
        const Vector3 way = draw.vector();
        const Vector3 step = way * (largest * draw.size(-56, i % 2 ? -52 : -40));
        for (Point3* p : {&t.a, &t.b, &t.c}) *p = (*p + step) * scale;
        Bounds3 there{box.min * scale, box.max * scale};
        const bool found = overlaps(t, there);
        // A power of two changes nothing but what falls below the least number.
        for (Point3* p : {&t.a, &t.b, &t.c, &there.min, &there.max}) *p = *p / scale;
        if (truly_overlaps(t, there, 0)) {
            ++touching;
            ASSERT_TRUE(found) << "case " << i;
        } else if (!found) {
            ++apart;
        } else if (scale > 0x1p-300 && scale < 0x1p300) {
            ASSERT_TRUE(truly_overlaps(t, there, Real(largest) * Real(0x1p-46))) << "case " << i;
        }
    }
    EXPECT_GT(touching, 240);
    if (scale > 0x1p-300 && scale < 0x1p300) {
        EXPECT_GT(apart, 120);
    }
}

TEST_P(Overlap, OfSpheresThatJustTouch) {
    const double scale = GetParam();
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", scale " << scale);
    Draw draw(kSeed + 1);
    int touching = 0;
    int apart = 0;
    for (int i = 0; i < 1800; ++i) {
        Bounds3 box;
        for (const Vector3& p : {draw.vector(), draw.vector()}) box = box.extended(p * scale);
        Point3 center = draw.vector() * 2 * scale;
        if (i % 3 == 0) center.x = draw.uniform(box.min.x, box.max.x);
        if (i % 5 == 0) center.y = draw.uniform(box.min.y, box.max.y);
        Real nearest = 0;
        Real farthest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Real below = Real(box.min[axis] / scale) - Real(center[axis] / scale);
            const Real above = Real(center[axis] / scale) - Real(box.max[axis] / scale);
            const Real outside = std::max(Real(0), std::max(below, above));
            const Real across = std::max(Real(abs(below)), Real(abs(above)));
            nearest += outside * outside;
            farthest += across * across;
        }
        const Real touched = draw.below(2) != 0 ? nearest : farthest;
        const double sense = draw.uniform(-1, 1);
        const double radius =
            static_cast<double>(sqrt(touched)) * scale * (1 + sense * draw.size(-54, -45));
        const Real squared = Real(radius / scale) * Real(radius / scale);
        const bool truth = nearest <= squared && squared <= farthest;
        const bool found = overlaps(Sphere{center, radius}, box);
        if (truth) {
            ++touching;
            ASSERT_TRUE(found) << "case " << i;
        } else if (!found) {
            ++apart;
        } else if (scale > 0x1p-300) {
            const Real few = Real(1) + Real(0x1p-48);
            ASSERT_TRUE(nearest <= squared * few && squared <= farthest * few) << "case " << i;
        }
    }
    EXPECT_GT(touching, 600);
    if (scale > 0x1p-300) {
        EXPECT_GT(apart, 300);
    }
}

INSTANTIATE_TEST_SUITE_P(Scales, Overlap,
                         ::testing::Values(1.0, 0x1p-350, 0x1p-500, 0x1p-538, 0x1p-1065, 0x1p335));

}  // namespace
}  // namespace nuvo
