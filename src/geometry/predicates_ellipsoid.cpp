#include "predicates_quadratic.h"

namespace nuvo {
namespace detail {
namespace {

/// det(M) R.
template <typename T>
inline Bounded<T> local_radius(const Ellipsoid& ellipsoid, const BoundedMatrix<T>& adjugate) {
    const Bounded<T> det = determinant(ellipsoid.linear, adjugate);
    const T radius = det.value * ellipsoid.radius;
    return {radius, det.error * ellipsoid.radius * (1 + gamma_of<T>(4)) +
                        gamma_of<T>(2) * std::fabs(radius) + underflow_of<T>()};
}
/// What the error of r adds to that of r^2.
template <typename T>
T square_error(const Bounded<T>& r) {
    return r.error * (2 * std::fabs(r.value) + r.error);
}

}  // namespace

template <typename T>
RoundedQuadratic<T> rounded_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid) {
    const BoundedMatrix<T> adjugate = bounded_adjugate<T>(ellipsoid.linear);
    const BoundedVector<T> f = product(adjugate, Vec3<T>(ray.origin()) - Vec3<T>(ellipsoid.center));
    const BoundedVector<T> g = product(adjugate, direction_of<T>(ray));
    const Bounded<T> radius = local_radius(ellipsoid, adjugate);
    RoundedQuadratic<T> q;
    q.f = f.value;
    q.g = g.value;
    q.a = dot(q.g, q.g);
    q.length = std::sqrt(q.a);
    const T g_relative = g.error / q.length * (1 + gamma_of<T>(8));
    q.a_relative = 2 * g_relative * (1 + g_relative) + gamma_of<T>(6);
    q.b = dot(q.f, q.g);
    const T s = q.b / q.a;
    q.l = q.f - q.g * s;
    const T ff = dot(q.f, q.f);
    const T rr = radius.value * radius.value;
    const T ll = dot(q.l, q.l);
    const T squares = ff + rr;
    q.f_norm = std::sqrt(ff);
    const T l_norm = std::sqrt(ll);
    const T rr_error = square_error(radius);
    q.b_error =
        (q.f_norm * g.error + q.length * f.error + f.error * g.error) * (1 + gamma_of<T>(16)) +
        gamma_of<T>(6) * q.f_norm * q.length;
    q.c = ff - rr;
    q.c_error = (f.error * (2 * q.f_norm + f.error) + rr_error) * (1 + gamma_of<T>(16)) +
                gamma_of<T>(6) * squares;
    q.depth = rr - ll;
    // Across g: f's error, s times g's, and the roundings of s g and of the difference. Along g:
    // besides, the error of s; it counts by its square only. [numerics: depth bound]
    const T across = (f.error + std::fabs(s) * g.error) * (1 + gamma_of<T>(16)) +
                     gamma_of<T>(4) * (q.f_norm + l_norm);
    const T along =
        across + q.b_error / q.length + q.f_norm * (q.a_relative + g_relative + gamma_of<T>(4));
    q.offset_error = across + along;
    q.depth_error = 2 * l_norm * across + 4 * along * along + rr_error + gamma_of<T>(8) * (ll + rr);
    const bool in_range = kBoundless<T> ? rr > 0 && q.a > 0
                                        : squares > kSmallestSquare && squares < kLargestSquare &&
                                              q.a > 0x1p-800 && q.a < 0x1p800;
    if (!(in_range && g_relative < 0.0625)) q.decide_nothing();
    return q;
}
template RoundedQuadratic<double> rounded_quadratic(const ExactRay&, const Ellipsoid&);
template RoundedQuadratic<long double> rounded_quadratic(const ExactRay&, const Ellipsoid&);

template <typename T>
Bounded<T> rounded_touch_band(const RoundedQuadratic<T>& q, const Ellipsoid& ellipsoid,
                              double origin_error) {
    const BoundedMatrix<T> adjugate = bounded_adjugate<T>(ellipsoid.linear);
    const Vec3<T> rho{norm1(adjugate.value.row[0]), norm1(adjugate.value.row[1]),
                      norm1(adjugate.value.row[2])};
    const T size = sum(adjugate.magnitude.row[0]) + sum(adjugate.magnitude.row[1]) +
                   sum(adjugate.magnitude.row[2]);
    // rho is known within gamma(8) of its bound, f within its part of c's.
    return {origin_error * (2 * dot(rho, magnitude(q.f)) + origin_error * dot(rho, rho)),
            gamma_of<T>(32) * origin_error * size * (norm1(q.f) + origin_error * size) +
                2 * origin_error * size * q.offset_error};
}
template Bounded<double> rounded_touch_band(const RoundedQuadratic<double>&, const Ellipsoid&,
                                            double);
template Bounded<long double> rounded_touch_band(const RoundedQuadratic<long double>&,
                                                 const Ellipsoid&, double);

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

using detail::Bounded;
using detail::BoundedMatrix;

/// The point is o + t d itself: both shares lie within the ellipsoid's reach of its centre.
SurfacePoint exact_surface_point(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which,
                                 double reach) {
    const detail::ExactMatrix adjugate = detail::exact_adjugate(ellipsoid.linear);
    const detail::ExactQuadratic q = detail::exact_quadratic(ray, ellipsoid, adjugate);
    const Vec3<WideDouble> point =
        detail::at_root(q, which, ExactVector(ray.origin()), detail::exact_direction(ray));
    SurfacePoint result;
    result.point = {point.x.rounded(), point.y.rounded(), point.z.rounded()};
    result.error = gamma(16) * (max_norm(ellipsoid.center) + 2 * reach) + kUnderflow;
    const detail::ExactMatrix gradient = adjugate.transposed();
    result.normal = detail::unit(detail::at_root(q, which, gradient * q.f, gradient * q.g));
    return result;
}

/// The error of m v, v known within a roundoff, in each component. [numerics: ellipsoids]
template <typename T>
Vec3<T> component_errors(const BoundedMatrix<T>& m, const Vec3<T>& v) {
    const Vec3<T> size = magnitude(v);
    const T tiny = 64 * detail::underflow_of<T>() * (detail::sum(size) + 1);
    return m.magnitude * size * detail::gamma_of<T>(8) + Vec3<T>(tiny, tiny, tiny);
}

/// o + t d, whatever t is, with what |F + t G|^2 - r^2 leaves over its slope as the bound of how
/// far the root is; if T keeps the bounds that are promised. [numerics: points along the ray]
template <typename T>
bool try_along_ray(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which, double reach,
                   SurfacePoint& result) {
    constexpr T kUp = 1 + detail::gamma_of<T>(16);
    const BoundedMatrix<T> adjugate = detail::bounded_adjugate<T>(ellipsoid.linear);
    const Vec3<T> o(ray.origin());
    const Vec3<T> d = detail::direction_of<T>(ray);
    const detail::RoundedQuadratic<T> q = detail::rounded_quadratic<T>(ray, ellipsoid);
    const T side = std::sqrt(q.depth) / q.length;
    const T t = (which == SphereRoot::kNear ? -side : side) - q.b / q.a;
    const Vec3<T> way = q.g * t;
    const Vec3<T> local = q.f + way;
    const Vec3<T> g_error = component_errors(adjugate, d);
    const Vec3<T> local_error = component_errors(adjugate, o - Vec3<T>(ellipsoid.center)) +
                                g_error * std::fabs(t) +
                                (magnitude(q.f) + magnitude(way)) * detail::gamma_of<T>(4);
    const Bounded<T> r = detail::local_radius(ellipsoid, adjugate);
    const T square = dot(local, local);
    const T rr = r.value * r.value;
    const T size_change = 2 * dot(magnitude(local), local_error) + dot(local_error, local_error);
    const T residual = std::fabs(square - rr) + (size_change + detail::square_error(r)) * kUp +
                       detail::gamma_of<T>(8) * (square + rr) + 16 * detail::underflow_of<T>();
    const T slope = dot(local, q.g);
    const T steep =
        std::fabs(slope) -
        (dot(magnitude(local), g_error) + dot(local_error, magnitude(q.g) + g_error)) * kUp -
        detail::gamma_of<T>(8) * dot(magnitude(local), magnitude(q.g)) -
        8 * detail::underflow_of<T>();
    const T off = residual / steep + detail::underflow_of<T>();
    result.point = Point3(o + d * t);
    const T error = max_norm(d) * off * kUp +
                    detail::gamma_of<T>(6) * (max_norm(o) + max_norm(d) * std::fabs(t));
    result.error = static_cast<double>(error) * (1 + gamma(4)) + gamma(2) * max_norm(result.point) +
                   kUnderflow;
    // The normal is adj(M)^T F + t adj(M)^T G.
    const detail::Rows<T> gradient = adjugate.value.transposed();
    const Vec3<T> normal = gradient * local;
    const Vec3<T> local_change =
        (local_error + magnitude(q.g) * off) * kUp + magnitude(local) * detail::gamma_of<T>(8);
    const T normal_error = detail::sum(adjugate.magnitude.transposed() * local_change) +
                           64 * detail::underflow_of<T>();
    const T normal_size = norm1(normal);
    result.normal = Vector3(normalized(normal));
    constexpr double kOfNormal = 128 * surface_tolerance();
    return q.b_error >= 0 && (slope < 0) == (which == SphereRoot::kNear) && steep > 0 &&
           2 * q.a * off <= steep &&
           result.error < surface_tolerance() * (max_norm(ellipsoid.center) + reach) &&
           normal_error < kOfNormal * normal_size && std::isfinite(normal_size);
}

[[gnu::cold, gnu::noinline]] SurfacePoint slow_surface_point(const ExactRay& ray,
                                                             const Ellipsoid& ellipsoid,
                                                             SphereRoot which, double reach) {
    SurfacePoint result;
    if (try_along_ray<double>(ray, ellipsoid, which, reach, result)) return result;
    if constexpr (detail::kLongDoubleIsWider)
        if (try_along_ray<long double>(ray, ellipsoid, which, reach, result)) return result;
    return exact_surface_point(ray, ellipsoid, which, reach);
}

}  // namespace

SurfacePoint surface_point(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which) {
    using namespace detail;
    const Matrix3& m = ellipsoid.linear;
    const RoundedQuadratic<double> q = rounded_quadratic(ray, ellipsoid);
    const RoundedOffset<double> rounded = rounded_offset(q, which);
    const BoundedMatrix<double> adjugate = bounded_adjugate<double>(m);
    const double determinant = dot(m.row[0], adjugate.value.column(0));
    const double shape = dot(magnitude(m.row[0]), adjugate.magnitude.column(0));
    const double reach =
        max_norm(Vector3{norm1(m.row[0]), norm1(m.row[1]), norm1(m.row[2])}) * ellipsoid.radius;
    const double relative = rounded.error / (std::fabs(determinant) * ellipsoid.radius);
    const double half_the_digits = std::sqrt(kUnitRoundoff);
    // Well shaped: the determinant's sign, and half its digits, are known.
    if (!(std::fabs(determinant) > half_the_digits * shape && relative < half_the_digits &&
          relative * reach < surface_tolerance() * (max_norm(ellipsoid.center) + reach)))
        return slow_surface_point(ray, ellipsoid, which, reach);
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
