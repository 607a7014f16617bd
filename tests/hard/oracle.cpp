#include "oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nuvo::hard {
namespace {

constexpr int kNoGrid = std::numeric_limits<int>::max();

// The exponent of the lowest bit of v that is set.
int lowest_bit(double v) {
    if (v == 0) return kNoGrid;
    int exponent = 0;
    auto significand = static_cast<std::int64_t>(std::ldexp(std::frexp(v, &exponent), 53));
    exponent -= 53;
    for (; significand % 2 == 0; significand /= 2) ++exponent;
    return exponent;
}
int lowest_bit(const Vector3& v) {
    return std::min({lowest_bit(v.x), lowest_bit(v.y), lowest_bit(v.z)});
}
int lowest_bit(const Shape& shape) {
    int lowest = kNoGrid;
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
        for (const Point3& p : mesh->positions) lowest = std::min(lowest, lowest_bit(p));
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        lowest = std::min(lowest_bit(sphere->center), lowest_bit(sphere->radius));
    } else {
        const auto& ellipsoid = std::get<Ellipsoid>(shape);
        lowest = std::min(lowest_bit(ellipsoid.center), lowest_bit(ellipsoid.radius));
    }
    return lowest;
}

// v / 2^grid, a whole number.
Integer on_grid(double v, int grid) {
    if (v == 0) return 0;
    const int lowest = lowest_bit(v);
    return Integer(static_cast<std::int64_t>(std::ldexp(v, -lowest))) << (lowest - grid);
}
Vec3<Integer> on_grid(const Vector3& v, int grid) {
    return {on_grid(v.x, grid), on_grid(v.y, grid), on_grid(v.z, grid)};
}

// The hit point x = o + t d lies in the plane and on the inner side of each edge, or on it. Of a
// solid the ray meets the side from which the corners run counterclockwise.
std::optional<OracleRoot> meet(const OracleRay& ray, const Triangle& triangle, bool solid) {
    const Vec3<Integer> a = on_grid(triangle.a, ray.grid) - ray.origin;
    const Vec3<Integer> b = on_grid(triangle.b, ray.grid) - ray.origin;
    const Vec3<Integer> c = on_grid(triangle.c, ray.grid) - ray.origin;
    const Vec3<Integer> normal = cross(b - a, c - a);
    Integer denominator = dot(normal, ray.direction);
    if (denominator == 0 || (solid && denominator > 0)) return std::nullopt;
    Integer numerator = dot(normal, a);
    if (denominator < 0) {
        denominator = -denominator;
        numerator = -numerator;
    }
    if (numerator <= 0) return std::nullopt;
    const Vec3<Integer> x = ray.direction * numerator;  // times denominator, from the origin
    const auto inner_side = [&](const Vec3<Integer>& p, const Vec3<Integer>& q) {
        return dot(cross(q - p, x - p * denominator), normal) >= 0;
    };
    if (!inner_side(a, b) || !inner_side(b, c) || !inner_side(c, a)) return std::nullopt;
    OracleRoot root;
    root.rational = true;
    root.numerator = std::move(numerator);
    root.denominator = std::move(denominator);
    return root;
}

// The first root > 0 of |f + t g|^2 = r^2; of a solid from outside only.
std::optional<OracleRoot> meet(const Vec3<Integer>& f, const Vec3<Integer>& g, const Integer& r,
                               bool solid) {
    const Integer a = dot(g, g);
    const Integer b = dot(f, g);
    const Integer c = dot(f, f) - r * r;
    if (a == 0 || r == 0) return std::nullopt;
    if (b >= 0 && c >= 0) return std::nullopt;  // no root is positive
    if (solid && c <= 0) return std::nullopt;
    const Integer discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    OracleRoot found;
    found.near_tangency = discriminant * 500'000 <= a * r * r;  // R^2 - l^2 <= 2e-6 R^2
    found.a = a;
    found.b = b;
    found.c = c;
    return found;
}

// Enough to tell apart whatever is not equal in doubles of any exponent.
using ManyDigits = mp::number<mp::cpp_bin_float<4000>, mp::et_off>;

template <typename T>
T digits_of(const OracleRoot& root) {
    if (root.rational) return T(root.numerator) / T(root.denominator);
    const T b(root.b);
    const T surd = sqrt(T(root.b * root.b - root.a * root.c));
    if (root.c > 0) return T(root.c) / (surd - b);  // the smaller root, b < 0
    return root.b <= 0 ? T((surd - b) / T(root.a)) : T(T(-root.c) / (surd + b));
}

