#include "plane_root.h"
#include "predicates_exact.h"

namespace nuvo::detail {
namespace {

enum class Outcome : std::uint8_t { kNo, kYes, kUnsure };

template <typename T>
Outcome try_hit(const ExactRay& ray, const Triangle& triangle, Root& root) {
    const PlaneRoot<T> plane = plane_root<T>(ray, triangle);
    const Bounded<T>& n = plane.numerator;
    const Bounded<T>& d = plane.denominator;
    if (n.vanishes() || d.vanishes()) return Outcome::kNo;
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
    if (n.vanishes() || d.vanishes()) return Outcome::kNo;
    if (!n.sure() || !d.sure()) return Outcome::kUnsure;
    if (n.sign() != d.sign()) return Outcome::kNo;
    constexpr T kUp = 1 + gamma_of<T>(8);
    constexpr T kDown = 1 - gamma_of<T>(8);
    const T tiny = underflow_of<T>();
    const T low = (std::fabs(n.value) - n.error) * kDown;
    const T high = (std::fabs(n.value) + n.error) * kUp;
    const T far = static_cast<T>(end);
    if (low > far * (std::fabs(d.value) + d.error) * kUp + tiny) return Outcome::kNo;
    const T normal_norm1 = norm1(plane.normal);
    const T norm1_error = gamma_of<T>(8) * sum(plane.normal_magnitude) + 16 * tiny;
    const T error = static_cast<T>(origin_error);
    if (high + tiny < error * (normal_norm1 - norm1_error) * kDown) return Outcome::kNo;
    const bool before_end = high + tiny < far * (std::fabs(d.value) - d.error) * kDown;
    return before_end && low > error * (normal_norm1 + norm1_error) * kUp + tiny ? Outcome::kYes
                                                                                 : Outcome::kUnsure;
}

/// Signs of the edge functions U, V, W, found one by one. The one that does not count is treated as
/// if its opposite had been found.
struct EdgeSigns {
    explicit EdgeSigns(Crossing crossing)
        : positive(crossing == Crossing::kIn), negative(crossing == Crossing::kOut) {}

    bool known[3] = {false, false, false};
    bool positive;
    bool negative;
    bool any = false;

    void set(int edge, int sign) {
        known[edge] = true;
        positive = positive || sign > 0;
        negative = negative || sign < 0;
        any = any || sign != 0;
    }
    bool decided() const { return (positive && negative) || (known[0] && known[1] && known[2]); }
    /// All zero: the line lies in the plane, or there is no plane.
    LineTest answer() const {
        return any && !(positive && negative) ? LineTest::kMeets : LineTest::kMisses;
    }
};

/// Finds the unknown signs that T's roundings leave sure.
template <typename T>
void add_signs(const ExactRay& ray, const Triangle& t, EdgeSigns& signs) {
    const Vec3<T> o(ray.origin());
    const Vec3<T> d = direction_of<T>(ray);
    const Vec3<T> corner[3] = {Vec3<T>(t.a) - o, Vec3<T>(t.b) - o, Vec3<T>(t.c) - o};
    for (int i = 0; i < 3; ++i) {
        if (signs.known[i]) continue;
        const Vec3<T>& p = corner[(i + 2) % 3];
        const Vec3<T>& q = corner[(i + 1) % 3];
        const Bounded<T> edge = triple_product(d, cross(p, q), cross_magnitude(p, q));
        if (edge.sure())
            signs.set(i, edge.sign());
        else if (edge.vanishes())
            signs.set(i, 0);
    }
}

/// Whether origin + d, d = direction + tail, is exactly p.
bool is_target(const ExactRay& ray, const Point3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        const TwoTerms d = two_diff(p[axis], ray.origin()[axis]);
        if (d.value != ray.direction()[axis] || d.error != ray.tail()[axis]) return false;
    }
    return true;
}

/// origin + d of a ray between two points: the second one.
Point3 target(const ExactRay& ray) {
    Point3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin()[axis];
        const double sum = o + ray.direction()[axis];
        const double back = two_diff(sum, o).value;
        const double lost = (ray.direction()[axis] - back) - two_diff(sum, o).error;
        p[axis] = sum + (lost + ray.tail()[axis]);
    }
    return p;
}

/// The sign of n.v, of n known within two roundoffs and what underflowed, and of v within one: with
/// the product and two sums six in all. [numerics: edge planes]
std::optional<int> sure_sign(const Vector3& n, const Vector3& v) {
    if (n == Vector3{0, 0, 0}) return 0;
    const Vector3 size = magnitude(v);
    const Bounded<double> product{
        dot(n, v), gamma(6) * dot(magnitude(n), size) + 8 * kUnderflow * (sum(size) + 1)};
    if (!product.sure()) return std::nullopt;
    return product.sign();
}

/// The sign of n.(q - p), of n as above and n.q known within two roundoffs, where p is small beside
/// q. [numerics: edge planes]
std::optional<int> sure_sign(const Vector3& n, double nq, const Point3& p) {
    const Vector3 size = magnitude(p);
    const Bounded<double> difference{
        nq - dot(n, p),
        gamma(6) * (std::fabs(nq) + dot(magnitude(n), size)) + 8 * kUnderflow * (sum(size) + 1)};
    if (!difference.sure()) return std::nullopt;
    return difference.sign();
}

