#include "predicates_exact.h"

namespace nuvo {
namespace detail {
namespace {

/// Componentwise |p| x |q| with every product added: bounds the cross product's roundings.
Vector3 cross_magnitude(const Vector3& p, const Vector3& q) {
    return {std::fabs(p.y * q.z) + std::fabs(p.z * q.y),
            std::fabs(p.z * q.x) + std::fabs(p.x * q.z),
            std::fabs(p.x * q.y) + std::fabs(p.y * q.x)};
}

Vector3 magnitude(const Vector3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

double sum(const Vector3& v) { return v.x + v.y + v.z; }

/// A double with its error bound. A NaN or infinite bound: nothing is known.
struct Bounded {
    double value;
    double error;

    bool sure() const { return std::fabs(value) > error && error < kLargest; }
    int sign() const { return value > 0 ? 1 : -1; }
    /// Known within `relative`.
    bool within(double relative) const {
        return error <= relative * std::fabs(value) && error < kLargest;
    }

  private:
    static constexpr double kLargest = std::numeric_limits<double>::max();
};

/// d . (p x q), each of d, p, q known within one roundoff (a difference, or a direction without its
/// tail): products of 8 roundings each, over the sum of their magnitudes; and underflow.
/// [numerics: triple product]
Bounded triple_product(const Vector3& d, const Vector3& p, const Vector3& q) {
    const Vector3 size = magnitude(d);
    return {dot(d, cross(p, q)),
            gamma(9) * dot(size, cross_magnitude(p, q)) + 16 * kUnderflow * (sum(size) + 1)};
}

/// The exact sign of d . (p x q).
int exact_triple_sign(const ExactVector& d, const ExactVector& p, const ExactVector& q) {
    return dot(d, cross(p, q)).sign();
}

/// The plane form t = n.(a - o) / n.d in double: n comes from the edges, so that a small triangle
/// far away keeps its accuracy.
struct PlaneRoot {
    Bounded numerator;
    Bounded denominator;
    Vector3 normal;
    Vector3 normal_magnitude;  ///< gamma(4) times this bounds the normal's error
};

PlaneRoot plane_root(const ExactRay& ray, const Triangle& t) {
    const Vector3 a = t.a - ray.origin();
    const Vector3 e1 = t.b - t.a;
    const Vector3 e2 = t.c - t.a;
    PlaneRoot root;
    root.normal = cross(e1, e2);
    root.normal_magnitude = cross_magnitude(e1, e2);
    const auto along = [&](const Vector3& v) {
        const Vector3 size = magnitude(v);
        return Bounded{dot(root.normal, v), gamma(9) * dot(root.normal_magnitude, size) +
                                                16 * kUnderflow * (sum(size) + 1)};
    };
    root.numerator = along(a);
    root.denominator = along(ray.direction());
    return root;
}

[[gnu::cold, gnu::noinline]] std::optional<Root> exact_triangle_hit(const ExactRay& ray,
                                                                    const Triangle& triangle,
                                                                    StageCounts& counts) {
    ++counts.exact;
    const ExactPlaneRoot root = exact_plane_root(ray, triangle);
    if (root.numerator.sign() * root.denominator.sign() <= 0) return std::nullopt;
    return root_from(root.numerator.approximate() / root.denominator.approximate());
}

[[gnu::cold, gnu::noinline]] bool exact_triangle_blocks(const ExactRay& shadow, double end,
                                                        double origin_error,
                                                        const Triangle& triangle,
                                                        StageCounts& counts) {
    ++counts.exact;
    const ExactPlaneRoot root = exact_plane_root(shadow, triangle);
    const int side = root.denominator.sign();
    if (root.numerator.sign() * side <= 0) return false;
    const Exact norm1 = abs(root.normal.x) + abs(root.normal.y) + abs(root.normal.z);
    const Exact distance = abs(root.numerator);
    if (compare(distance, Exact(origin_error) * norm1) <= 0) return false;
    return std::isinf(end) || compare(distance, Exact(end) * abs(root.denominator)) < 0;
}

}  // namespace

// First a bound for each edge, then exact signs.
LineTest line_test_alone(const ExactRay& ray, const Triangle& t, StageCounts& counts) {
    if (std::isfinite(ray.edge_error())) ++counts.wider;
    const Vector3 corner[3] = {t.a - ray.origin(), t.b - ray.origin(), t.c - ray.origin()};
    int signs[3];
    bool positive = false;
    bool negative = false;
    bool all_sure = true;
    for (int i = 0; i < 3; ++i) {
        const Bounded edge =
            triple_product(ray.direction(), corner[(i + 2) % 3], corner[(i + 1) % 3]);
        signs[i] = edge.sure() ? edge.sign() : 0;
        all_sure = all_sure && signs[i] != 0;
        positive = positive || signs[i] > 0;
        negative = negative || signs[i] < 0;
    }
    if (positive && negative) return LineTest::kMisses;
    if (all_sure) return LineTest::kMeets;
    ++counts.exact;
    const ExactVector o(ray.origin());
    const ExactVector d = exact_direction(ray);
    const ExactVector exact_corner[3] = {ExactVector(t.a) - o, ExactVector(t.b) - o,
                                         ExactVector(t.c) - o};
    for (int i = 0; i < 3; ++i) {
        if (signs[i] != 0) continue;
        const int sign = exact_triple_sign(d, exact_corner[(i + 2) % 3], exact_corner[(i + 1) % 3]);
        positive = positive || sign > 0;
        negative = negative || sign < 0;
        if (positive && negative) return LineTest::kMisses;
    }
    // All zero: the line lies in the plane, or there is no plane.
    return positive || negative ? LineTest::kMeets : LineTest::kMisses;
}

std::optional<Root> triangle_hit(const ExactRay& ray, const Triangle& triangle,
                                 StageCounts& counts) {
    const PlaneRoot root = plane_root(ray, triangle);
    const Bounded& n = root.numerator;
    const Bounded& d = root.denominator;
    if (n.sure() && d.sure() && n.sign() != d.sign()) return std::nullopt;
    constexpr double kShare = 0.4375 * root_tolerance();  // two of these and three roundings
    const double t = n.value / d.value;
    if (n.within(kShare) && d.within(kShare) && t > kSmallestRoot && t < kLargestRoot)
        return Root{t, t * (1 - root_tolerance()), t * (1 + root_tolerance())};
    ++counts.wider;
    return exact_triangle_hit(ray, triangle, counts);
}

bool triangle_blocks(const ExactRay& shadow, double end, double origin_error,
                     const Triangle& triangle, StageCounts& counts) {
    const PlaneRoot root = plane_root(shadow, triangle);
    const Bounded& n = root.numerator;
    const Bounded& d = root.denominator;
    if (n.sure() && d.sure()) {
        if (n.sign() != d.sign()) return false;
        const double low = (std::fabs(n.value) - n.error) * (1 - gamma(2));
        const double high = (std::fabs(n.value) + n.error) * (1 + gamma(2));
        if (low > end * (std::fabs(d.value) + d.error) * (1 + gamma(3))) return false;
        const double norm1 = sum(magnitude(root.normal));
        const double norm1_error = gamma(6) * sum(root.normal_magnitude);
        const double band = origin_error * (norm1 + norm1_error) * (1 + gamma(4));
        if (low > band + kUnderflow && high < end * (std::fabs(d.value) - d.error) * (1 - gamma(3)))
            return true;
        if (high + kUnderflow < origin_error * (norm1 - norm1_error) * (1 - gamma(4))) return false;
    }
    ++counts.wider;
    return exact_triangle_blocks(shadow, end, origin_error, triangle, counts);
}

}  // namespace detail

namespace {

/// The weights and the point of the exact stage: the point is (S a + V e1 + W e2) / S, rounded.
[[gnu::cold, gnu::noinline]] SurfacePoint exact_surface_point(const ExactRay& ray,
                                                              const Triangle& t) {
    const ExactVector o(ray.origin());
    const ExactVector d = detail::exact_direction(ray);
    const ExactVector a(t.a);
    const ExactVector e1 = ExactVector(t.b) - a;
    const ExactVector e2 = ExactVector(t.c) - a;
    const ExactVector from = a - o;
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
    result.uv = {(v.approximate() / total).rounded(), (w.approximate() / total).rounded()};
    return result;
}

}  // namespace

SurfacePoint surface_point(const ExactRay& ray, const Triangle& t) {
    using detail::Bounded;
    const Vector3 from = t.a - ray.origin();
    const Vector3 e1 = t.b - t.a;
    const Vector3 e2 = t.c - t.a;
    const Vector3 normal = cross(e1, e2);
    const Bounded s = detail::triple_product(ray.direction(), e2, e1);
    const Bounded v = detail::triple_product(ray.direction(), from, e2);
    const Bounded w = detail::triple_product(ray.direction(), e1, from);
    SurfacePoint result;
    result.uv = {v.value / s.value, w.value / s.value};
    result.point = t.a + (e1 * result.uv.x + e2 * result.uv.y);
    // Errors of the two weights, then of the point. [numerics: surface points]
    const double size = std::fabs(s.value) - s.error;
    const double n1 = detail::largest(e1);
    const double n2 = detail::largest(e2);
    const double x = std::fabs(result.uv.x);
    const double y = std::fabs(result.uv.y);
    const double weights =
        (v.error + x * s.error) / size * n1 + (w.error + y * s.error) / size * n2;
    result.error = (weights + gamma(6) * (x * n1 + y * n2)) * (1 + gamma(16)) +
                   gamma(2) * max_norm(result.point);
    const double corners = std::fmax(max_norm(t.a), std::fmax(max_norm(t.b), max_norm(t.c)));
    // The normal keeps half its digits at least: its error is gamma(4) times the magnitudes.
    const Vector3 magnitudes = detail::cross_magnitude(e1, e2);
    const double length1 = detail::sum(detail::magnitude(normal));
    const bool well_shaped = detail::sum(magnitudes) < length1 / std::sqrt(kUnitRoundoff) &&
                             length1 > detail::kSmallestSquare && length1 < detail::kLargestSquare;
    if (!(s.sure() && result.error < 8 * root_tolerance() * corners && well_shaped))
        return exact_surface_point(ray, t);
    result.normal = normalized(normal);
    const auto clamped = [](double weight) { return weight < 0 ? 0 : weight > 1 ? 1 : weight; };
    result.uv = {clamped(result.uv.x), clamped(result.uv.y)};
    return result;
}

}  // namespace nuvo
