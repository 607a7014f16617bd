#include "sieve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nuvo::hard {
namespace {

using Vector = Sieve::Vector;

long double reach(const Vector& v) { return max_norm(v); }

bool may_meet(const Triangle& triangle, const Vector& o, const Vector& d, long double slack) {
    const Vector a = Vector(triangle.a) - o;
    const Vector b = Vector(triangle.b) - o;
    const Vector c = Vector(triangle.c) - o;
    // The corners are known within slack times their size, not that of the differences.
    const long double size = std::max({reach(Vector(triangle.a)), reach(Vector(triangle.b)),
                                       reach(Vector(triangle.c)), reach(o)});
    const long double span = std::max({reach(a), reach(b), reach(c)});
    const long double error = 64 * slack * reach(d) * (size + span) * (span + slack * size);
    const long double u = dot(d, cross(c, b));
    const long double v = dot(d, cross(a, c));
    const long double w = dot(d, cross(b, a));
    return !((u > error || v > error || w > error) && (u < -error || v < -error || w < -error));
}

bool may_meet(const Sphere& sphere, const Vector& o, const Vector& d, long double slack) {
    const Vector f = o - Vector(sphere.center);
    const long double r = sphere.radius;
    const long double size = reach(o) + reach(Vector(sphere.center)) + r;
    const long double error = 64 * slack * size * (size * slack + reach(f) + r);
    const long double a = dot(d, d);
    const long double b = dot(f, d);
    const long double c = dot(f, f) - r * r;
    const long double depth = b * b / a - c;
    const long double b_error = 64 * slack * std::sqrt(a) * (reach(f) + size);
    return !(depth < -error) && !(c > error && b > b_error);
}

}  // namespace

Sieve::Sieve(const Scene& scene) : scene_(scene) {
    const auto add = [&](std::size_t object, std::size_t triangle, const Vector& low,
                         const Vector& high) {
        items_.push_back({object, triangle, low, high, std::max(reach(low), reach(high))});
    };
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Shape& shape = scene.objects[i].shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
            for (std::size_t k = 0; k < mesh->triangles.size(); ++k) {
                const Triangle t = mesh->triangle(k);
                const Vector a(t.a);
                const Vector b(t.b);
                const Vector c(t.c);
                add(i, k, min(a, min(b, c)), max(a, max(b, c)));
            }
        } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            const Vector c(sphere->center);
            const long double r = sphere->radius;
            add(i, 0, c - Vector{r, r, r}, c + Vector{r, r, r});
        } else {
            const auto& ellipsoid = std::get<Ellipsoid>(shape);
            const Vector c(ellipsoid.center);
            Vector half;
            for (int axis = 0; axis < 3; ++axis)
                half[axis] = length(Vector(ellipsoid.linear.row[axis])) *
                             static_cast<long double>(ellipsoid.radius) * 1.000001L;
            add(i, 0, c - half, c + half);
        }
    }
}

bool Sieve::may_enter(const Item& item, const Vector& o, const Vector& d, long double slack) {
    const long double margin = slack * (item.reach + reach(o));
    long double from = 0;
    long double to = std::numeric_limits<long double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const long double low = item.low[axis] - margin - o[axis];
        const long double high = item.high[axis] + margin - o[axis];
        if (d[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const long double t0 = (d[axis] > 0 ? low : high) / d[axis];
        const long double t1 = (d[axis] > 0 ? high : low) / d[axis];
        from = std::max(from, t0 - slack * std::fabs(t0));
        to = std::min(to, t1 + slack * std::fabs(t1));
    }
    return !(from > to);
}

bool Sieve::may_hit(const Item& item, const Vector& o, const Vector& d, long double slack) const {
    const Shape& shape = scene_.objects[item.object].shape;
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
        return may_meet(mesh->triangle(item.triangle), o, d, slack);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return may_meet(*sphere, o, d, slack);
    return true;
}

}  // namespace nuvo::hard
