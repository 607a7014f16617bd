#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "nuvo/geometry/ellipsoid.h"
#include "nuvo/geometry/sphere.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/ray.h"

/// Filtered exact predicates: what exact arithmetic on the doubles given would answer. The cheap
/// stage is here; what it does not decide goes to the .cpp files. Bounds are derived in
/// docs/numerics.md.
namespace nuvo {

/// The sign of n.(a - p), with n = (b - a) x (c - a), by exact arithmetic: on which side of the
/// triangle's plane p lies, or if `far` the point infinitely far away in the direction p.
int exact_side(const Triangle& triangle, const Vector3& p, bool far);

/// Exact answers that were given before. A plane through the eye or a light, and two triangles in
/// one plane, are asked about by every ray.
class SideMemo {
  public:
    /// The exact sign of n.(a - p), with n = (b - a) x (c - a) not zero: on which side of the
    /// triangle's plane p lies. `exact` counts the signs that exact arithmetic had to find.
    int side(const Triangle& triangle, const Point3& p, std::uint64_t& exact);
    /// The same for a point infinitely far away in the direction d.
    int side_along(const Triangle& triangle, const Vector3& d, std::uint64_t& exact);

    std::size_t memory_bytes() const { return vector_bytes(entries_); }

  private:
    struct Entry {
        Triangle triangle;
        Vector3 p;
        bool far;  // p is a direction
        int sign;
    };
    int kept_side(const Triangle& triangle, const Vector3& p, bool far, std::uint64_t& exact);

    std::vector<Entry> entries_;  // by a hash, the last one asked for; none before the first
};

/// For each edge of a triangle the normal of a plane through it, times a power of two: exact within
/// two roundoffs of each component; and for planes along a direction its product with the edge's
/// points, as exact and times the same power.
struct EdgePlanes {
    Vector3 normal[3];
    double offset[3] = {};
};

/// The planes through the edges and the point p, by exact arithmetic: for corners P, Q of an edge
/// the normal is (P - p) x (Q - p).
EdgePlanes edge_planes_through(const Triangle& triangle, const Point3& p);

/// Planes that many rays share, found by exact arithmetic the second time they are asked for: a
/// needle seen from the eye is open to every bound in every pixel.
class EdgeMemo {
  public:
    /// The planes through the edges and the point p, where a ray starts or ends; none: the first
    /// time.
    const EdgePlanes* through(const Triangle& triangle, const Point3& p);
    /// The planes through the edges along the ray's direction d: (Q - P) x d.
    const EdgePlanes* along(const Triangle& triangle, const Vector3& d);
    /// The same where they are known; does not count as asked for.
    const EdgePlanes* known_through(const Triangle& triangle, const Point3& p) const {
        return known(triangle, p, false);
    }
    const EdgePlanes* known_along(const Triangle& triangle, const Vector3& d) const {
        return known(triangle, d, true);
    }

    std::size_t memory_bytes() const { return vector_bytes(entries_); }

  private:
    struct Entry {
        Triangle triangle;
        Vector3 p;
        bool far;  // p is a direction
        bool used;
        bool found;
        EdgePlanes planes;

        bool is_for(const Triangle& t, const Vector3& q, bool is_far) const;
    };
    const EdgePlanes* find(const Triangle& triangle, const Vector3& p, bool far);
    const EdgePlanes* known(const Triangle& triangle, const Vector3& p, bool far) const;

    std::vector<Entry> entries_;  // by a hash, the last one asked for; none before the first
    std::size_t lost_ = 0;        // planes that gave way to others
};

/// Counts how often the cheap stage did not decide, and keeps what cost most to find.
struct StageCounts {
    std::uint64_t wider = 0;  ///< tighter bounds were computed, in double or in 64 bits
    std::uint64_t exact = 0;  ///< exact arithmetic decided
    SideMemo sides;
    EdgeMemo edges;

