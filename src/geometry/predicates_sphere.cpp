#include "predicates_quadratic.h"

namespace nuvo {
namespace detail {

RoundedQuadratic rounded_quadratic(const ExactRay& ray, const Sphere& sphere) {
    RoundedQuadratic q;
    q.f = ray.origin() - sphere.center;
    q.g = ray.direction();
    q.a = ray.square();
    q.a_relative = gamma(6);
    q.length = ray.length();
    q.b = dot(q.f, q.g);
    q.l = q.f - q.g * (q.b * ray.inverse_square());
    const double ff = dot(q.f, q.f);
    const double rr = sphere.radius * sphere.radius;
    const double ll = dot(q.l, q.l);
    const double squares = ff + rr;
    q.f_norm = std::sqrt(ff);
    q.b_error = gamma(7) * q.f_norm * q.length;
    q.c = ff - rr;
    q.c_error = power_error_bound(squares);
    q.depth = rr - ll;
    // 6 u |l| |f| from f, the tail and s d; 4 u |l|^2 + 2 u R^2 from the squares; the part of the
    // error along d, at most 16 u |f|, counts by its square only. [numerics: depth bound]
    q.depth_error =
        gamma(8) * std::sqrt(ll) * q.f_norm + gamma(8) * (ll + rr) + gamma(16) * gamma(32) * ff;
    q.offset_error = gamma(20) * q.f_norm;
    if (!(squares > kSmallestSquare && squares < kLargestSquare)) {
        q.b_error = q.c_error = q.depth_error = std::numeric_limits<double>::quiet_NaN();
        q.offset_error = q.b_error;
    }
    return q;
}

std::optional<SphereHit> sphere_hit(const ExactRay& ray, const Sphere& sphere, Sides sides,
                                    StageCounts& counts) {
    return quadric_hit(ray, sphere, sides, counts);
}

Bounded<double> rounded_touch_band(const RoundedQuadratic& q, const Sphere&, double origin_error) {
    const double band = origin_error * (2 * norm1(q.f) + 3 * origin_error);
    return {band, gamma(8) * band};
}

bool sphere_blocks(const ExactRay& shadow, double end, double origin_error, const Sphere& sphere,
                   bool origin_on_it, Sides sides, StageCounts& counts) {
    return quadric_blocks(shadow, end, origin_error, sphere, origin_on_it, sides, counts);
}

}  // namespace detail

SurfacePoint surface_point(const ExactRay& ray, const Sphere& sphere, SphereRoot which) {
    using namespace detail;
    const RoundedOffset rounded = rounded_offset(rounded_quadratic(ray, sphere), which);
    // Projecting onto the sphere from outside a radius r multiplies errors by at most R / r.
    const double allowed = surface_tolerance() * (max_norm(sphere.center) + sphere.radius);
    Vector3 offset = rounded.offset;
    double error = rounded.error * (1 + std::sqrt(kUnitRoundoff));
    if (!(error < allowed && error < std::sqrt(kUnitRoundoff) * sphere.radius)) {
        const ExactQuadratic exact = exact_quadratic(ray, sphere);
        offset = unit(at_root(exact, which, exact.f, exact.g));
        error = gamma(32) * sphere.radius;
    }
    SurfacePoint result;
    result.normal = normalized(offset);
    result.point = sphere.center + result.normal * sphere.radius;
    result.error = (error + gamma(8) * sphere.radius) * (1 + gamma(8)) +
                   gamma(2) * max_norm(result.point) + kUnderflow;
    return result;
}

}  // namespace nuvo
