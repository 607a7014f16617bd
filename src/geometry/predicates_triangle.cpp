#include "predicates_bounded.h"
#include "predicates_exact.h"

namespace nuvo::detail {
namespace {

/// The exact sign of d . (p x q).
int exact_triple_sign(const ExactVector& d, const ExactVector& p, const ExactVector& q) {
    return dot(d, cross(p, q)).sign();
}

/// The plane form t = n.(a - o) / n.d: n comes from the edges, so that a small triangle far away
/// keeps its accuracy.
template <typename T>
struct PlaneRoot {
    Bounded<T> numerator;
    Bounded<T> denominator;
    Vec3<T> normal;
    Vec3<T> normal_magnitude;  ///< gamma(4) times this bounds the normal's error
};

template <typename T>
PlaneRoot<T> plane_root(const ExactRay& ray, const Triangle& t) {
    const Vec3<T> corner(t.a);
    const Vec3<T> e1 = Vec3<T>(t.b) - corner;
    const Vec3<T> e2 = Vec3<T>(t.c) - corner;
    const Vec3<T> normal = cross(e1, e2);
    const Vec3<T> size = cross_magnitude(e1, e2);
    return {triple_product(corner - Vec3<T>(ray.origin()), normal, size),
            triple_product(direction_of<T>(ray), normal, size), normal, size};
}

enum class Outcome : std::uint8_t { kNo, kYes, kUnsure };

template <typename T>
Outcome try_hit(const ExactRay& ray, const Triangle& triangle, Root& root) {
    const PlaneRoot<T> plane = plane_root<T>(ray, triangle);
    const Bounded<T>& n = plane.numerator;
    const Bounded<T>& d = plane.denominator;
    if (n.sure() && d.sure() && n.sign() != d.sign()) return Outcome::kNo;
    constexpr double kShare = 0.4375 * root_tolerance();  // two of these and four roundings
    const double t = static_cast<double>(n.value / d.value);
    if (!(n.within(kShare) && d.within(kShare) && t > kSmallestRoot && t < kLargestRoot))
        return Outcome::kUnsure;
    root = {t, t * (1 - root_tolerance()), t * (1 + root_tolerance())};
    return Outcome::kYes;
}

template <typename T>
Outcome try_blocks(const ExactRay& shadow, double end, double origin_error,
                   const Triangle& triangle) {
    const PlaneRoot<T> plane = plane_root<T>(shadow, triangle);
    const Bounded<T>& n = plane.numerator;
    const Bounded<T>& d = plane.denominator;
    if (!n.sure() || !d.sure()) return Outcome::kUnsure;
    if (n.sign() != d.sign()) return Outcome::kNo;
    constexpr T kUp = 1 + gamma_of<T>(8);
    constexpr T kDown = 1 - gamma_of<T>(8);
    const T tiny = static_cast<T>(kUnderflow);
    const T low = (std::fabs(n.value) - n.error) * kDown;
    const T high = (std::fabs(n.value) + n.error) * kUp;
    const T far = static_cast<T>(end);
    if (low > far * (std::fabs(d.value) + d.error) * kUp + tiny) return Outcome::kNo;
    const T norm1 = sum(magnitude(plane.normal));
    const T norm1_error = gamma_of<T>(8) * sum(plane.normal_magnitude) + 16 * tiny;
    const T error = static_cast<T>(origin_error);
    if (high + tiny < error * (norm1 - norm1_error) * kDown) return Outcome::kNo;
    const bool before_end = high + tiny < far * (std::fabs(d.value) - d.error) * kDown;
    return before_end && low > error * (norm1 + norm1_error) * kUp + tiny ? Outcome::kYes
                                                                          : Outcome::kUnsure;
}

[[gnu::cold, gnu::noinline]] std::optional<Root> slow_hit(const ExactRay& ray,
                                                          const Triangle& triangle,
                                                          StageCounts& counts) {
    ++counts.wider;
    Root found;
    const Outcome outcome = try_hit<long double>(ray, triangle, found);
    if (outcome == Outcome::kNo) return std::nullopt;
    if (outcome == Outcome::kYes) return found;
    ++counts.exact;
    const ExactPlaneRoot root = exact_plane_root(ray, triangle);
    if (root.numerator.sign() * root.denominator.sign() <= 0) return std::nullopt;
    return root_from(root.numerator.approximate() / root.denominator.approximate());
}

[[gnu::cold, gnu::noinline]] bool slow_blocks(const ExactRay& shadow, double end,
                                              double origin_error, const Triangle& triangle,
                                              StageCounts& counts) {
    ++counts.wider;
    const Outcome outcome = try_blocks<long double>(shadow, end, origin_error, triangle);
    if (outcome != Outcome::kUnsure) return outcome == Outcome::kYes;
    ++counts.exact;
    const ExactPlaneRoot root = exact_plane_root(shadow, triangle);
    if (root.numerator.sign() * root.denominator.sign() <= 0) return false;
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
        const Vector3& p = corner[(i + 2) % 3];
        const Vector3& q = corner[(i + 1) % 3];
        const Bounded<double> edge =
            triple_product(ray.direction(), cross(p, q), cross_magnitude(p, q));
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
    Root root;
    switch (try_hit<double>(ray, triangle, root)) {
        case Outcome::kNo:
            return std::nullopt;
        case Outcome::kYes:
            return root;
        case Outcome::kUnsure:
            break;
    }
    return slow_hit(ray, triangle, counts);
}

bool triangle_blocks(const ExactRay& shadow, double end, double origin_error,
                     const Triangle& triangle, StageCounts& counts) {
    const Outcome outcome = try_blocks<double>(shadow, end, origin_error, triangle);
    if (outcome != Outcome::kUnsure) return outcome == Outcome::kYes;
    return slow_blocks(shadow, end, origin_error, triangle, counts);
}

}  // namespace nuvo::detail
