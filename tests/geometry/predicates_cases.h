#pragma once

#include <cmath>
#include <cstdint>
#include <ostream>
#include <random>

#include "nuvo/geometry/predicates.h"

/// Rays and primitives of the hard classes, from a seed.
namespace cases {

using nuvo::Ellipsoid;
using nuvo::ExactRay;
using nuvo::Matrix3;
using nuvo::Point3;
using nuvo::Ray;
using nuvo::Sphere;
using nuvo::Triangle;
using nuvo::Vector3;

/// A whole scene's change: every coordinate is multiplied, then moved.
struct Placement {
    const char* name;
    double scale;
    double offset;
    bool float_exact;  ///< coordinates before it have 24 bits

    friend std::ostream& operator<<(std::ostream& out, const Placement& p) { return out << p.name; }
};
inline constexpr Placement kPlacements[] = {
    {"float coordinates", 1, 0, true}, {"full double coordinates", 1, 0, false},
    {"moved by 1e6", 1, 1e6, true},    {"moved by 1e6, full double", 1, 1e6, false},
    {"scale 1e-6", 1e-6, 0, false},    {"scale 1e-15", 1e-15, 0, false},
    {"scale 1e15", 1e15, 0, false},    {"scale 2^-50", 0x1p-50, 0, true},
    {"scale 2^50", 0x1p50, 0, true},   {"scale 1e-100", 1e-100, 0, false},
    {"scale 1e100", 1e100, 0, false},  {"scale 2^-500", 0x1p-500, 0, true},
    {"scale 2^500", 0x1p500, 0, true}, {"scale 2^-1060, subnormal", 0x1p-1060, 0, true},
};

class Random {
  public:
    Random(std::uint64_t seed, const Placement& placement) : engine_(seed), placement_(placement) {}

    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    double coordinate() {
        const double v = uniform(-1, 1);
        return placement_.float_exact ? static_cast<double>(static_cast<float>(v)) : v;
    }
    Vector3 vector() { return {coordinate(), coordinate(), coordinate()}; }
    /// Coordinates that are small multiples of 1/8: sums and products of a few are exact.
    Vector3 lattice() {
        return {(below(33) - 16) / 8.0, (below(33) - 16) / 8.0, (below(33) - 16) / 8.0};
    }
    Point3 placed(const Point3& p) const {
        const double o = placement_.offset;
        return p * placement_.scale + Vector3{o, o, o};
    }
    double placed(double length) const { return length * placement_.scale; }
    const Placement& placement() const { return placement_; }

