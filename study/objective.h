#pragma once

#include <span>
#include <vector>

#include "nuvo/octree/midpoint.h"

/// The objectives of the sources, one axis at a time, and their exact minima.
namespace nuvo::study {

/// What a side of the plane is weighted by.
enum class Weight {
    kShare,  ///< its share of the voxel's width: b and 1 - b of eq. 19
    kArea,   ///< its surface area, halved: LSA and RSA of eq. 11 and 12
};

/// Where planes are looked for.
enum class Space {
    kMedians,  ///< between the spatial and the object median [thesis 3.2, Octree-R]
    kVoxel,    ///< the whole voxel
};

/// The interval of one axis; empty where the median lies on or outside a face and planes are looked
/// for between the medians: the thesis' null pointer.
struct Interval {
    double low = 0;
    double high = 0;
    bool empty() const { return !(low <= high); }
};
Interval interval_of(const SplitQuery& query, int axis, Space space);

/// weight of the lower side x L + weight of the upper side x R on one axis, with L the boxes that
/// begin below the plane and R those that end above it. Linear between the edges of boxes.
class AxisObjective {
  public:
    AxisObjective(const SplitQuery& query, int axis, Weight weight);

    struct Minimum {
        double plane = 0;
        double value = 0;
        /// -1: the plane is where a box begins, and may move down; 1: where one ends, and may move
        /// up; 0: neither.
        int clear_side = 0;
    };

    double operator()(double plane) const;
    /// The least value over the closed interval: it is taken at an edge or at an end, for the
    /// counts are least there of all points near by. Of equal planes the one nearest the centre.
    Minimum least(const Interval& interval) const;

  private:
    double below(double plane) const { return offset_ + slope_ * (plane - low_); }
    double above(double plane) const { return offset_ + slope_ * (high_ - plane); }

    AxisEdges edges_;
    double low_;
    double high_;
    double offset_ = 0;
    double slope_ = 0;
};

/// The product over the axes for Weight::kShare [eq. 19], their sum for Weight::kArea.
double objective(const SplitQuery& query, const Point3& planes, Weight weight);
/// Its exact minimum; none where an interval is empty.
std::optional<double> least_objective(const SplitQuery& query, Weight weight, Space space);

/// The exact minimum's planes, moved clear of the edges that they belong to, so that the box at the
/// edge is listed on one side.
std::optional<Point3> exact_midpoint(const SplitQuery& query, Weight weight, Space space);

}  // namespace nuvo::study
