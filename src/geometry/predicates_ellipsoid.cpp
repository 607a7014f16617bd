#include "predicates_bounded.h"
#include "predicates_quadratic.h"

namespace nuvo {
namespace detail {

RoundedQuadratic rounded_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid) {
    const BoundedMatrix adjugate = bounded_adjugate(ellipsoid.linear);
    const BoundedVector f = product(adjugate, ray.origin() - ellipsoid.center);
    const BoundedVector g = product(adjugate, ray.direction());
    const Bounded<double> det = determinant(ellipsoid.linear, adjugate);
    const double radius = det.value * ellipsoid.radius;
    const double radius_error =
        det.error * ellipsoid.radius * (1 + gamma(4)) + gamma(2) * std::fabs(radius) + kUnderflow;
    RoundedQuadratic q;
    q.f = f.value;
    q.g = g.value;
    q.a = dot(q.g, q.g);
    q.length = std::sqrt(q.a);
    const double g_relative = g.error / q.length * (1 + gamma(8));
    q.a_relative = 2 * g_relative * (1 + g_relative) + gamma(6);
    q.b = dot(q.f, q.g);
    const double s = q.b / q.a;
    q.l = q.f - q.g * s;
    const double ff = dot(q.f, q.f);
    const double rr = radius * radius;
    const double ll = dot(q.l, q.l);
    const double squares = ff + rr;
    q.f_norm = std::sqrt(ff);
    const double l_norm = std::sqrt(ll);
    const double rr_error = radius_error * (2 * std::fabs(radius) + radius_error);
    q.b_error = (q.f_norm * g.error + q.length * f.error + f.error * g.error) * (1 + gamma(16)) +
                gamma(6) * q.f_norm * q.length;
    q.c = ff - rr;
    q.c_error =
        (f.error * (2 * q.f_norm + f.error) + rr_error) * (1 + gamma(16)) + gamma(6) * squares;
    q.depth = rr - ll;
    // Across g: f's error, s times g's, and the roundings of s g and of the difference. Along g:
    // besides, the error of s; it counts by its square only. [numerics: depth bound]
    const double across =
        (f.error + std::fabs(s) * g.error) * (1 + gamma(16)) + gamma(4) * (q.f_norm + l_norm);
    const double along =
        across + q.b_error / q.length + q.f_norm * (q.a_relative + g_relative + gamma(4));
    q.offset_error = across + along;
    q.depth_error = 2 * l_norm * across + 4 * along * along + rr_error + gamma(8) * (ll + rr);
    const bool in_range = squares > kSmallestSquare && squares < kLargestSquare && q.a > 0x1p-800 &&
                          q.a < 0x1p800 && g_relative < 0.0625;
    if (!in_range) {
        q.b_error = q.c_error = q.depth_error = std::numeric_limits<double>::quiet_NaN();
        q.offset_error = q.b_error;
    }
    return q;
}

Bounded<double> rounded_touch_band(const RoundedQuadratic& q, const Ellipsoid& ellipsoid,
                                   double origin_error) {
    const BoundedMatrix adjugate = bounded_adjugate(ellipsoid.linear);
    const Vector3 rho{norm1(adjugate.value.row[0]), norm1(adjugate.value.row[1]),
                      norm1(adjugate.value.row[2])};
    const double size = sum(adjugate.magnitude.row[0]) + sum(adjugate.magnitude.row[1]) +
                        sum(adjugate.magnitude.row[2]);
    // rho is known within gamma(8) of its bound, f within its part of c's.
    return {origin_error * (2 * dot(rho, magnitude(q.f)) + origin_error * dot(rho, rho)),
            gamma(32) * origin_error * size * (norm1(q.f) + origin_error * size) +
                2 * origin_error * size * q.offset_error};
}

}  // namespace detail

std::optional<SphereHit> hit(const ExactRay& ray, const Ellipsoid& ellipsoid, StageCounts& counts,
                             Sides sides) {
    return detail::quadric_hit(ray, ellipsoid, sides, counts);
}

bool blocks(const ExactRay& shadow, double end, double origin_error, const Ellipsoid& ellipsoid,
            bool origin_on_it, StageCounts& counts, Sides sides) {
    return detail::quadric_blocks(shadow, end, origin_error, ellipsoid, origin_on_it, sides,
                                  counts);
}

namespace {

/// The point is o + t d itself: both shares lie within the ellipsoid's reach of its centre.
[[gnu::cold, gnu::noinline]] SurfacePoint exact_surface_point(const ExactRay& ray,
                                                              const Ellipsoid& ellipsoid,
                                                              SphereRoot which, double reach) {
    const detail::ExactQuadratic q = detail::exact_quadratic(ray, ellipsoid);
    const Vec3<WideDouble> point =
        detail::at_root(q, which, ExactVector(ray.origin()), detail::exact_direction(ray));
    SurfacePoint result;
    result.point = {point.x.rounded(), point.y.rounded(), point.z.rounded()};
    result.error = gamma(16) * (max_norm(ellipsoid.center) + 2 * reach) + kUnderflow;
    result.normal = detail::unit(detail::at_root(q, which, detail::exact_gradient(ellipsoid, q.f),
                                                 detail::exact_gradient(ellipsoid, q.g)));
    return result;
}

}  // namespace

SurfacePoint surface_point(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which) {
    using namespace detail;
    const Matrix3& m = ellipsoid.linear;
    const RoundedQuadratic q = rounded_quadratic(ray, ellipsoid);
    const RoundedOffset rounded = rounded_offset(q, which);
    const BoundedMatrix adjugate = bounded_adjugate(m);
    const double determinant = dot(m.row[0], adjugate.value.column(0));
    const double shape = dot(magnitude(m.row[0]), adjugate.magnitude.column(0));
    const double reach =
        max_norm(Vector3{norm1(m.row[0]), norm1(m.row[1]), norm1(m.row[2])}) * ellipsoid.radius;
    const double relative = rounded.error / (std::fabs(determinant) * ellipsoid.radius);
    const double half_the_digits = std::sqrt(kUnitRoundoff);
    // Well shaped: the determinant's sign, and half its digits, are known.
    if (!(std::fabs(determinant) > half_the_digits * shape && relative < half_the_digits &&
          relative * reach < surface_tolerance() * (max_norm(ellipsoid.center) + reach)))
        return exact_surface_point(ray, ellipsoid, which, reach);
    const Vector3 unit = normalized(rounded.offset);
    SurfacePoint result;
    result.point =
        m * (unit * (determinant < 0 ? -ellipsoid.radius : ellipsoid.radius)) + ellipsoid.center;
    result.error = (relative + gamma(16)) * (1 + 16 * half_the_digits) * reach +
                   gamma(2) * max_norm(result.point) + kUnderflow;
    result.normal = normalized(adjugate.value.transposed() * unit);
    return result;
}

}  // namespace nuvo