  private:
    std::mt19937_64 engine_;
    Placement placement_;
};

/// A ray from one point to another: rounded, or exactly through it.
inline ExactRay ray_through(Random& random, const Point3& from, const Point3& to) {
    const Point3 o = random.placed(from);
    const Point3 p = random.placed(to);
    return random.below(2) != 0 ? ExactRay::between(o, p) : ExactRay(Ray{o, p - o});
}

/// The same ray with the bound of a scene that just holds `triangle`.
inline ExactRay within_scene(const ExactRay& ray, const Triangle& triangle) {
    const nuvo::Bounds3 scene = triangle.bounds();
    return ray.tail() == Vector3{}
               ? ExactRay(Ray{ray.origin(), ray.direction()}, scene)
               : ExactRay::between(ray.origin(), ray.origin() + ray.direction(), scene);
}

inline Triangle placed(const Random& random, const Triangle& t) {
    return {random.placed(t.a), random.placed(t.b), random.placed(t.c)};
}

struct TriangleCase {
    ExactRay ray;
    Triangle triangle;
};

inline constexpr int kTriangleKinds = 11;
inline TriangleCase triangle_case(Random& random, int kind) {
    const bool lattice = random.below(2) != 0;
    const auto point = [&] { return lattice ? random.lattice() : random.vector(); };
    Triangle t{point(), point(), point()};
    Point3 from = point() * 2;
    Point3 to = point();
    switch (kind) {
        case 0:
            break;
        case 1:
            to = random.below(2) != 0 ? t.a : t.c;
            break;  // a vertex
        case 2:
            to = (t.a + t.b) * 0.5;
            break;  // an edge
        case 3:
            to = t.b * 0.25 + t.c * 0.75;
            break;  // another edge
        case 4: {   // in the plane
            const Vector3 e1 = t.b - t.a;
            const Vector3 e2 = t.c - t.a;
            from = t.a + e1 * (random.below(9) - 4);
            from = from + e2 * (random.below(9) - 4);
            to = t.a + e1 * (random.below(5) * 0.25);
            to = to + e2 * (random.below(5) * 0.25);
            break;
        }
        case 5: {  // a sliver, aimed at
            t.c = t.a + (t.b - t.a) * random.uniform(0, 1);
            const Vector3 off = point();
            t.c = t.c + off * std::exp2(-random.below(52));
            to = t.a * 0.5 + t.b * 0.3 + t.c * 0.2;
            break;
        }
        case 6:
            t.c = random.below(2) != 0 ? t.b : t.a + (t.b - t.a) * 2;
            break;  // no area
        case 7: {   // origin on it
            from = random.below(2) != 0 ? t.b : (t.a + t.b) * 0.5;
            if (random.below(3) == 0) from = t.a * 0.5 + t.b * 0.25 + t.c * 0.25;
            break;
        }
        case 8: {  // grazing
            const Vector3 off = point();
            from = t.a + (t.b - t.a) * 3 + (t.c - t.a) * -2 + off * std::exp2(-random.below(60));
            to = t.a * 0.25 + t.b * 0.5 + t.c * 0.25;
            break;
        }
        case 9:
            to = t.a * 0.2 + t.b * 0.3 + t.c * 0.5;
            break;  // inside
        default: {  // small and far, aimed at
            const double size = std::exp2(-random.below(30));
            t.b = t.a + (t.b - t.a) * size;
            t.c = t.a + (t.c - t.a) * size;
            from = from * std::exp2(random.below(20));
            to = t.a * 0.2 + t.b * 0.3 + t.c * 0.5;
        }
    }
    const Triangle there = placed(random, t);
    const ExactRay ray = ray_through(random, from, to);
    return {random.below(4) != 0 ? within_scene(ray, there) : ray, there};
}

/// A sphere and a ray; kinds: random, aimed, tangent within 1e-8 .. 1e-3 R, exactly tangent, origin
/// on it, origin inside, tiny and far, huge and near.
struct SphereCase {
    ExactRay ray;
    Sphere sphere;
};
inline constexpr int kSphereKinds = 8;
inline SphereCase sphere_case(Random& random, int kind) {
    Sphere s{random.vector(), random.uniform(0.1, 1)};
    Point3 from = random.vector() * 3;
    Point3 to = random.vector();
    const auto tangent_point = [&](double factor) {
        const Vector3 side = normalized(cross(from - s.center, random.vector()));
        return s.center + side * (s.radius * factor);
    };
    switch (kind) {
        case 0:
            break;
        case 1:
            to = s.center + random.vector() * (0.5 * s.radius);
            break;
        case 2: {
            // Grazes at a distance of R (1 + e) from the centre: the tangent point lies on a cone.
            const Vector3 axis = from - s.center;
            const double e = std::pow(10, random.uniform(-16, -3));
            const double h = s.radius * (1 + (random.below(2) != 0 ? e : -e));
            const double cosine = h / length(axis);
            if (cosine >= 1) break;
            const Vector3 side = tangent_point(1) - s.center;
            to = s.center + normalized(axis) * (h * cosine) +
                 normalized(side) * (h * std::sqrt(1 - cosine * cosine));
            break;
        }
        case 3: {  // exactly: an axis-parallel line at distance R, on the lattice
            s = {random.lattice(), (1 + random.below(8)) / 8.0};
            const int axis = random.below(3);
            from = s.center;
            from[(axis + 1) % 3] += random.below(2) != 0 ? s.radius : -s.radius;
            to = from;
            from[axis] += random.below(4) - 1.5;
            to[axis] += random.below(4) - 1.75;
            break;
        }
        case 4: {  // exactly on it: a Pythagorean quadruple
            s = {random.lattice(), 9 / 8.0};
            from = s.center + Vector3{random.below(2) != 0 ? 1 / 8.0 : -1 / 8.0, 4 / 8.0,
                                      random.below(2) != 0 ? 1.0 : -1.0};
            if (random.below(3) == 0) to = s.center;
            break;
        }
        case 5:
            from = s.center + random.vector() * (0.57 * s.radius);
            break;
        case 6: {
            s.radius = std::exp2(-random.uniform(8, 20));
            from = from * std::exp2(random.uniform(0, 16));
            to = s.center + random.vector() * (1.5 * s.radius);
            break;
        }
        default: {
            s.radius = std::exp2(random.uniform(5, 30));
            s.center = Vector3{0, -s.radius, 0} + random.vector();
            break;
        }
    }
    return {ray_through(random, from, to), {random.placed(s.center), random.placed(s.radius)}};
}

/// The image of a sphere case under a linear map with a given spread of its axes.
struct EllipsoidCase {
    ExactRay ray;
    Ellipsoid ellipsoid;
};
inline EllipsoidCase ellipsoid_case(Random& random, int kind) {
    SphereCase c = sphere_case(random, kind);
    Matrix3 m;
    switch (random.below(4)) {
        case 0:
            for (int i = 0; i < 3; ++i) m.row[i][i] = std::exp2(random.below(9) - 4);
            break;
        case 1:
            m = Matrix3{{random.vector(), random.vector(), random.vector()}};
            break;
        case 2: {
            Matrix3 flat;
            flat.row[random.below(3)] *= std::exp2(-random.below(40));
            m = nuvo::rotation(random.vector(), 1) * flat;
            break;
        }
        default:
            m.row[0][0] = -1;
            break;
    }
    const Point3 o = m * c.ray.origin();
    const Vector3 d = m * c.ray.direction();
    const ExactRay ray = random.below(2) != 0 ? ExactRay(Ray{o, d}) : ExactRay::between(o, o + d);
    return {ray, {m * c.sphere.center, m, c.sphere.radius}};
}

}  // namespace cases