// Whether a root of one is one of the other: the polynomial at n / m is 0, or the resultant.
bool share_a_root(const OracleRoot& p, const OracleRoot& q) {
    if (p.rational) {
        const Integer& n = p.numerator;
        const Integer& m = p.denominator;
        return n * (q.a * n + 2 * q.b * m) + q.c * m * m == 0;
    }
    if (q.rational) return share_a_root(q, p);
    const Integer outer = p.a * q.c - q.a * p.c;
    return outer * outer == 4 * (p.a * q.b - q.a * p.b) * (p.b * q.c - q.b * p.c);
}

std::optional<OracleRoot> meet(const OracleRay& ray, const Sphere& sphere, bool solid) {
    return meet(ray.origin - on_grid(sphere.center, ray.grid), ray.direction,
                on_grid(sphere.radius, ray.grid), solid);
}

// In the space of the sphere, all times the determinant.
std::optional<OracleRoot> meet(const OracleRay& ray, const Ellipsoid& ellipsoid, bool solid) {
    const Matrix3& m = ellipsoid.linear;
    const int grid =
        std::min({0, lowest_bit(m.row[0]), lowest_bit(m.row[1]), lowest_bit(m.row[2])});
    Vec3<Integer> column[3];
    for (int i = 0; i < 3; ++i) column[i] = on_grid(m.column(i), grid);
    const Vec3<Integer> dual[3] = {cross(column[1], column[2]), cross(column[2], column[0]),
                                   cross(column[0], column[1])};
    const Integer determinant = dot(column[0], dual[0]);
    const auto local = [&](const Vec3<Integer>& v) {
        return Vec3<Integer>{dot(dual[0], v) << -grid, dot(dual[1], v) << -grid,
                             dot(dual[2], v) << -grid};
    };
    return meet(local(ray.origin - on_grid(ellipsoid.center, ray.grid)), local(ray.direction),
                determinant * on_grid(ellipsoid.radius, ray.grid), solid);
}

}  // namespace

int compare(const OracleRoot& a, const OracleRoot& b) {
    if (a.rational && b.rational) {
        const Integer left = a.numerator * b.denominator;
        const Integer right = b.numerator * a.denominator;
        return left < right ? -1 : left > right ? 1 : 0;
    }
    const Real difference = a.value() - b.value();
    static const Real kSame("1e-80");
    if (abs(difference) > kSame * b.value()) return difference < 0 ? -1 : 1;
    if (share_a_root(a, b)) return 0;
    return digits_of<ManyDigits>(a) < digits_of<ManyDigits>(b) ? -1 : 1;
}

const Real& OracleRoot::value() const {
    if (!value_) value_ = digits_of<Real>(*this);
    return *value_;
}

OracleRay::OracleRay(const Ray& ray_in, int scene_grid)
    : ray(ray_in),
      grid(std::min({0, scene_grid, lowest_bit(ray.origin)})),
      direction_grid(lowest_bit(ray.direction)),
      origin(on_grid(ray.origin, grid)),
      direction(on_grid(ray.direction, direction_grid)) {}

Oracle::Oracle(const Scene& scene) : scene_(scene), grid_(0), sieve_(scene) {
    for (const Object& object : scene.objects) grid_ = std::min(grid_, lowest_bit(object.shape));
}

std::optional<OracleRoot> Oracle::root(const OracleRay& ray, std::size_t object,
                                       std::size_t triangle) const {
    const Shape& shape = scene_.objects[object].shape;
    const bool solid = scene_.objects[object].solid;
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
        return meet(ray, mesh->triangle(triangle), solid);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return meet(ray, *sphere, solid);
    return meet(ray, std::get<Ellipsoid>(shape), solid);
}

std::optional<OracleAnswer> Oracle::closest(const OracleRay& ray) const {
    constexpr long double kSlack = 1e-16L;  // the ray is exact: covers the sieve's own rounding
    std::optional<OracleAnswer> best;
    sieve_.each(Sieve::Vector(ray.ray.origin), Sieve::Vector(ray.ray.direction), kSlack,
                [&](std::size_t object, std::size_t triangle) {
                    std::optional<OracleRoot> found = root(ray, object, triangle);
                    if (found && (!best || compare(*found, best->root) < 0))
                        best = OracleAnswer{object, triangle, std::move(*found)};
                });
    return best;
}

}  // namespace nuvo::hard
