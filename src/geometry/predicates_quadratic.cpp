#include "predicates_quadratic.h"

namespace nuvo::detail {
namespace {

/// sqrt(a * depth) and its error, for depth > 4 depth_error (else the error is infinite).
struct RootPart {
    double value;
    double error;
};
RootPart root_part(const RoundedQuadratic& q) {
    const double value = q.length * std::sqrt(q.depth);
    const double relative = q.depth_error / q.depth;
    if (!(q.depth > 0 && relative < 0.25)) return {value, std::numeric_limits<double>::infinity()};
    // sqrt(1 + x) differs from 1 by less than 0.54 |x| for |x| < 1/4.
    return {value, value * (0.5625 * relative + q.a_relative + gamma(4))};
}

}  // namespace

Decision rounded_hit(const RoundedQuadratic& q, SphereHit& hit) {
    const bool outside = q.c > q.c_error;
    if (outside && (q.b > q.b_error || q.depth < -q.depth_error)) return Decision::kNo;
    const bool enters = outside && q.b < -q.b_error && q.depth > q.depth_error;
    const bool inside = q.c < -q.c_error;
    if (!enters && !inside) return Decision::kUnsure;
    constexpr double kShare = 0.4375 * root_tolerance();  // two of these and some roundings
    const RootPart root = root_part(q);
    const double sum = std::fabs(q.b) + root.value;
    const double sum_error = q.b_error + root.error + gamma(1) * sum;
    if (!(sum_error <= kShare * sum)) return Decision::kUnsure;
    double t = 0;
    if (inside && q.b <= 0) {
        if (!(q.a_relative <= kShare)) return Decision::kUnsure;
        t = sum / q.a;
    } else {
        if (!(q.c_error <= kShare * std::fabs(q.c))) return Decision::kUnsure;
        t = std::fabs(q.c) / sum;
    }
    if (!(t > kSmallestRoot && t < kLargestRoot)) return Decision::kUnsure;
    hit = {{t, t * (1 - root_tolerance()), t * (1 + root_tolerance())},
           inside ? SphereRoot::kFar : SphereRoot::kNear};
    return Decision::kYes;
}

Decision rounded_blocks(const RoundedQuadratic& q, double end, double band, bool touches) {
    const auto decide = [](double value, double error) {
        return value > error ? Decision::kYes : value < -error ? Decision::kNo : Decision::kUnsure;
    };
    const bool endless = std::isinf(end);
    const double size = std::fabs(q.c);
    if (!touches && !(size > band + q.c_error)) {
        if (!(size + q.c_error < band)) return Decision::kUnsure;
        touches = true;
    }
    const double ea = endless ? 0 : end * q.a;
    const double slope_error = ea * q.a_relative + q.b_error + gamma(2) * (ea + std::fabs(q.b));
    const double value = endless ? 0 : end * (ea + 2 * q.b) + q.c;
    const double value_error =
        endless ? 0
                : end * (2 * slope_error + gamma(4) * (ea + 2 * std::fabs(q.b))) + q.c_error +
                      gamma(2) * size;
    if (touches) {
        // The lit point itself has c = 0, so its other root lies in (0, end) iff b < 0 and the end
        // lies outside: value > 0, which does not depend on how the point was rounded.
        const Decision enters = decide(-q.b, q.b_error);
        if (enters != Decision::kYes || endless) return enters;
        return decide(value, value_error);
    }
    if (q.c < 0) return endless ? Decision::kYes : decide(value, value_error);
    if (q.b > q.b_error || q.depth < -q.depth_error) return Decision::kNo;
    if (!(q.b < -q.b_error && q.depth > q.depth_error)) return Decision::kUnsure;
    if (endless || ea + q.b > slope_error || value < -value_error) return Decision::kYes;
    return ea + q.b < -slope_error && value > value_error ? Decision::kNo : Decision::kUnsure;
}

RoundedOffset rounded_offset(const RoundedQuadratic& q, SphereRoot which) {
    const RootPart root = root_part(q);
    const double along = root.value / q.a;
    const Vector3 part = q.g * along;
    // |part| = root / |g|; g itself may be off by a_relative.
    const double error = q.offset_error + (root.error / root.value + 2 * q.a_relative + gamma(4)) *
                                              (root.value / q.length);
    return {which == SphereRoot::kNear ? q.l - part : q.l + part, error};
}

}  // namespace nuvo::detail
