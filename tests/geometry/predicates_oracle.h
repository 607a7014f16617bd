#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <optional>

#include "nuvo/geometry/predicates.h"

/// The definitions of docs/numerics.md in rationals and 200-digit floats, sharing nothing with the
/// predicates but the types of the scene.
namespace oracle {

namespace mp = boost::multiprecision;
using Rational = mp::number<mp::cpp_rational_backend, mp::et_off>;
using Real = mp::number<mp::cpp_bin_float<200>, mp::et_off>;

template <typename T>
struct V {
    T x, y, z;
    friend V operator+(const V& a, const V& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend V operator-(const V& a, const V& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend V operator*(const V& a, const T& s) { return {a.x * s, a.y * s, a.z * s}; }
    friend T dot(const V& a, const V& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend V cross(const V& a, const V& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};
using RationalVector = V<Rational>;
using RealVector = V<Real>;

inline Rational rational(double v) { return Rational(v); }
inline RationalVector rational(const nuvo::Point3& p) {
    return {Rational(p.x), Rational(p.y), Rational(p.z)};
}
inline Real real(const Rational& r) { return Real(mp::numerator(r)) / Real(mp::denominator(r)); }
inline RealVector real(const RationalVector& v) { return {real(v.x), real(v.y), real(v.z)}; }

struct ExactLine {
    RationalVector o, d;
};
inline ExactLine line(const nuvo::ExactRay& ray) {
    return {rational(ray.origin()), rational(ray.direction()) + rational(ray.tail())};
}
inline ExactLine line(const nuvo::Point3& from, const nuvo::Point3& to) {
    return {rational(from), rational(to) - rational(from)};
}

/// Where a line meets a triangle: t and the weights of b and c, by Cramer's rule; nothing where it
/// lies in the plane or there is no plane.
struct PlaneHit {
    Rational t, u, v;
    bool inside() const { return u >= 0 && v >= 0 && u + v <= 1; }
};
inline std::optional<PlaneHit> plane_hit(const ExactLine& line, const nuvo::Triangle& triangle) {
    const RationalVector a = rational(triangle.a);
    const RationalVector e1 = rational(triangle.b) - a;
    const RationalVector e2 = rational(triangle.c) - a;
    const RationalVector p = cross(line.d, e2);
    const Rational determinant = dot(e1, p);
    if (determinant == 0) return std::nullopt;
    const RationalVector s = line.o - a;
    const RationalVector q = cross(s, e1);
    return PlaneHit{dot(e2, q) / determinant, dot(s, p) / determinant,
                    dot(line.d, q) / determinant};
}

/// A sphere seen by a line: |f + t g|^2 = r^2.
struct Ball {
    RationalVector f, g;
    Rational r2;
    RationalVector reach;  ///< the change of f per unit change of each coordinate of the origin
    Rational a() const { return dot(g, g); }
    Rational b() const { return dot(f, g); }
    Rational c() const { return dot(f, f) - r2; }
};
inline Ball ball(const ExactLine& line, const nuvo::Sphere& sphere) {
    const Rational r(sphere.radius);
    return {line.o - rational(sphere.center), line.d, r * r, {1, 1, 1}};
}
/// In the ellipsoid's own space, by the inverse of its matrix.
inline std::optional<Ball> ball(const ExactLine& line, const nuvo::Ellipsoid& ellipsoid) {
    const RationalVector m[3] = {rational(ellipsoid.linear.row[0]),
                                 rational(ellipsoid.linear.row[1]),
                                 rational(ellipsoid.linear.row[2])};
    const RationalVector columns[3] = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const Rational determinant = dot(m[0], columns[0]);
    if (determinant == 0) return std::nullopt;
    const Rational inverse = 1 / determinant;
    const auto local = [&](const RationalVector& v) {
        return (columns[0] * v.x + columns[1] * v.y + columns[2] * v.z) * inverse;
    };
    const auto magnitude = [&](auto member) {
        return abs(Rational(columns[0].*member * inverse)) +
               abs(Rational(columns[1].*member * inverse)) +
               abs(Rational(columns[2].*member * inverse));
    };
    const Rational r(ellipsoid.radius);
    return Ball{local(line.o - rational(ellipsoid.center)),
                local(line.d),
                r * r,
                {magnitude(&RationalVector::x), magnitude(&RationalVector::y),
                 magnitude(&RationalVector::z)}};
}

/// Both roots to 200 digits; a root of exactly 0 is exactly 0.
struct Roots {
    Real near, far;
    Rational discriminant;
};
inline std::optional<Roots> roots(const Ball& ball) {
    const Rational a = ball.a();
    const Rational b = ball.b();
    const Rational c = ball.c();
    if (a == 0 || ball.r2 == 0) return std::nullopt;
    const Rational discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    const Real root = sqrt(real(discriminant));
    // The larger in size first, the other from the product c / a: cancellation would cost digits.
    const Real large =
        b < 0 ? Real((-real(b) + root) / real(a)) : Real((-real(b) - root) / real(a));
    const Real small = large == 0 ? Real(0) : Real(real(c) / (real(a) * large));
    return b < 0 ? Roots{small, large, discriminant} : Roots{large, small, discriminant};
}

struct BallHit {
    Real t;
    nuvo::SphereRoot which;
};
inline std::optional<BallHit> first_hit(const std::optional<Ball>& ball) {
    if (!ball) return std::nullopt;
    const std::optional<Roots> found = roots(*ball);
    if (!found) return std::nullopt;
    if (found->near > 0) return BallHit{found->near, nuvo::SphereRoot::kNear};
    if (found->far > 0) return BallHit{found->far, nuvo::SphereRoot::kFar};
    return std::nullopt;
}

/// The sign of a - b, where 150 equal digits can only mean equality.
inline int order(const Real& a, const Real& b) {
    const Real difference = a - b;
    if (abs(difference) <= ldexp(Real(abs(a) + abs(b)), -500)) return 0;
    return difference < 0 ? -1 : 1;
}

/// Definition 4 with the lit point known up to `error` per component.
inline bool blocks(const ExactLine& line, double end, double error, const nuvo::Triangle& t) {
    const RationalVector a = rational(t.a);
    const RationalVector n = cross(rational(t.b) - a, rational(t.c) - a);
    const Rational distance = abs(Rational(dot(n, line.o - a)));
    const Rational norm = abs(n.x) + abs(n.y) + abs(n.z);
    if (distance <= Rational(error) * norm) return false;
    const std::optional<PlaneHit> hit = plane_hit(line, t);
    return hit && hit->inside() && hit->t > 0 && (std::isinf(end) || hit->t < Rational(end));
}
inline bool blocks(const std::optional<Ball>& ball, double end, double error, bool on_it) {
    if (!ball || ball->a() == 0 || ball->r2 == 0) return false;
    const auto before_end = [&](const Real& t) {
        return t > 0 && (std::isinf(end) || order(t, Real(end)) < 0);
    };
    const Rational e(error);
    const RationalVector& reach = ball->reach;
    const RationalVector size{abs(ball->f.x), abs(ball->f.y), abs(ball->f.z)};
    const Rational band = 2 * e * dot(reach, size) + e * e * dot(reach, reach);
    const std::optional<Roots> found = roots(*ball);
    if (on_it) {
        // From the lit point itself the other root is reached before the end iff b < 0 and the end
        // lies outside.
        if (ball->b() >= 0 || std::isinf(end)) return ball->b() < 0;
        const RationalVector last = ball->f + ball->g * Rational(end);
        return dot(last, last) > ball->r2;
    }
    // What touches blocks where the way leads inwards and, as it stands, comes out before the end.
    if (abs(ball->c()) <= band) return found && ball->b() < 0 && before_end(found->far);
    return found && (before_end(found->near) || before_end(found->far));
}

}  // namespace oracle
