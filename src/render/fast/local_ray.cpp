#include "local_ray.h"

#include <cmath>

namespace nuvo {
namespace {

constexpr std::uint32_t kRow = kWideLanes;  // floats, in WideNode
constexpr std::uint32_t kToHigh = 3 * kRow;

// The power of two that brings a positive normal number to [1, 2).
double to_unit(double value) { return std::ldexp(1.0, -std::ilogb(value)); }

// The ray enters the box around 0 with this half width later than this, if it does. Axes along
// which the ray hardly moves are left out.
double before_box(const Point3& o, const Vector3& d, double half) {
    constexpr double kHardly = 0x1p-20;
    double entry = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(d[axis]) < kHardly) continue;
        const double near = d[axis] > 0 ? -half : half;
        entry = std::fmax(entry, (near - o[axis]) / d[axis]);
    }
    return entry;
}

}  // namespace

LocalRay::LocalRay(const Ray& ray, const LocalFrame& frame, float reach) {
    // Where neither a scaled direction nor a scaled coordinate is subnormal or overflows.
    constexpr double kRange = 0x1p900;
    const double size = max_norm(ray.direction);
    Point3 o = frame.local(ray.origin);
    const double far = max_norm(o);
    if (!(size > 1 / kRange && size < kRange && far < kRange)) return;
    const double unit = to_unit(size);
    const Vector3 d = ray.direction * unit;
    scale = frame.scale / unit;
    if (!(scale > 1 / kRange && scale < kRange)) return;
    valid = true;

    constexpr double kNear = 4;  // origins within this are as good as in the box
    error = 0x1p-50 * (far + 4);
    if (far > kNear) {
        // One more than the box's half width, and 4 roundings of the way.
        const double way = before_box(o, d, reach + 1.0) * (1 - 0x1p-50);
        if (way > 0) {
            advance = way;
            o = o + d * way;
        }
    }
    behind = advance > 0 ? -0.25F : 0.0F;
    signs = 0;
    double sum = 0;
    double margin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = o[axis];
        step[axis] = d[axis];
        direction[axis] = static_cast<float>(d[axis]);
        sum += std::fabs(d[axis]);
        const double size_on_axis = std::fmax(std::fabs(d[axis]), kLeastDirection);
        inverse[axis] = static_cast<float>(std::copysign(1 / size_on_axis, d[axis]));
        const double i = inverse[axis];
        const double slack = kSlabRoundings * kFloatUnit * (reach + std::fabs(o[axis])) + error;
        margin = std::fmax(margin, slack);
        near_add[axis] = static_cast<float>(-o[axis] * i - slack * std::fabs(i));
        far_add[axis] = static_cast<float>(-o[axis] * i + slack * std::fabs(i));
        const std::uint32_t row = static_cast<std::uint32_t>(axis) * kRow;
        const bool negative = std::signbit(d[axis]);
        near_offset[axis] = row + (negative ? kToHigh : 0);
        signs |= negative ? 1U << axis : 0U;
        far_offset[axis] = row + (negative ? 0 : kToHigh);
    }
    direction_sum = static_cast<float>(sum * (1 + 0x1p-22));
    square = static_cast<float>(dot(d, d));
    // A point of the ray at a box's entry lies within 2 margins of that box, which is to be less
    // than 2^14 units of the leaf's grid; and its error less than 2^-6 units.
    least_unit = static_cast<float>(std::fmax(margin * 0x1p-13, error * 0x1p6));
}

}  // namespace nuvo
