#pragma once

#include "predicates_bounded.h"
#include "predicates_exact.h"

/// The double stage for spheres and ellipsoids. Internal to the predicates.
namespace nuvo::detail {

/// a t^2 + 2 b t + c with error bounds; depth = R^2 - |l|^2 = discriminant / a (Haines' form),
/// whose sign says whether the line meets the surface. NaN: out of range, decide nothing.
struct RoundedQuadratic {
    Vector3 f;  ///< origin seen from the centre
    Vector3 g;  ///< direction
    Vector3 l;  ///< f without its part along g
    double a, a_relative;
    double length;  ///< |g|
    double b, b_error;
    double c, c_error;
    double depth, depth_error;
    double f_norm;        ///< |f|
    double offset_error;  ///< bounds the error of l, also along g
};
RoundedQuadratic rounded_quadratic(const ExactRay& ray, const Sphere& sphere);
RoundedQuadratic rounded_quadratic(const ExactRay& ray, const Ellipsoid& ellipsoid);

/// What an error of the origin of up to `origin_error` per component can add to |c|.
Bounded<double> rounded_touch_band(const RoundedQuadratic& q, const Sphere&, double origin_error);
Bounded<double> rounded_touch_band(const RoundedQuadratic& q, const Ellipsoid&,
                                   double origin_error);

enum class Decision : std::uint8_t { kNo, kYes, kUnsure };

/// kYes fills `hit`.
Decision rounded_hit(const RoundedQuadratic& q, Sides sides, SphereHit& hit);
/// `band`: rounded_touch_band(); `on_it`: the origin stands for a point of it.
Decision rounded_blocks(const RoundedQuadratic& q, double end, const Bounded<double>& band,
                        bool on_it, Sides sides);

/// hit() of a sphere or an ellipsoid: exactly where doubles are not sure.
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
    ++counts.wider;
    ++counts.exact;
    return exact_hit(exact_quadratic(ray, quadric), sides);
}

/// blocks() of a sphere or an ellipsoid: the same.
template <typename Quadric>
bool quadric_blocks(const ExactRay& shadow, double end, double origin_error, const Quadric& quadric,
                    bool origin_on_it, Sides sides, StageCounts& counts) {
    const RoundedQuadratic q = rounded_quadratic(shadow, quadric);
    const Decision decision =
        rounded_blocks(q, end, rounded_touch_band(q, quadric, origin_error), origin_on_it, sides);
    if (decision != Decision::kUnsure) return decision == Decision::kYes;
    ++counts.wider;
    ++counts.exact;
    const ExactQuadratic exact = exact_quadratic(shadow, quadric);
    return exact_blocks(
        exact, end,
        origin_place(exact, origin_on_it,
                     [&] { return exact_touch_band(shadow, quadric, origin_error); }),
        sides);
}

/// f + t g with its error in 2-norm.
struct RoundedOffset {
    Vector3 offset;
    double error;
};
RoundedOffset rounded_offset(const RoundedQuadratic& q, SphereRoot which);

struct BoundedMatrix {
    Matrix3 value;
    Matrix3 magnitude;  ///< gamma(4) times this bounds the error
};

inline BoundedMatrix bounded_adjugate(const Matrix3& m) {
    const Matrix3 magnitudes{{cross_magnitude(m.row[1], m.row[2]),
                              cross_magnitude(m.row[2], m.row[0]),
                              cross_magnitude(m.row[0], m.row[1])}};
    return {m.adjugate(), magnitudes.transposed()};
}

inline Bounded<double> determinant(const Matrix3& m, const BoundedMatrix& adjugate) {
    return {dot(m.row[0], adjugate.value.column(0)),
            gamma(8) * dot(magnitude(m.row[0]), adjugate.magnitude.column(0)) +
                64 * kUnderflow * (norm1(m.row[0]) + 1)};
}

/// A vector with a bound of its error in 2-norm.
struct BoundedVector {
    Vector3 value;
    double error;
};

/// m * v for v known within a roundoff: 2 (m) + 1 (v) + 3 (dot product) roundings, and underflow.
inline BoundedVector product(const BoundedMatrix& m, const Vector3& v) {
    return {m.value * v,
            gamma(8) * sum(m.magnitude * magnitude(v)) + 64 * kUnderflow * (norm1(v) + 1)};
}

/// The sign of t_a - t_b for two hits on quadrics, where doubles are sure of it.
std::optional<int> sure_order(const ExactRay& ray, const HitPrimitive& a, const HitPrimitive& b);

}  // namespace nuvo::detail
