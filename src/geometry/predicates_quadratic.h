#pragma once

#include "predicates_bounded.h"
#include "predicates_exact.h"

/// The rounded stages for spheres and ellipsoids, in T: double or long double. Internal to the
/// predicates.
namespace nuvo::detail {

/// a t^2 + 2 b t + c with error bounds; depth = R^2 - |l|^2 = discriminant / a (Haines' form),
/// whose sign says whether the line meets the surface. NaN: out of range, decide nothing.
template <typename T>
struct RoundedQuadratic {
    Vec3<T> f;  ///< origin seen from the centre
    Vec3<T> g;  ///< direction
    Vec3<T> l;  ///< f without its part along g
    T a, a_relative;
    T length;  ///< |g|
    T b, b_error;
    T c, c_error;
    T depth, depth_error;
    T f_norm;        ///< |f|
    T offset_error;  ///< bounds the error of l, also along g

    void decide_nothing() {
        b_error = c_error = depth_error = offset_error = std::numeric_limits<T>::quiet_NaN();
    }
};
template <typename T = double>
RoundedQuadratic<T> rounded_quadratic(const ExactRay& ray, const Sphere& sphere);
template <typename T = double>
RoundedQuadratic<T> rounded_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid);

/// What an error of the origin of up to `origin_error` per component can add to |c|.
template <typename T>
Bounded<T> rounded_touch_band(const RoundedQuadratic<T>& q, const Sphere&, double origin_error);
template <typename T>
Bounded<T> rounded_touch_band(const RoundedQuadratic<T>& q, const Ellipsoid&, double origin_error);

enum class Decision : std::uint8_t { kNo, kYes, kUnsure };

/// kYes fills `hit`.
template <typename T>
Decision rounded_hit(const RoundedQuadratic<T>& q, Sides sides, SphereHit& hit);
/// `band`: rounded_touch_band(); `on_it`: the origin stands for a point of it.
template <typename T>
Decision rounded_blocks(const RoundedQuadratic<T>& q, double end, const Bounded<T>& band,
                        bool on_it, Sides sides);

/// Else the exact stage follows the one in double at once.
inline constexpr bool kLongDoubleIsWider =
    std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits;
/// No product of eight doubles leaves the range of T: it needs no range tests. [numerics: ranges]
template <typename T>
inline constexpr bool kBoundless = std::numeric_limits<T>::min_exponent < -8 * 1074;

template <typename Quadric>
[[gnu::cold, gnu::noinline]] std::optional<SphereHit> slow_quadric_hit(const ExactRay& ray,
                                                                       const Quadric& quadric,
                                                                       Sides sides,
                                                                       StageCounts& counts) {
    ++counts.wider;
    if constexpr (kLongDoubleIsWider) {
        SphereHit hit;
        const Decision decision =
            rounded_hit(rounded_quadratic<long double>(ray, quadric), sides, hit);
        if (decision == Decision::kNo) return std::nullopt;
        if (decision == Decision::kYes) return hit;
    }
    ++counts.exact;
    return exact_hit(exact_quadratic(ray, quadric), sides);
}

/// hit() of a sphere or an ellipsoid: in long double, then exactly, where doubles are not sure.
template <typename Quadric>
std::optional<SphereHit> quadric_hit(const ExactRay& ray, const Quadric& quadric, Sides sides,
                                     StageCounts& counts) {
    SphereHit hit;
    switch (rounded_hit(rounded_quadratic(ray, quadric), sides, hit)) {
        case Decision::kNo:
            return std::nullopt;
        case Decision::kYes:
            return hit;
        case Decision::kUnsure:
            break;
    }
    return slow_quadric_hit(ray, quadric, sides, counts);
}

template <typename T, typename Quadric>
Decision try_blocks(const ExactRay& shadow, double end, double origin_error, const Quadric& quadric,
                    bool origin_on_it, Sides sides) {
    const RoundedQuadratic<T> q = rounded_quadratic<T>(shadow, quadric);
    return rounded_blocks(q, end, rounded_touch_band(q, quadric, origin_error), origin_on_it,
                          sides);
}