/// Finds the unknown signs by planes through the edges and a point of the ray, or along the ray.
void add_signs_of_planes(const EdgePlanes& planes, bool along, const ExactRay& ray,
                         const Triangle& t, EdgeSigns& signs) {
    const Point3 corner[3] = {t.a, t.b, t.c};
    for (int i = 0; i < 3; ++i) {
        if (signs.known[i]) continue;
        const Vector3& n = planes.normal[i];
        const Vector3 v = along ? corner[(i + 1) % 3] - ray.origin() : ray.direction();
        std::optional<int> sign = sure_sign(n, v);
        if (!sign && along) sign = sure_sign(n, planes.offset[i], ray.origin());
        if (sign) signs.set(i, *sign);
    }
}

/// The point that other rays may share: the light that a way ends in, else the origin.
Point3 shared_point(const ExactRay& ray, double end) {
    if (end == 1)
        if (const Point3 last = target(ray); is_target(ray, last)) return last;
    return ray.origin();
}

void add_exact_signs(const ExactRay& ray, const Triangle& t, EdgeSigns& signs) {
    const ExactVector o(ray.origin());
    const ExactVector d = exact_direction(ray);
    const ExactVector corner[3] = {ExactVector(t.a) - o, ExactVector(t.b) - o,
                                   ExactVector(t.c) - o};
    for (int i = 0; i < 3 && !signs.decided(); ++i)
        if (!signs.known[i])
            signs.set(i, dot(d, cross(corner[(i + 2) % 3], corner[(i + 1) % 3])).sign());
}

/// The way ends exactly in the triangle's plane, and so meets the triangle there if at all.
bool ends_in_plane(const ExactRay& way, double end, const Triangle& t, StageCounts& counts) {
    if (end != 1) return false;
    const Point3 last = target(way);
    return is_target(way, last) && counts.sides.side(t, last, counts.exact) == 0;
}

[[gnu::cold, gnu::noinline]] LineTest slow_line_test(const ExactRay& ray, double end,
                                                     const Triangle& t, EdgeSigns signs,
                                                     StageCounts& counts) {
    // A ray from a corner meets the triangle there, at t = 0, or lies in its plane.
    if (is_corner(ray.origin(), t)) return LineTest::kMisses;
    const Point3 shared = shared_point(ray, end);
    const bool untailed = ray.tail() == Vector3{0, 0, 0};
    if (const EdgePlanes* known = counts.edges.known_through(t, shared))
        add_signs_of_planes(*known, false, ray, t, signs);
    else if (untailed && (known = counts.edges.known_along(t, ray.direction())))
        add_signs_of_planes(*known, true, ray, t, signs);
    if (signs.decided()) return signs.answer();
    add_signs<long double>(ray, t, signs);
    if (signs.decided()) return signs.answer();
    const EdgePlanes* planes = counts.edges.through(t, shared);
    const bool along = !planes && untailed;
    if (along) planes = counts.edges.along(t, ray.direction());
    if (planes) add_signs_of_planes(*planes, along, ray, t, signs);
    if (signs.decided()) return signs.answer();
    // What lies in a plane with the origin is not met beyond it, what with the end not before it.
    if (counts.sides.side(t, ray.origin(), counts.exact) == 0 || ends_in_plane(ray, end, t, counts))
        return LineTest::kMisses;
    ++counts.exact;
    add_exact_signs(ray, t, signs);
    return signs.answer();
}

[[gnu::cold, gnu::noinline]] std::optional<Root> slow_hit(const ExactRay& ray,
                                                          const Triangle& triangle,
                                                          StageCounts& counts) {
    ++counts.wider;
    Root found;
    const Outcome outcome = try_hit<long double>(ray, triangle, found);
    if (outcome == Outcome::kNo) return std::nullopt;
    if (outcome == Outcome::kYes) return found;
    if (counts.sides.side(triangle, ray.origin(), counts.exact) == 0) return std::nullopt;
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
    if (ends_in_plane(shadow, end, triangle, counts)) return false;
    ++counts.exact;
    const ExactPlaneRoot root = exact_plane_root(shadow, triangle);
    if (root.numerator.sign() * root.denominator.sign() <= 0) return false;
    const Exact norm1 = abs(root.normal.x) + abs(root.normal.y) + abs(root.normal.z);
    const Exact distance = abs(root.numerator);
    if (compare(distance, Exact(origin_error) * norm1) <= 0) return false;
    return std::isinf(end) || compare(distance, Exact(end) * abs(root.denominator)) < 0;
}

}  // namespace

LineTest line_test_alone(const ExactRay& ray, double end, const Triangle& t, Crossing crossing,
                         StageCounts& counts) {
    if (std::isfinite(ray.edge_error())) ++counts.wider;
    EdgeSigns signs(crossing);
    add_signs<double>(ray, t, signs);
    if (signs.decided()) return signs.answer();
    return slow_line_test(ray, end, t, signs, counts);
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
