#include "predicates_bounded.h"
#include "predicates_exact.h"

namespace nuvo {
namespace {

using detail::Bounded;

template <typename T>
T clamped(T weight) {
    return weight < 0 ? 0 : weight > 1 ? 1 : weight;
}

/// Weights V / S and W / S and the point a + v e1 + w e2, if T keeps the bound that is promised.
template <typename T>
bool try_surface_point(const ExactRay& ray, const Triangle& t, SurfacePoint& result) {
    const Vec3<T> a(t.a);
    const Vec3<T> d = detail::direction_of<T>(ray);
    const Vec3<T> from = a - Vec3<T>(ray.origin());
    const Vec3<T> e1 = Vec3<T>(t.b) - a;
    const Vec3<T> e2 = Vec3<T>(t.c) - a;
    const Vec3<T> normal = cross(e1, e2);
    const Vec3<T> normal_magnitude = cross_magnitude(e1, e2);
    const Bounded<T> s = detail::triple_product(d, -normal, normal_magnitude);
    const Bounded<T> v = detail::triple_product(d, cross(from, e2), cross_magnitude(from, e2));
    const Bounded<T> w = detail::triple_product(d, cross(e1, from), cross_magnitude(e1, from));
    const T x = clamped(v.value / s.value);
    const T y = clamped(w.value / s.value);
    // Errors of the two weights, then of the point. [numerics: surface points]
    const T size = std::fabs(s.value) - s.error;
    const T n1 = max_norm(e1);
    const T n2 = max_norm(e2);
    const T weights = (v.error + x * s.error) / size * n1 + (w.error + y * s.error) / size * n2;
    const T error =
        (weights + detail::gamma_of<T>(6) * (x * n1 + y * n2)) * (1 + detail::gamma_of<T>(16));
    result.point = Point3(a + (e1 * x + e2 * y));
    result.error = static_cast<double>(error) * (1 + gamma(2)) + gamma(3) * max_norm(result.point) +
                   kUnderflow;
    const double corners = std::fmax(max_norm(t.a), std::fmax(max_norm(t.b), max_norm(t.c)));
    // The normal keeps half its digits at least: its error is gamma(4) times the magnitudes.
    const T length1 = norm1(normal);
    const bool well_shaped = detail::gamma_of<T>(4) * detail::sum(normal_magnitude) <
                                 static_cast<T>(std::sqrt(kUnitRoundoff)) * length1 &&
                             length1 > static_cast<T>(detail::kSmallestSquare) &&
                             length1 < static_cast<T>(detail::kLargestSquare);
    if (!(s.sure() && result.error < surface_tolerance() * corners && well_shaped)) return false;
    result.normal = Vector3(normalized(normal));
    result.uv = {static_cast<double>(x), static_cast<double>(y)};
    return true;
}

/// The point is (S a + V e1 + W e2) / S, rounded.
SurfacePoint exact_surface_point(const ExactRay& ray, const Triangle& t) {
    const ExactVector d = detail::exact_direction(ray);
    const ExactVector a(t.a);
    const ExactVector e1 = ExactVector(t.b) - a;
    const ExactVector e2 = ExactVector(t.c) - a;
    const ExactVector from = a - ExactVector(ray.origin());
    const ExactVector normal = cross(e1, e2);
    const Exact s = -dot(d, normal);
    const Exact v = dot(d, cross(from, e2));
    const Exact w = dot(d, cross(e1, from));
    const WideDouble total = s.approximate();
    SurfacePoint result;
    for (int i = 0; i < 3; ++i)
        result.point[i] = ((s * a[i] + v * e1[i] + w * e2[i]).approximate() / total).rounded();
    result.error = gamma(8) * max_norm(result.point) + kUnderflow;
    result.normal =
        detail::unit({normal.x.approximate(), normal.y.approximate(), normal.z.approximate()});
    result.uv = {clamped((v.approximate() / total).rounded()),
                 clamped((w.approximate() / total).rounded())};
    return result;
}

[[gnu::cold, gnu::noinline]] SurfacePoint slow_surface_point(const ExactRay& ray,
                                                             const Triangle& t) {
    SurfacePoint result;
    return try_surface_point<long double>(ray, t, result) ? result : exact_surface_point(ray, t);
}

}  // namespace

SurfacePoint surface_point(const ExactRay& ray, const Triangle& t) {
    SurfacePoint result;
    return try_surface_point<double>(ray, t, result) ? result : slow_surface_point(ray, t);
}

}  // namespace nuvo