template <typename Quadric>
[[gnu::cold, gnu::noinline]] bool slow_quadric_blocks(const ExactRay& shadow, double end,
                                                      double origin_error, const Quadric& quadric,
                                                      bool origin_on_it, Sides sides,
                                                      StageCounts& counts) {
    ++counts.wider;
    if constexpr (kLongDoubleIsWider) {
        const Decision decision =
            try_blocks<long double>(shadow, end, origin_error, quadric, origin_on_it, sides);
        if (decision != Decision::kUnsure) return decision == Decision::kYes;
    }
    ++counts.exact;
    const ExactQuadratic exact = exact_quadratic(shadow, quadric);
    return exact_blocks(
        exact, end,
        origin_place(exact, origin_on_it,
                     [&] { return exact_touch_band(exact, quadric, origin_error); }),
        sides);
}

/// blocks() of a sphere or an ellipsoid: the same.
template <typename Quadric>
bool quadric_blocks(const ExactRay& shadow, double end, double origin_error, const Quadric& quadric,
                    bool origin_on_it, Sides sides, StageCounts& counts) {
    const Decision decision =
        try_blocks<double>(shadow, end, origin_error, quadric, origin_on_it, sides);
    if (decision != Decision::kUnsure) return decision == Decision::kYes;
    return slow_quadric_blocks(shadow, end, origin_error, quadric, origin_on_it, sides, counts);
}

/// f + t g with its error in 2-norm.
template <typename T>
struct RoundedOffset {
    Vec3<T> offset;
    T error;
};
template <typename T>
RoundedOffset<T> rounded_offset(const RoundedQuadratic<T>& q, SphereRoot which);

template <typename T>
inline Rows<T> rows_of(const Matrix3& m) {
    return {{Vec3<T>(m.row[0]), Vec3<T>(m.row[1]), Vec3<T>(m.row[2])}};
}

template <typename T>
struct BoundedMatrix {
    Rows<T> value;
    Rows<T> magnitude;  ///< gamma(4) times this bounds the error
};

template <typename T>
inline BoundedMatrix<T> bounded_adjugate(const Matrix3& m) {
    const Vec3<T> r0(m.row[0]);
    const Vec3<T> r1(m.row[1]);
    const Vec3<T> r2(m.row[2]);
    const Rows<T> magnitudes{
        {cross_magnitude(r1, r2), cross_magnitude(r2, r0), cross_magnitude(r0, r1)}};
    return {adjugate_of(r0, r1, r2), magnitudes.transposed()};
}

template <typename T>
inline Bounded<T> determinant(const Matrix3& m, const BoundedMatrix<T>& adjugate) {
    const Vec3<T> row(m.row[0]);
    return {dot(row, adjugate.value.column(0)),
            gamma_of<T>(8) * dot(magnitude(row), adjugate.magnitude.column(0)) +
                64 * underflow_of<T>() * (norm1(row) + 1)};
}

/// A vector with a bound of its error in 2-norm.
template <typename T>
struct BoundedVector {
    Vec3<T> value;
    T error;
};

/// m * v for v known within a roundoff: 2 (m) + 1 (v) + 3 (dot product) roundings, and underflow.
template <typename T>
inline BoundedVector<T> product(const BoundedMatrix<T>& m, const Vec3<T>& v) {
    return {m.value * v, gamma_of<T>(8) * sum(m.magnitude * magnitude(v)) +
                             64 * underflow_of<T>() * (norm1(v) + 1)};
}

/// The sign of t_a - t_b for two hits on quadrics, where doubles are sure of it.
std::optional<int> sure_order(const ExactRay& ray, const HitPrimitive& a, const HitPrimitive& b);

}  // namespace nuvo::detail
