#include "predicates_quadratic.h"
#include "rounding.h"

namespace nuvo {
namespace detail {
namespace {

/// |o - centre|^2 - R^2 by products and sums without errors, in pairs of doubles (Dot2, Ogita, Rump
/// and Oishi 2005); only the small parts are rounded, in T. [numerics: depth bound]
template <typename T>
Bounded<T> paired_power(const Point3& origin, const Sphere& sphere, T squares) {
    double high = -(sphere.radius * sphere.radius);
    T low = -static_cast<T>(std::fma(sphere.radius, sphere.radius, high));
    for (int i = 0; i < 3; ++i) {
        const TwoTerms f = two_diff(origin[i], sphere.center[i]);
        const double square = f.value * f.value;
        const double sum = high + square;
        low += static_cast<T>(sum_error(high, square, sum)) +
               static_cast<T>(std::fma(f.value, f.value, -square)) +
               static_cast<T>(f.error) * (2 * static_cast<T>(f.value) + static_cast<T>(f.error));
        high = sum;
    }
    const T value = static_cast<T>(high) + low;
    return {value, gamma_of<T>(2) * std::fabs(value) + gamma_of<T>(16) * gamma(8) * squares};
}

}  // namespace

template <typename T>
RoundedQuadratic<T> rounded_quadratic(const ExactRay& ray, const Sphere& sphere) {
    constexpr bool kIsDouble = std::is_same_v<T, double>;
    RoundedQuadratic<T> q;
    const T radius(sphere.radius);
    q.f = Vec3<T>(ray.origin()) - Vec3<T>(sphere.center);
    q.g = direction_of<T>(ray);
    q.a = kIsDouble ? static_cast<T>(ray.square()) : dot(q.g, q.g);
    q.a_relative = gamma_of<T>(6);
    q.length = kIsDouble ? static_cast<T>(ray.length()) : std::sqrt(q.a);
    q.b = dot(q.f, q.g);
    q.l = q.f - q.g * (q.b * (kIsDouble ? static_cast<T>(ray.inverse_square()) : 1 / q.a));
    const T ff = dot(q.f, q.f);
    const T rr = radius * radius;
    const T ll = dot(q.l, q.l);
    const T squares = ff + rr;
    q.f_norm = std::sqrt(ff);
    q.b_error = gamma_of<T>(7) * q.f_norm * q.length;
    q.c = ff - rr;
    q.c_error = gamma_of<T>(8) * squares;
    q.depth = rr - ll;
    // 6 u |l| |f| from f, the tail and s d; 4 u |l|^2 + 2 u R^2 from the squares; the part of the
    // error along d, at most 16 u |f|, counts by its square only. [numerics: depth bound]
    q.depth_error = gamma_of<T>(8) * std::sqrt(ll) * q.f_norm + gamma_of<T>(8) * (ll + rr) +
                    gamma_of<T>(16) * gamma_of<T>(32) * ff;
    q.offset_error = gamma_of<T>(20) * q.f_norm;
    const bool in_doubles = squares > kSmallestSquare && squares < kLargestSquare;
    if constexpr (!kIsDouble) {
        if (in_doubles) {
            const Bounded<T> power = paired_power(ray.origin(), sphere, squares);
            q.c = power.value;
            q.c_error = power.error;
        }
        if (!(q.a > 0)) q.decide_nothing();
    }
    if (!(in_doubles || (kBoundless<T> && rr > 0))) q.decide_nothing();
    return q;
}
template RoundedQuadratic<double> rounded_quadratic(const ExactRay&, const Sphere&);
template RoundedQuadratic<long double> rounded_quadratic(const ExactRay&, const Sphere&);

std::optional<SphereHit> sphere_hit(const ExactRay& ray, const Sphere& sphere, Sides sides,
                                    StageCounts& counts) {
    return quadric_hit(ray, sphere, sides, counts);
}

template <typename T>
Bounded<T> rounded_touch_band(const RoundedQuadratic<T>& q, const Sphere&, double origin_error) {
    const T band = origin_error * (2 * norm1(q.f) + 3 * static_cast<T>(origin_error));
    return {band, gamma_of<T>(8) * band};
}
template Bounded<double> rounded_touch_band(const RoundedQuadratic<double>&, const Sphere&, double);
template Bounded<long double> rounded_touch_band(const RoundedQuadratic<long double>&,
                                                 const Sphere&, double);

bool sphere_blocks(const ExactRay& shadow, double end, double origin_error, const Sphere& sphere,
                   bool origin_on_it, Sides sides, StageCounts& counts) {
    return quadric_blocks(shadow, end, origin_error, sphere, origin_on_it, sides, counts);
}

}  // namespace detail

namespace {

/// The point along `normal`, which is off by `error` times 1 / R besides its own roundings.
SurfacePoint point_along(const Sphere& sphere, const Vector3& normal, double error) {
    SurfacePoint result;
    result.normal = normal;
    result.point = sphere.center + result.normal * sphere.radius;
    result.error = (error + gamma(8) * sphere.radius) * (1 + gamma(8)) +
                   gamma(2) * max_norm(result.point) + kUnderflow;
    return result;
}

/// If T keeps the bound that is promised.
template <typename T>
std::optional<SurfacePoint> try_surface_point(const ExactRay& ray, const Sphere& sphere,
                                              SphereRoot which) {
    const detail::RoundedOffset<T> rounded =
        detail::rounded_offset(detail::rounded_quadratic<T>(ray, sphere), which);
    // Projecting onto the sphere from outside a radius r multiplies errors by at most R / r.
    const double allowed = surface_tolerance() * (max_norm(sphere.center) + sphere.radius);
    const double error = static_cast<double>(rounded.error * (1 + std::sqrt(kUnitRoundoff)));
    if (!(error < allowed && error < std::sqrt(kUnitRoundoff) * sphere.radius)) return std::nullopt;
    return point_along(sphere, Vector3(normalized(rounded.offset)), error);
}

[[gnu::cold, gnu::noinline]] SurfacePoint slow_surface_point(const ExactRay& ray,
                                                             const Sphere& sphere,
                                                             SphereRoot which) {
    if constexpr (detail::kLongDoubleIsWider)
        if (const auto found = try_surface_point<long double>(ray, sphere, which)) return *found;
    const detail::ExactQuadratic exact = detail::exact_quadratic(ray, sphere);
    const Vector3 offset = detail::unit(detail::at_root(exact, which, exact.f, exact.g));
    return point_along(sphere, normalized(offset), gamma(32) * sphere.radius);
}

}  // namespace

SurfacePoint surface_point(const ExactRay& ray, const Sphere& sphere, SphereRoot which) {
    if (const auto found = try_surface_point<double>(ray, sphere, which)) return *found;
    return slow_surface_point(ray, sphere, which);
}

}  // namespace nuvo
