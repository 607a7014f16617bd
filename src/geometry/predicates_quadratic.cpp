#include "predicates_quadratic.h"

namespace nuvo::detail {
namespace {

/// sqrt(a * depth) and its error, for depth > 4 depth_error (else the error is infinite).
template <typename T>
struct RootPart {
    T value;
    T error;
};
template <typename T>
RootPart<T> root_part(const RoundedQuadratic<T>& q) {
    const T value = q.length * std::sqrt(q.depth);
    const T relative = q.depth_error / q.depth;
    if (!(q.depth > 0 && relative < 0.25)) return {value, std::numeric_limits<T>::infinity()};
    // sqrt(1 + x) differs from 1 by less than 0.54 |x| for |x| < 1/4.
    return {value, value * (T(0.5625) * relative + q.a_relative + gamma_of<T>(4))};
}

template <typename T>
Decision decide(T value, T error) {
    return value > error ? Decision::kYes : value < -error ? Decision::kNo : Decision::kUnsure;
}

/// Where the end of the way lies, with error bounds.
template <typename T>
struct RoundedEnd {
    bool endless;
    T power, power_error;  ///< > 0: outside of the surface
    T slope, slope_error;  ///< > 0: beyond the vertex
};
template <typename T>
RoundedEnd<T> rounded_end(const RoundedQuadratic<T>& q, double end) {
    if (std::isinf(end)) return {true, 0, 0, 0, 0};
    const T ea = end * q.a;
    const T slope_error = ea * q.a_relative + q.b_error + gamma_of<T>(2) * (ea + std::fabs(q.b));
    return {false, end * (ea + 2 * q.b) + q.c,
            end * (2 * slope_error + gamma_of<T>(4) * (ea + 2 * std::fabs(q.b))) + q.c_error +
                gamma_of<T>(2) * std::fabs(q.c),
            ea + q.b, slope_error};
}

}  // namespace

template <typename T>
Decision rounded_hit(const RoundedQuadratic<T>& q, Sides sides, SphereHit& hit) {
    const bool outside = q.c > q.c_error;
    if (outside && (q.b > q.b_error || q.depth < -q.depth_error)) return Decision::kNo;
    const bool enters = outside && q.b < -q.b_error && q.depth > q.depth_error;
    const bool inside = q.c < -q.c_error;
    // The far root is seen from within; to meet the near one the origin has to lie outside.
    if (sides == Sides::kFront && (inside || q.b > q.b_error)) return Decision::kNo;
    if (!enters && !inside) return Decision::kUnsure;
    constexpr double kShare = 0.4375 * root_tolerance();  // two of these and some roundings
    const RootPart<T> root = root_part(q);
    const T sum = std::fabs(q.b) + root.value;
    const T sum_error = q.b_error + root.error + gamma_of<T>(1) * sum;
    if (!(sum_error <= kShare * sum)) return Decision::kUnsure;
    double t = 0;
    if (inside && q.b <= 0) {
        if (!(q.a_relative <= kShare)) return Decision::kUnsure;
        t = static_cast<double>(sum / q.a);
    } else {
        if (!(q.c_error <= kShare * std::fabs(q.c))) return Decision::kUnsure;
        t = static_cast<double>(std::fabs(q.c) / sum);
    }
    if (!(t > kSmallestRoot && t < kLargestRoot)) return Decision::kUnsure;
    hit = {{t, t * (1 - root_tolerance()), t * (1 + root_tolerance())},
           inside ? SphereRoot::kFar : SphereRoot::kNear};
    return Decision::kYes;
}

namespace {

/// b < 0, and the line meets the surface, all of it before an end that lies outside.
template <typename T>
Decision passes_through(const RoundedQuadratic<T>& q, const RoundedEnd<T>& end) {
    const Decision enters = decide(-q.b, q.b_error);
    if (enters != Decision::kYes) return enters;
    const Decision meets = decide(q.depth, q.depth_error);
    if (meets == Decision::kNo || end.endless) return meets;
    const Decision outside = decide(end.power, end.power_error);
    const Decision beyond = decide(end.slope, end.slope_error);
    if (outside == Decision::kNo) return Decision::kNo;
    if (outside == Decision::kYes && beyond == Decision::kNo) return Decision::kNo;
    const bool all = meets == Decision::kYes && outside == meets && beyond == meets;
    return all ? Decision::kYes : Decision::kUnsure;
}

}  // namespace

template <typename T>
Decision rounded_blocks(const RoundedQuadratic<T>& q, double end_t, const Bounded<T>& band,
                        bool on_it, Sides sides) {
    const RoundedEnd<T> end = rounded_end(q, end_t);
    const T size = std::fabs(q.c);
    const T size_error = q.c_error + band.error;
    if (on_it) {
        // The lit point itself has c = 0, so its other root lies in (0, end) iff b < 0 and the end
        // lies outside, which does not depend on how the point was rounded.
        const Decision enters = decide(-q.b, q.b_error);
        if (enters != Decision::kYes || end.endless) return enters;
        return decide(end.power, end.power_error);
    }
    if (!(size > band.value + size_error)) {
        if (!(size + size_error < band.value)) return Decision::kUnsure;
        return passes_through(q, end);
    }
    if (q.c < 0) return end.endless ? Decision::kYes : decide(end.power, end.power_error);
    if (q.b > q.b_error || q.depth < -q.depth_error) return Decision::kNo;
    if (!(q.b < -q.b_error && q.depth > q.depth_error)) return Decision::kUnsure;
    if (end.endless) return Decision::kYes;
    // The front that the end sees is where the way leaves the solid: at the far root.
    if (end.power < -end.power_error) return sides == Sides::kBoth ? Decision::kYes : Decision::kNo;
    const bool ends_outside = end.power > end.power_error;
    if (end.slope > end.slope_error && (ends_outside || sides == Sides::kBoth))
        return Decision::kYes;
    return end.slope < -end.slope_error && ends_outside ? Decision::kNo : Decision::kUnsure;
}

template <typename T>
RoundedOffset<T> rounded_offset(const RoundedQuadratic<T>& q, SphereRoot which) {
    const RootPart<T> root = root_part(q);
    const T along = root.value / q.a;
    const Vec3<T> part = q.g * along;
    // |part| = root / |g|; g itself may be off by a_relative.
    const T error = q.offset_error + (root.error / root.value + 2 * q.a_relative + gamma_of<T>(4)) *
                                         (root.value / q.length);
    return {which == SphereRoot::kNear ? q.l - part : q.l + part, error};
}

template Decision rounded_hit(const RoundedQuadratic<double>&, Sides, SphereHit&);
template Decision rounded_hit(const RoundedQuadratic<long double>&, Sides, SphereHit&);
template Decision rounded_blocks(const RoundedQuadratic<double>&, double, const Bounded<double>&,
                                 bool, Sides);
template Decision rounded_blocks(const RoundedQuadratic<long double>&, double,
                                 const Bounded<long double>&, bool, Sides);
template RoundedOffset<double> rounded_offset(const RoundedQuadratic<double>&, SphereRoot);
template RoundedOffset<long double> rounded_offset(const RoundedQuadratic<long double>&,
                                                   SphereRoot);

}  // namespace nuvo::detail