    std::size_t memory_bytes() const { return sides.memory_bytes() + edges.memory_bytes(); }
};

namespace detail {

/// The error of d . (C x B) where |d| <= d_norm and |B|, |C| <= norm (largest components):
/// 6 products of 8 roundings each (difference B, difference C, tail of d, 3 products, 2 sums), and
/// what underflow adds. Not finite where a product could overflow. [numerics: edge bound]
inline double edge_error_bound(double d_norm, double norm) {
    constexpr double kHeadroom = 16;  // > 6: no partial sum overflows where this product does not
    const double scaled = (kHeadroom * norm * norm + kHeadroom * kUnderflow / gamma(8)) * d_norm;
    // Products of d and C that underflow are multiplied with B.
    return (6 * gamma(9) / kHeadroom) * scaled + (16 * kUnderflow) * (norm + 1);
}

}  // namespace detail

/// origin + t * d, where d = direction + tail exactly; prepared for many tests. All coordinates and
/// their differences are finite.
class ExactRay {
  public:
    /// A ray against any primitives. Slower: every triangle needs a bound of its own.
    explicit ExactRay(const Ray& ray) : ExactRay(ray.origin, ray.direction, {}, kUnknown) {}
    /// A ray against triangles that all lie within `scene`: their bound is the ray's.
    ExactRay(const Ray& ray, const Bounds3& scene)
        : ExactRay(ray.origin, ray.direction, {}, reach(ray.origin, scene)) {}

    /// The ray with t = 0 at `from` and t = 1 at `to`, exactly.
    static ExactRay between(const Point3& from, const Point3& to) {
        return between_within(from, to, kUnknown);
    }
    static ExactRay between(const Point3& from, const Point3& to, const Bounds3& scene) {
        return between_within(from, to, reach(from, scene));
    }

    const Point3& origin() const { return origin_; }
    const Vector3& direction() const { return direction_; }
    const Vector3& tail() const { return tail_; }
    /// Largest |component| of direction().
    double norm() const { return norm_; }
    /// Bounds the error of the edge functions of every triangle of the scene; else infinite or NaN.
    double edge_error() const { return edge_error_; }
    /// |d|, |d|^2 and its inverse, in double; NaN where a square could leave the range.
    double length() const { return length_; }
    double square() const { return square_; }
    double inverse_square() const { return inverse_square_; }

  private:
    static constexpr double kUnknown = std::numeric_limits<double>::infinity();

    static ExactRay between_within(const Point3& from, const Point3& to, double reach) {
        const TwoTerms x = two_diff(to.x, from.x);
        const TwoTerms y = two_diff(to.y, from.y);
        const TwoTerms z = two_diff(to.z, from.z);
        return {from, {x.value, y.value, z.value}, {x.error, y.error, z.error}, reach};
    }
    /// Largest |component| that a rounded difference of a point of `scene` and `origin` can have.
    static double reach(const Point3& origin, const Bounds3& scene) {
        const double low = max_norm(scene.min - origin);
        const double high = max_norm(scene.max - origin);
        return low > high ? low : high;
    }
    ExactRay(const Point3& origin, const Vector3& direction, const Vector3& tail, double reach)
        : origin_(origin),
          direction_(direction),
          tail_(tail),
          norm_(max_norm(direction)),
          edge_error_(detail::edge_error_bound(norm_, reach)),
          square_(dot(direction, direction)) {
        constexpr double kRange = 0x1p800;  // [numerics: ranges]
        if (!(square_ > 1 / kRange && square_ < kRange))
            square_ = std::numeric_limits<double>::quiet_NaN();
        length_ = std::sqrt(square_);
        inverse_square_ = 1 / square_;
    }

