#pragma once

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/exact.h"
#include "rows.h"

/// The last stage: the definitions, written in exact arithmetic. Internal to the predicates.
namespace nuvo::detail {

inline bool is_corner(const Point3& p, const Triangle& t) {
    return p == t.a || p == t.b || p == t.c;
}

inline ExactVector exact_direction(const ExactRay& ray) {
    return ExactVector(ray.direction()) + ExactVector(ray.tail());
}

/// t = numerator / denominator where the line meets the triangle's plane: n.(a - o) / n.d.
struct ExactPlaneRoot {
    ExactVector normal;  ///< n = (b - a) x (c - a)
    Exact numerator;
    Exact denominator;
};
ExactPlaneRoot exact_plane_root(const ExactRay& ray, const Triangle& triangle);

/// a t^2 + 2 b t + c = |f + t g|^2 - r2, with a >= 0.
struct ExactQuadratic {
    ExactVector f;
    ExactVector g;
    Exact a;
    Exact b;
    Exact c;
    bool empty;  ///< the surface has no volume

    Exact discriminant() const { return b * b - a * c; }
};
/// f = o - centre, g = d.
ExactQuadratic exact_quadratic(const ExactRay& ray, const Sphere& sphere);

using ExactMatrix = Rows<Exact>;
inline ExactMatrix exact_adjugate(const Matrix3& m) {
    return adjugate_of(ExactVector(m.row[0]), ExactVector(m.row[1]), ExactVector(m.row[2]));
}
/// f = adj(M) (o - centre), g = adj(M) d, r2 = (det(M) R)^2.
ExactQuadratic exact_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid,
                               const ExactMatrix& adjugate);
inline ExactQuadratic exact_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid) {
    return exact_quadratic(ray, ellipsoid, exact_adjugate(ellipsoid.linear));
}

/// What a change of the origin by `origin_error` per component can add to |c|.
Exact exact_touch_band(const ExactQuadratic& q, const Sphere& sphere, double origin_error);
Exact exact_touch_band(const ExactQuadratic& q, const Ellipsoid& ellipsoid, double origin_error);

std::optional<SphereHit> exact_hit(const ExactQuadratic& q, Sides sides);
/// What the origin has to do with the surface: it stands for a point of it, it may, or it does not.
enum class OriginPlace : std::uint8_t { kOnIt, kTouching, kClear };
/// `touch_band()`: what the origin's error can add to |c|.
template <typename TouchBand>
OriginPlace origin_place(const ExactQuadratic& q, bool on_it, TouchBand&& touch_band) {
    if (on_it) return OriginPlace::kOnIt;
    return compare(abs(q.c), touch_band()) <= 0 ? OriginPlace::kTouching : OriginPlace::kClear;
}
bool exact_blocks(const ExactQuadratic& q, double end, OriginPlace place, Sides sides);
/// p + t r at the root, to a few roundoffs of p's and r's shares (p - b / a r and sqrt(D) / a r).
Vec3<WideDouble> at_root(const ExactQuadratic& q, SphereRoot which, const ExactVector& p,
                         const ExactVector& r);
/// Unit vector along v, whose components may be of any magnitude.
Vector3 unit(const Vec3<WideDouble>& v);

/// The interval of a t that is known within a few roundings.
Root root_from(const WideDouble& t);

}  // namespace nuvo::detail
