#include "predicates_quadratic.h"

// Spheres and ellipsoids that nearly coincide: their roots differ by less than the roots' own
// error, but what one surface's point is to the other solid is a sum of small differences, each of
// which doubles know to many digits. [numerics: nearly coincident quadrics]
namespace nuvo::detail {
namespace {

/// The surface is center + linear * s, |s| = radius.
Ellipsoid as_ellipsoid(const Sphere& sphere) { return {sphere.center, Matrix3{}, sphere.radius}; }
const Ellipsoid& as_ellipsoid(const Ellipsoid& ellipsoid) { return ellipsoid; }

double norm(const Vector3& v) { return std::sqrt(dot(v, v)) * (1 + gamma(4)); }
double size(const Rows<double>& m) {
    return std::sqrt(dot(m.row[0], m.row[0]) + dot(m.row[1], m.row[1]) + dot(m.row[2], m.row[2])) *
           (1 + gamma(8));
}

/// v / d.
BoundedVector<double> quotient(const BoundedVector<double>& v, const Bounded<double>& d) {
    const double left = std::fabs(d.value) - d.error;
    const Vector3 value = v.value * (1 / d.value);
    const double error = (v.error + norm(value) * (d.error + gamma(4) * std::fabs(d.value))) /
                             left * (1 + gamma(8)) +
                         4 * kUnderflow;
    return {value, left > 0 ? error : std::numeric_limits<double>::quiet_NaN()};
}

/// s of the root, on a's unit sphere times its radius.
BoundedVector<double> on_sphere(const ExactRay& ray, const Sphere& sphere, SphereRoot which) {
    const RoundedOffset<double> at = rounded_offset(rounded_quadratic(ray, sphere), which);
    return {at.offset, at.error};
}
BoundedVector<double> on_sphere(const ExactRay& ray, const Ellipsoid& ellipsoid, SphereRoot which) {
    const RoundedOffset<double> at = rounded_offset(rounded_quadratic(ray, ellipsoid), which);
    const BoundedMatrix<double> adjugate = bounded_adjugate<double>(ellipsoid.linear);
    return quotient({at.offset, at.error}, determinant(ellipsoid.linear, adjugate));
}

std::optional<int> sure_order(const ExactRay& ray, const Ellipsoid& a,
                              const BoundedVector<double>& s, const Ellipsoid& b,
                              SphereRoot which_b) {
    const BoundedMatrix<double> adjugate = bounded_adjugate<double>(b.linear);
    const Bounded<double> det = determinant(b.linear, adjugate);
    // The point of a, from b's centre, is b.linear (s + w) with w = b.linear^-1 v.
    Rows<double> change = rows_of<double>(a.linear);
    for (int i = 0; i < 3; ++i) change.row[i] = change.row[i] - b.linear.row[i];
    const Vector3 shift = a.center - b.center;
    const Vector3 v = change * s.value + shift;
    const double change_size = size(change);
    const double v_error = gamma(6) * (change_size * norm(s.value) + norm(shift)) * 2 +
                           change_size * s.error + 16 * kUnderflow;
    BoundedVector<double> numerator = product(adjugate, v);
    numerator.error += size(adjugate.magnitude) * v_error * (1 + gamma(8));
    const BoundedVector<double> w = quotient(numerator, det);
    // |s + w|^2 - b's radius^2, where |s| is a's radius: > 0 outside of b.
    const double s_norm = norm(s.value);
    const double w_norm = norm(w.value);
    const double radii = (a.radius - b.radius) * (a.radius + b.radius);
    const double power = 2 * dot(s.value, w.value) + dot(w.value, w.value) + radii;
    const double power_error =
        (2 * ((s_norm + w_norm) * w.error + s.error * (w_norm + w.error)) + w.error * w.error) *
            (1 + gamma(8)) +
        gamma(10) * (2 * s_norm * w_norm + w_norm * w_norm + std::fabs(radii)) + 16 * kUnderflow;
    if (!(std::fabs(power) > power_error)) return std::nullopt;
    if (power < 0) return which_b == SphereRoot::kNear ? 1 : -1;  // between the roots of b
    // (s + w) . (b.linear^-1 d): < 0 before both roots of b.
    const BoundedVector<double> h = quotient(product(adjugate, ray.direction()), det);
    const Vector3 from_b = s.value + w.value;
    const double h_norm = norm(h.value);
    const double slope = dot(from_b, h.value);
    const double slope_error =
        ((s_norm + w_norm) * h.error + (s.error + w.error) * (h_norm + h.error)) * (1 + gamma(8)) +
        gamma(6) * (s_norm + w_norm) * h_norm + 16 * kUnderflow;
    if (!(std::fabs(slope) > slope_error)) return std::nullopt;
    return slope < 0 ? -1 : 1;
}

}  // namespace

std::optional<int> sure_order(const ExactRay& ray, const HitPrimitive& a, const HitPrimitive& b) {
    return std::visit(
        [&](const auto* first, const auto* second) -> std::optional<int> {
            if constexpr (std::is_same_v<decltype(first), const Triangle*> ||
                          std::is_same_v<decltype(second), const Triangle*>)
                return std::nullopt;
            else
                return sure_order(ray, as_ellipsoid(*first), on_sphere(ray, *first, a.which),
                                  as_ellipsoid(*second), b.which);
        },
        a.primitive, b.primitive);
}

}  // namespace nuvo::detail
