#include "plane_root.h"
#include "predicates_exact.h"
#include "predicates_quadratic.h"

namespace nuvo {
namespace {

using detail::Bounded;
using detail::ExactPlaneRoot;
using detail::ExactQuadratic;

struct QuadraticRoot {
    ExactQuadratic quadratic;
    int side;  ///< -1 near, 1 far: t = (-b + side sqrt(D)) / a
};

using ExactRoot = std::variant<ExactPlaneRoot, QuadraticRoot>;

ExactRoot exact_root(const ExactRay& ray, const HitPrimitive& hit) {
    return std::visit(
        [&](const auto* primitive) -> ExactRoot {
            if constexpr (std::is_same_v<decltype(primitive), const Triangle*>) {
                ExactPlaneRoot root = detail::exact_plane_root(ray, *primitive);
                if (root.denominator.sign() < 0) {
                    root.numerator = -root.numerator;
                    root.denominator = -root.denominator;
                }
                return root;
            } else {
                return QuadraticRoot{detail::exact_quadratic(ray, *primitive),
                                     hit.which == SphereRoot::kNear ? -1 : 1};
            }
        },
        hit.primitive);
}

int order(const ExactPlaneRoot& a, const ExactPlaneRoot& b) {
    return compare(a.numerator * b.denominator, b.numerator * a.denominator);
}

/// p / q against a root: by the parabola's sign at p / q and the side of its vertex.
int order(const ExactPlaneRoot& plane, const QuadraticRoot& root) {
    const ExactQuadratic& f = root.quadratic;
    const Exact& p = plane.numerator;
    const Exact& q = plane.denominator;
    const Exact slope = f.a * p + f.b * q;
    const int value = (p * (slope + f.b * q) + f.c * q * q).sign();
    const int side = slope.sign();
    if (value < 0) return -root.side;  // between the roots
    if (value == 0 && (side == root.side || side == 0)) return 0;
    return side;
}

int sign_product(int a, int b) { return a * b; }

/// The sign of p + s sqrt(x) + r sqrt(y), with s, r = -1 or 1, x, y >= 0.
int sign_of_surds(const Exact& p, int s, const Exact& x, int r, const Exact& y) {
    int surds = 0;
    if (s == r) {
        surds = x.sign() + y.sign() > 0 ? s : 0;
    } else {
        surds = s * compare(x, y);
    }
    if (sign_product(p.sign(), surds) >= 0) return p.sign() != 0 ? p.sign() : surds;
    // Opposite: the sign of p^2 - (x + y + 2 s r sqrt(x y)) tells which is larger.
    const Exact rest = p * p - x - y;
    const Exact square = Exact(4) * x * y;
    const int cross = square.sign() * s * r;
    int larger = 0;
    if (rest.sign() != cross || cross == 0) {
        larger = compare(Exact(rest.sign()), Exact(cross));
    } else {
        larger = cross * compare(rest * rest, square);
    }
    return p.sign() * larger;
}

int order(const QuadraticRoot& a, const QuadraticRoot& b) {
    const ExactQuadratic& f = a.quadratic;
    const ExactQuadratic& g = b.quadratic;
    // (-b1 + s1 sqrt(D1)) a2 - (-b2 + s2 sqrt(D2)) a1
    return sign_of_surds(g.b * f.a - f.b * g.a, a.side, g.a * g.a * f.discriminant(), -b.side,
                         f.a * f.a * g.discriminant());
}

int order(const QuadraticRoot& a, const ExactPlaneRoot& b) { return -order(b, a); }

/// The sign of t_a - t_b in T, where it is sure.
template <typename T>
std::optional<int> sure_order(const ExactRay& ray, const Triangle& a, const Triangle& b) {
    const detail::PlaneRoot<T> p = detail::plane_root<T>(ray, a);
    const detail::PlaneRoot<T> q = detail::plane_root<T>(ray, b);
    if (!p.denominator.sure() || !q.denominator.sure()) return std::nullopt;
    const auto product = [](const Bounded<T>& x, const Bounded<T>& y) {
        const T size = std::fabs(x.value) + x.error;
        return Bounded<T>{x.value * y.value, size * y.error + std::fabs(y.value) * x.error};
    };
    const Bounded<T> left = product(p.numerator, q.denominator);
    const Bounded<T> right = product(q.numerator, p.denominator);
    const T sizes = std::fabs(left.value) + std::fabs(right.value);
    const Bounded<T> difference{
        left.value - right.value,
        (left.error + right.error + detail::gamma_of<T>(3) * sizes) * (1 + detail::gamma_of<T>(8)) +
            4 * detail::underflow_of<T>()};
    if (!difference.sure()) return std::nullopt;
    return difference.sign() * p.denominator.sign() * q.denominator.sign();
}

/// Two in one plane are met at one t by every ray.
std::optional<int> quick_order(const ExactRay& ray, const Triangle& a, const Triangle& b,
                               StageCounts& counts) {
    if (const std::optional<int> order = sure_order<long double>(ray, a, b)) return order;
    if (coplanar(a, b, counts)) return 0;
    return std::nullopt;
}

}  // namespace

int compare_roots(const ExactRay& ray, const HitPrimitive& a, const HitPrimitive& b,
                  StageCounts& counts) {
    ++counts.wider;
    const auto* const* first = std::get_if<const Triangle*>(&a.primitive);
    const auto* const* second = std::get_if<const Triangle*>(&b.primitive);
    if (first && second)
        if (const std::optional<int> order = quick_order(ray, **first, **second, counts))
            return *order;
    if (const std::optional<int> order = detail::sure_order(ray, a, b)) return *order;
    ++counts.exact;
    return std::visit([](const auto& x, const auto& y) { return order(x, y); }, exact_root(ray, a),
                      exact_root(ray, b));
}

}  // namespace nuvo