    Point3 origin_;
    Vector3 direction_;
    Vector3 tail_;
    double norm_;
    double edge_error_;
    double square_;
    double length_;
    double inverse_square_;
};

/// Which sides of a surface are there: the back of a solid one is invisible, to the camera as to a
/// light. A ray meets a front where n.d < 0, n pointing outwards or to the side on which the
/// corners run counterclockwise; what comes from a light runs against the direction of the shadow
/// ray.
enum class Sides : std::uint8_t { kBoth, kFront };

/// A hit's parameter: the true one lies in [low, high], and t within root_tolerance() of it.
struct Root {
    double t;
    double low;
    double high;
};

/// Which of the two roots, in the order of t.
enum class SphereRoot : std::uint8_t { kNear, kFar };

struct SphereHit {
    Root root;
    SphereRoot which;
};

/// A primitive with the root that was hit (for a triangle `which` means nothing).
struct HitPrimitive {
    std::variant<const Triangle*, const Sphere*, const Ellipsoid*> primitive;
    SphereRoot which = SphereRoot::kNear;
};

/// Where a ray meets a primitive; a function of the two alone.
struct SurfacePoint {
    Point3 point;
    double error;    ///< bounds |point - true point| in each component
    Vector3 normal;  ///< geometric, unit; outwards, or the side the corners run counterclockwise on
    Vec2<double> uv;  ///< triangle: weights of b and c [eq. 46], in [0, 1]; else 0
};

namespace detail {

/// Whether the line has exactly one point in common with the triangle.
enum class LineTest : std::uint8_t { kMisses, kMeets };

/// Which crossings of a triangle count: all, those with n.d < 0, or those with n.d > 0.
enum class Crossing : std::uint8_t { kAny, kIn, kOut };
/// Of those sides: by a ray that sees them, and by one that runs towards a light.
constexpr Crossing seen(Sides sides) { return static_cast<Crossing>(sides); }
constexpr Crossing towards(Sides sides) {
    return sides == Sides::kBoth ? Crossing::kAny : Crossing::kOut;
}
static_assert(seen(Sides::kBoth) == Crossing::kAny && seen(Sides::kFront) == Crossing::kIn);

/// The line test where the ray's own bound does not decide, or where it has none. It may also say
/// that the line misses where it meets the triangle at t = 0, or at t = `end` = 1.
LineTest line_test_alone(const ExactRay& ray, double end, const Triangle& triangle,
                         Crossing crossing, StageCounts& counts);

/// The edge functions add up to -n.d, so that their common sign tells which way the line crosses.
inline LineTest line_test(const ExactRay& ray, double end, const Triangle& triangle,
                          Crossing crossing, StageCounts& counts) {
    const double error = ray.edge_error();
    const Vector3 a = triangle.a - ray.origin();
    const Vector3 b = triangle.b - ray.origin();
    const Vector3 c = triangle.c - ray.origin();
    const Vector3 q = cross(ray.direction(), c);
    // The one sign that does not count is treated as if its opposite had been found.
    const double u = dot(b, q);  // d . (c x b)
    bool positive = crossing == Crossing::kIn || u > error;
    bool negative = crossing == Crossing::kOut || u < -error;
    if (positive && negative) return LineTest::kMisses;
    const double v = -dot(a, q);  // d . (a x c)
    positive = positive || v > error;
    negative = negative || v < -error;
    if (positive && negative) return LineTest::kMisses;
    const double w = dot(ray.direction(), cross(b, a));
    positive = positive || w > error;
    negative = negative || w < -error;
    if (positive && negative) return LineTest::kMisses;
    if ((u > error && v > error && w > error) || (u < -error && v < -error && w < -error))
        return LineTest::kMeets;
    return line_test_alone(ray, end, triangle, crossing, counts);
}

/// The magnitudes within which the squares and products of the sphere's stage neither overflow nor
/// lose more to underflow than their bounds allow. [numerics: ranges]
inline constexpr double kSmallestSquare = 0x1p-900;
inline constexpr double kLargestSquare = 0x1p900;

/// Bounds the error of b^2 - a c: 32 u a (|f|^2 + R^2), and what the products lose to underflow.
/// [numerics: discriminant bound]
inline double discriminant_error_bound(double a, double squares) {
    return gamma(32) * a * squares + 4 * kUnderflow;
}
/// Bounds the error of |f|^2 - R^2.
inline double power_error_bound(double squares) { return gamma(8) * squares; }

/// The line surely misses the sphere, or the ray surely starts outside and runs away.
inline bool surely_missed(const ExactRay& ray, const Sphere& sphere) {
    const Vector3 f = ray.origin() - sphere.center;
    const double b = dot(f, ray.direction());
    const double ff = dot(f, f);
    const double rr = sphere.radius * sphere.radius;
    const double squares = ff + rr;
    const double c = ff - rr;
    const double bb = b * b;
    const double error = discriminant_error_bound(ray.square(), squares);
    if (!(squares > kSmallestSquare)) return false;
    return bb - ray.square() * c < -error ||
           (b > 0 && bb > error && c > power_error_bound(squares));
}
/// The same, and the origin is surely further than `origin_error` (per component) from the surface.
inline bool surely_clear(const ExactRay& ray, const Sphere& sphere, double origin_error) {
    if (!surely_missed(ray, sphere)) return false;
    const Vector3 f = ray.origin() - sphere.center;
    const double ff = dot(f, f);
    const double rr = sphere.radius * sphere.radius;
    const double norm1 = std::fabs(f.x) + std::fabs(f.y) + std::fabs(f.z);
    const double band = origin_error * (2 * norm1 + 3 * origin_error) * (1 + gamma(8));
    return ff - rr > power_error_bound(ff + rr) + band;
}

/// Outside of these the rounding of t itself may be subnormal or overflow.
inline constexpr double kSmallestRoot = 0x1p-1000;
inline constexpr double kLargestRoot = 0x1p1000;

/// For a line that meets the triangle.
std::optional<Root> triangle_hit(const ExactRay&, const Triangle&, StageCounts&);
std::optional<SphereHit> sphere_hit(const ExactRay&, const Sphere&, Sides, StageCounts&);
bool triangle_blocks(const ExactRay&, double end, double origin_error, const Triangle&,
                     StageCounts&);
bool sphere_blocks(const ExactRay&, double end, double origin_error, const Sphere&,
                   bool origin_on_it, Sides, StageCounts&);

}  // namespace detail

/// The relative error that every Root keeps, also at tangency: 2^-44.
constexpr double root_tolerance() { return 512 * kUnitRoundoff; }
/// What a SurfacePoint's error may reach, relative to the primitive's coordinates: 2^-41. It is
/// usually far less; beyond this the point is computed anew, more precisely.
constexpr double surface_tolerance() { return 8 * root_tolerance(); }

/// The hit at t > 0. Edges and vertices belong to the triangle; a ray within its plane, and a
/// triangle without area, are never hit.
inline std::optional<Root> hit(const ExactRay& ray, const Triangle& triangle, StageCounts& counts,
                               Sides sides = Sides::kBoth) {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const detail::LineTest test =
        detail::line_test(ray, kEndless, triangle, detail::seen(sides), counts);
    if (test == detail::LineTest::kMisses) return std::nullopt;
    return detail::triangle_hit(ray, triangle, counts);
}

/// The smallest root > 0, tangency included; of a front only the near root, which is the double one
/// at tangency, too. Without radius never hit.
inline std::optional<SphereHit> hit(const ExactRay& ray, const Sphere& sphere, StageCounts& counts,
                                    Sides sides = Sides::kBoth) {
    if (detail::surely_missed(ray, sphere)) return std::nullopt;
    return detail::sphere_hit(ray, sphere, sides, counts);
}
std::optional<SphereHit> hit(const ExactRay& ray, const Ellipsoid& ellipsoid, StageCounts& counts,
                             Sides sides = Sides::kBoth);

/// The exact sign of t_a - t_b for two hits of `ray`.
int compare_roots(const ExactRay& ray, const HitPrimitive& a, const HitPrimitive& b,
                  StageCounts& counts);

/// Where the line of `ray` meets the primitive, which hit() has confirmed.
SurfacePoint surface_point(const ExactRay& ray, const Triangle& triangle);
SurfacePoint surface_point(const ExactRay& ray, const Sphere& sphere, SphereRoot which);
SurfacePoint surface_point(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which);

/// Whether the primitive blocks the way of `shadow` for 0 < t < end (infinity for a direction).
/// The origin stands for a lit point up to `origin_error` per component (>= 0); a surface that may
/// pass through the lit point (a triangle's plane; a sphere's or ellipsoid's surface;
/// `origin_on_it` says that it does) touches it. A touching triangle blocks nothing; a touching
/// sphere blocks iff the way enters it and ends outside: a light on its surface, too, only touches
/// it. Everything else is decided exactly. Of a front only what is turned to the light blocks:
/// where the way leaves a solid.
inline bool blocks(const ExactRay& shadow, double end, double origin_error,
                   const Triangle& triangle, StageCounts& counts, Sides sides = Sides::kBoth) {
    const detail::LineTest test =
        detail::line_test(shadow, end, triangle, detail::towards(sides), counts);
    if (test == detail::LineTest::kMisses) return false;
    return detail::triangle_blocks(shadow, end, origin_error, triangle, counts);
}
inline bool blocks(const ExactRay& shadow, double end, double origin_error, const Sphere& sphere,
                   bool origin_on_it, StageCounts& counts, Sides sides = Sides::kBoth) {
    if (!origin_on_it && detail::surely_clear(shadow, sphere, origin_error)) return false;
    return detail::sphere_blocks(shadow, end, origin_error, sphere, origin_on_it, sides, counts);
}
bool blocks(const ExactRay& shadow, double end, double origin_error, const Ellipsoid& ellipsoid,
            bool origin_on_it, StageCounts& counts, Sides sides = Sides::kBoth);

/// Whether the corners of `b` lie in the plane of `a`: every ray that meets both does so at one t.
bool coplanar(const Triangle& a, const Triangle& b, StageCounts& counts);

/// No ray from `eye` that meets both triangles meets `other` before `front`, nor, unless `front`
/// wins where they are met together, at the same t. False: not known.
bool hides(const Triangle& front, const Point3& eye, const Triangle& other, bool wins_ties,
           StageCounts& counts);
/// Where a light is.
struct LightPlace {
    Vector3 at;    ///< a point; endless: the direction to the light
    bool endless;  ///< infinitely far away
};
/// `other` blocks no way from a rounded point of `lit` to the light: it leaves all of `lit` on the
/// light's side. False: not known.
bool leaves_in_light(const Triangle& other, const Triangle& lit, const LightPlace& light,
                     StageCounts& counts);
/// `other` blocks no way from a true point of `lit` to the light, because it has no part on the
/// light's side of the plane of `lit`, in which the light does not lie.
bool stays_behind(const Triangle& other, const Triangle& lit, const LightPlace& light,
                  StageCounts& counts);

/// Whether a light that is `distance` away (largest component; of a direction its own) from the
/// points of `lit` grazes its plane: ways rise by at most a millionth of their length. Computed in
/// double, on the scaled normal.
bool grazes(const Triangle& lit, const LightPlace& light, double distance);

/// Where ways from a lit point start.
struct WayStart {
    Point3 point;
    double error;  ///< bounds |point - true point| in each component
};
/// Starts of the ways from a rounded point of `lit` to the light: the point itself, but where the
/// light grazes the plane of `lit`. There the way runs along the plane, and on which side would be
/// the rounding's choice: it starts on the light's side; on both if the light lies in the plane, in
/// which a way meets the edges of all that ends there. What one of them meets blocks.
struct WayStarts {
    WayStart first;
    std::optional<WayStart> second;
};
WayStarts way_starts(const WayStart& rounded, const Triangle& lit, const LightPlace& light,
                     StageCounts& counts);

}  // namespace nuvo
