#include "objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nuvo::study {
namespace {

/// As in the program's sweep: how far a plane stands clear where no margin says so.
constexpr double kClearance = 0x1p-10;

}  // namespace

Interval interval_of(const SplitQuery& query, int axis, Space space) {
    const Bounds3& box = query.voxel.bounds;
    if (space == Space::kVoxel) return {box.min[axis], box.max[axis]};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (query.boxes.empty()) return {kInfinity, -kInfinity};
    const double center = box.center()[axis];
    const double median = object_median(query.boxes, axis);
    for (const double m : {center, median})
        if (!(box.min[axis] < m && m < box.max[axis])) return {kInfinity, -kInfinity};
    return {std::min(center, median), std::max(center, median)};
}

AxisObjective::AxisObjective(const SplitQuery& query, int axis, Weight weight)
    : edges_(query.boxes, axis),
      low_(query.voxel.bounds.min[axis]),
      high_(query.voxel.bounds.max[axis]) {
    const Vector3 w = query.voxel.bounds.widths();
    if (weight == Weight::kShare) {
        slope_ = 1 / w[axis];
    } else {
        offset_ = w[(axis + 1) % 3] * w[(axis + 2) % 3];
        slope_ = w[(axis + 1) % 3] + w[(axis + 2) % 3];
    }
}

double AxisObjective::operator()(double plane) const {
    return below(plane) * static_cast<double>(edges_.left_of(plane)) +
           above(plane) * static_cast<double>(edges_.right_of(plane));
}

AxisObjective::Minimum AxisObjective::least(const Interval& interval) const {
    const double center = low_ + (high_ - low_) / 2;
    Minimum best{center, std::numeric_limits<double>::infinity(), 0};
    const auto consider = [&](double plane, int clear_side) {
        if (!(interval.low <= plane && plane <= interval.high)) return;
        const double value = (*this)(plane);
        if (value < best.value ||
            (value == best.value && std::fabs(plane - center) < std::fabs(best.plane - center)))
            best = {plane, value, clear_side};
    };
    for (const double begin : edges_.begins()) consider(begin, -1);
    for (const double end : edges_.ends()) consider(end, 1);
    for (const double end : {interval.low, interval.high}) consider(end, 0);
    return best;
}

double objective(const SplitQuery& query, const Point3& planes, Weight weight) {
    double product = 1, sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double value = AxisObjective(query, axis, weight)(planes[axis]);
        product *= value;
        sum += value;
    }
    return weight == Weight::kShare ? product : sum;
}

std::optional<double> least_objective(const SplitQuery& query, Weight weight, Space space) {
    double product = 1, sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Interval interval = interval_of(query, axis, space);
        if (interval.empty()) return std::nullopt;
        const double value = AxisObjective(query, axis, weight).least(interval).value;
        product *= value;
        sum += value;
    }
    return weight == Weight::kShare ? product : sum;
}

std::optional<Point3> exact_midpoint(const SplitQuery& query, Weight weight, Space space) {
    Point3 planes;
    for (int axis = 0; axis < 3; ++axis) {
        const Interval interval = interval_of(query, axis, space);
        if (interval.empty()) return std::nullopt;
        const auto least = AxisObjective(query, axis, weight).least(interval);
        const double width = query.voxel.bounds.widths()[axis];
        const double clearance = query.margin > 0 ? 4 * query.margin : kClearance * width;
        planes[axis] = least.plane + least.clear_side * clearance;
    }
    return planes;
}

}  // namespace nuvo::study
