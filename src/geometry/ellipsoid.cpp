#include "nuvo/geometry/ellipsoid.h"

#include "rounding.h"

namespace nuvo {

namespace {

/// The factor that lifts radius * length(row) above its true value. With u = 2^-53: length()
/// divides by the largest component (1 u each), squares (3 u), adds twice (5 u), takes the root
/// (3.5 u) and multiplies back (4.5 u); the radius makes it 5.5 u and this factor's own product 6.5
/// u.
constexpr double half_extent_margin() { return 1 + 4 * std::numeric_limits<double>::epsilon(); }

/// At least radius * |row|: how far the image of the ball reaches along one axis.
double half_extent(const Vector3& row, double radius) {
    const double extent = radius * length(row) * half_extent_margin();
    // Where the products fall among the subnormals their error is absolute.
    return extent < std::numeric_limits<double>::min()
               ? extent + 4 * std::numeric_limits<double>::denorm_min()
               : extent;
}

}  // namespace

Bounds3 Ellipsoid::bounds() const {
    Bounds3 box{center, center};
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = half_extent(linear.row[axis], radius);
        box.min[axis] = subtract_down(center[axis], reach);
        box.max[axis] = add_up(center[axis], reach);
    }
    return box;
}

}  // namespace nuvo
