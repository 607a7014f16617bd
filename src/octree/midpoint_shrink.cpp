#include <algorithm>

#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/midpoint.h"

namespace nuvo {
namespace {

// Below this share of the voxel's width the items' box is reached by fewer cuts, two, at its faces
// than through centres.
constexpr double kClose = 0.25;

// Where on one axis the items lie that a plane can part from others: those that end within.
struct Extent {
    double low = kInfinity;
    double high = -kInfinity;

    Extent(const SplitQuery& query, int axis) {
        const Bounds3& voxel = query.voxel.bounds;
        for (const Bounds3& box : query.boxes) {
            if (box.min[axis] <= voxel.min[axis] && box.max[axis] >= voxel.max[axis]) continue;
            low = std::min(low, std::max(box.min[axis], voxel.min[axis]));
            high = std::max(high, std::min(box.max[axis], voxel.max[axis]));
        }
    }
};

}  // namespace

MidpointStrategy shrinking(MidpointStrategy strategy) {
    return [strategy = std::move(strategy)](const SplitQuery& query) {
        std::optional<Point3> planes = strategy(query);
        const Bounds3& voxel = query.voxel.bounds;
        const double clearance = 4 * query.margin;
        for (int axis = 0; axis < 3; ++axis) {
            const Extent items(query, axis);
            const double width = items.high - items.low;
            if (!(0 <= width && width < kClose * voxel.widths()[axis])) continue;
            if (!planes) planes = voxel.center();
            const double below = items.low - voxel.min[axis];
            const double above = voxel.max[axis] - items.high;
            (*planes)[axis] = below > above ? items.low - clearance : items.high + clearance;
        }
        return planes;
    };
}

}  // namespace nuvo
