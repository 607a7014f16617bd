#include "nuvo/octree/midpoint.h"
#include "nuvo/math/error_bounds.h"

#include <algorithm>
#include <cmath>

namespace nuvo {

std::optional<Point3> spatial_midpoint(const SplitQuery& query) {
    return query.voxel.bounds.center();
}

double object_median(std::span<const Bounds3> boxes, int axis) {
    std::vector<double> centers;
    centers.reserve(boxes.size());
    for (const Bounds3& box : boxes) centers.push_back(box.center()[axis]);
    const auto middle = centers.begin() + static_cast<std::ptrdiff_t>(centers.size() / 2);
    std::nth_element(centers.begin(), middle, centers.end());
    if (centers.size() % 2 == 1) return *middle;
    return (*std::max_element(centers.begin(), middle) + *middle) / 2;
}

AxisEdges::AxisEdges(std::span<const Bounds3> boxes, int axis) {
    begins_.reserve(boxes.size());
    ends_.reserve(boxes.size());
    for (const Bounds3& box : boxes) {
        begins_.push_back(box.min[axis]);
        ends_.push_back(box.max[axis]);
    }
    std::sort(begins_.begin(), begins_.end());
    std::sort(ends_.begin(), ends_.end());
}

std::size_t AxisEdges::left_of(double plane) const {
    return static_cast<std::size_t>(std::lower_bound(begins_.begin(), begins_.end(), plane) -
                                    begins_.begin());
}

std::size_t AxisEdges::right_of(double plane) const {
    return static_cast<std::size_t>(ends_.end() -
                                    std::upper_bound(ends_.begin(), ends_.end(), plane));
}

MidpointScore::MidpointScore(const SplitQuery& query)
    : voxel_(query.voxel.bounds),
      widths_(query.voxel.bounds.widths()),
      edges_{{query.boxes, 0}, {query.boxes, 1}, {query.boxes, 2}} {}

double MidpointScore::product(const Point3& midpoint) const {
    double score = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = (midpoint[axis] - voxel_.min[axis]) / widths_[axis];
        score *= of_axis(axis, midpoint[axis], below, 1);
    }
    return score;
}

double MidpointScore::sum(const Point3& midpoint) const {
    double score = 0;
    for (int axis = 0; axis < 3; ++axis)
        score += of_axis(axis, midpoint[axis], midpoint[axis] - voxel_.min[axis], widths_[axis]);
    return score;
}

double MidpointScore::of_axis(int axis, double plane, double below, double whole) const {
    return below * static_cast<double>(edges_[axis].left_of(plane)) +
           (whole - below) * static_cast<double>(edges_[axis].right_of(plane));
}

namespace {

// How far a plane stays from the edge that it belongs to where no margin says so, as a share of the
// voxel's width: more than roundings of the published walk, which steps past faces, and little
// area.
constexpr double kClearance = 0x1p-10;

// The best plane of one axis, or the centre where no edge offers one.
double swept_plane(const SplitQuery& query, int axis) {
    const Bounds3& box = query.voxel.bounds;
    const Vector3 w = box.widths();
    const double across = w[(axis + 1) % 3] * w[(axis + 2) % 3];  // area of the cut
    const double around = w[(axis + 1) % 3] + w[(axis + 2) % 3];  // half its perimeter
    const double clearance = query.margin > 0 ? 4 * query.margin : kClearance * w[axis];
    const AxisEdges edges(query.boxes, axis);
    // As items are placed: one that touches the plane lies on both sides.
    const auto count_left = [&](double plane) {
        return std::upper_bound(edges.begins().begin(), edges.begins().end(), plane) -
               edges.begins().begin();
    };
    const auto count_right = [&](double plane) {
        return edges.ends().end() -
               std::lower_bound(edges.ends().begin(), edges.ends().end(), plane);
    };

    double best_plane = box.center()[axis];
    double best_cost = kInfinity;
    const auto consider = [&](double plane) {
        // Nearer to a face it would cut off nothing but a sliver.
        if (!(plane - box.min[axis] >= 4 * clearance && box.max[axis] - plane >= 4 * clearance))
            return;
        const double left_area = across + (plane - box.min[axis]) * around;
        const double right_area = across + (box.max[axis] - plane) * around;
        const double cost = left_area * static_cast<double>(count_left(plane)) +
                            right_area * static_cast<double>(count_right(plane));
        if (cost < best_cost) {
            best_cost = cost;
            best_plane = plane;
        }
    };
    // Between edges the cost is linear, so its least value is at an edge: just below a beginning
    // or just above an end.
    consider(best_plane);
    for (double begin : edges.begins()) consider(begin - clearance);
    for (double end : edges.ends()) consider(end + clearance);
    return best_plane;
}

}  // namespace

std::optional<Point3> sweep_midpoint(const SplitQuery& query) {
    return Point3{swept_plane(query, 0), swept_plane(query, 1), swept_plane(query, 2)};
}

}  // namespace nuvo
