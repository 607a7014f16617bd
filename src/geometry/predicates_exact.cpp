#include "predicates_exact.h"

#include <algorithm>
#include <utility>

namespace nuvo::detail {

ExactPlaneRoot exact_plane_root(const ExactRay& ray, const Triangle& triangle) {
    const ExactVector a(triangle.a);
    ExactPlaneRoot root;
    root.normal = cross(ExactVector(triangle.b) - a, ExactVector(triangle.c) - a);
    root.numerator = dot(root.normal, a - ExactVector(ray.origin()));
    root.denominator = dot(root.normal, exact_direction(ray));
    return root;
}

namespace {

ExactQuadratic quadratic_of(ExactVector f, ExactVector g, const Exact& r2) {
    ExactQuadratic q;
    q.a = dot(g, g);
    q.b = dot(f, g);
    q.c = dot(f, f) - r2;
    q.empty = r2.sign() == 0;
    q.f = std::move(f);
    q.g = std::move(g);
    return q;
}

}  // namespace

ExactQuadratic exact_quadratic(const ExactRay& ray, const Sphere& sphere) {
    const Exact radius(sphere.radius);
    return quadratic_of(ExactVector(ray.origin()) - ExactVector(sphere.center),
                        exact_direction(ray), radius * radius);
}

ExactQuadratic exact_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid,
                               const ExactMatrix& adjugate) {
    const Exact r =
        dot(ExactVector(ellipsoid.linear.row[0]), adjugate.column(0)) * Exact(ellipsoid.radius);
    return quadratic_of(adjugate * (ExactVector(ray.origin()) - ExactVector(ellipsoid.center)),
                        adjugate * exact_direction(ray), r * r);
}

// With |delta| <= e per component: | |f + delta|^2 - |f|^2 | <= 2 e |f|_1 + 3 e^2.
Exact exact_touch_band(const ExactQuadratic& q, const Sphere&, double origin_error) {
    const Exact e(origin_error);
    return e * (Exact(2) * (abs(q.f.x) + abs(q.f.y) + abs(q.f.z)) + Exact(3) * e);
}

// adj(M) turns delta into at most e rho_i, rho_i = the sum of |row i|: 2 e rho.|F| + e^2 rho.rho.
Exact exact_touch_band(const ExactQuadratic& q, const Ellipsoid& ellipsoid, double origin_error) {
    const ExactMatrix adjugate = exact_adjugate(ellipsoid.linear);
    ExactVector rho;
    for (int i = 0; i < 3; ++i)
        rho[i] = abs(adjugate.row[i].x) + abs(adjugate.row[i].y) + abs(adjugate.row[i].z);
    const Exact e(origin_error);
    const ExactVector size(abs(q.f.x), abs(q.f.y), abs(q.f.z));
    return e * (Exact(2) * dot(rho, size) + e * dot(rho, rho));
}

Root root_from(const WideDouble& t) {
    constexpr double kRelative = gamma(16);
    constexpr double kSmallest = std::numeric_limits<double>::min();
    constexpr double kLargest = std::numeric_limits<double>::max();
    const double rounded = std::clamp(t.rounded(), kUnderflow, kLargest);
    return {rounded, rounded < kSmallest ? 0 : rounded * (1 - kRelative),
            rounded * (1 + kRelative) + kUnderflow};
}

std::optional<SphereHit> exact_hit(const ExactQuadratic& q, Sides sides) {
    if (q.empty || q.a.sign() == 0) return std::nullopt;
    const int b = q.b.sign();
    const int c = q.c.sign();
    if (c >= 0 && b >= 0) return std::nullopt;
    if (c <= 0 && sides == Sides::kFront) return std::nullopt;
    const Exact discriminant = q.discriminant();
    if (discriminant.sign() < 0) return std::nullopt;
    // |b| + sqrt(b^2 - a c) has no cancellation; it and c give both roots.
    const WideDouble sum = abs(q.b).approximate() + sqrt(discriminant.approximate());
    if (c > 0) return SphereHit{root_from(q.c.approximate() / sum), SphereRoot::kNear};
    const WideDouble far = b <= 0 ? sum / q.a.approximate() : (-q.c).approximate() / sum;
    return SphereHit{root_from(far), SphereRoot::kFar};
}

bool exact_blocks(const ExactQuadratic& q, double end, OriginPlace place, Sides sides) {
    if (q.empty || q.a.sign() == 0) return false;
    const int b = q.b.sign();
    const bool endless = std::isinf(end);
    const auto end_is_outside = [&] {
        return (Exact(end) * (Exact(end) * q.a + Exact(2) * q.b) + q.c).sign() > 0;
    };
    // See rounded_blocks().
    if (place == OriginPlace::kOnIt) return b < 0 && (endless || end_is_outside());
    const bool outside = q.c.sign() > 0;
    const bool touches = place == OriginPlace::kTouching;
    if (!outside) return (!touches || b < 0) && (endless || end_is_outside());
    if (b >= 0 || q.discriminant().sign() < 0) return false;
    if (endless) return true;
    const int slope = (Exact(end) * q.a + q.b).sign();
    // What is touched, and the front that the end sees, blocks by its far root.
    if (touches || sides == Sides::kFront) return slope > 0 && end_is_outside();
    // The near root lies before the end iff the end lies inside, or behind the vertex.
    return slope > 0 || (Exact(end) * (Exact(end) * q.a + Exact(2) * q.b) + q.c).sign() < 0;
}

Vec3<WideDouble> at_root(const ExactQuadratic& q, SphereRoot which, const ExactVector& p,
                         const ExactVector& r) {
    const WideDouble root = sqrt(abs(q.discriminant()).approximate());
    const WideDouble side = root * WideDouble(which == SphereRoot::kNear ? -1 : 1);
    const WideDouble a = q.a.approximate();
    Vec3<WideDouble> result;
    for (int i = 0; i < 3; ++i) {
        const WideDouble across = (q.a * p[i] - q.b * r[i]).approximate();
        result[i] = (across + side * r[i].approximate()) / a;
    }
    return result;
}

Vector3 unit(const Vec3<WideDouble>& v) {
    std::int64_t top = std::numeric_limits<std::int64_t>::min();
    for (int i = 0; i < 3; ++i)
        if (v[i].significand() != 0) top = std::max(top, v[i].exponent());
    Vector3 scaled;
    for (int i = 0; i < 3; ++i)
        if (v[i].significand() != 0)
            scaled[i] = WideDouble(v[i].significand(), v[i].exponent() - top).rounded();
    return normalized(scaled);
}

}  // namespace nuvo::detail
