#pragma once

#include <cmath>

#include "fast/scene/fast_scene.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/compact.h"

namespace nuvo {

/// A single ray from t = 0 to t = end through the octree of the local frame, in double: where
/// floats leave most of the items open it meets only those near the ray.
class SegmentWalk {
  public:
    SegmentWalk(const ExactRay& ray, double end, const LocalFrame& frame)
        : SegmentWalk(frame.local(ray.origin()), ray.direction() * frame.scale, end, 0) {}
    /// In the local frame, from an origin that is off by up to `error` on each axis.
    SegmentWalk(const Point3& origin, const Vector3& direction, double end, double error)
        : end_(end), error_(error) {
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = origin[axis];
            crosses_[axis] = direction[axis] != 0;
            inverse_[axis] = 1 / direction[axis];
            if (direction[axis] < 0) flip_ |= 1U << axis;
        }
    }

    /// From now on nothing beyond this is asked for.
    void end_at(double t) { end_ = t; }

    /// Calls leaf(items, count) for each leaf that the ray may meet, about from near to far, until
    /// it returns true; then returns true.
    template <typename Leaf>
    bool any(const CompactOctree& octree, Leaf&& leaf) {
        struct Place {
            std::uint32_t node;
            Bounds3T<float> voxel;
            double entry;
        };
        Place places[CompactOctree::kMostWaiting];
        int waiting = 0;
        places[waiting++] = {0, octree.bounds, 0};
        while (waiting != 0) {
            const Place at = places[--waiting];
            if (at.entry > end_) continue;
            const CompactNode& node = octree.nodes[at.node];
            if (node.is_leaf()) {
                if (leaf(octree.items.data() + node.first_item(), node.item_count())) return true;
                continue;
            }
            Interval half[3][2];  // of each axis, below and above the cut
            for (int axis = 0; axis < 3; ++axis) {
                half[axis][0] = within(axis, at.voxel.min[axis], node.cut[axis]);
                half[axis][1] = within(axis, node.cut[axis], at.voxel.max[axis]);
            }
            // The farthest first, so that the nearest is taken up next.
            for (unsigned order = 8; order-- > 0;) {
                const unsigned octant = order ^ flip_;
                if ((node.mask() >> octant & 1) == 0) continue;
                Interval t{0, end_};
                for (int axis = 0; axis < 3; ++axis) t.cut_by(half[axis][octant >> axis & 1]);
                if (t.first > t.last) continue;
                places[waiting++] = {node.child(octant), octant_box(at.voxel, node.cut, octant),
                                     t.first};
            }
        }
        return false;
    }

  private:
    // Of t. A comparison with NaN leaves out nothing.
    struct Interval {
        double first;
        double last;

        void cut_by(const Interval& other) {
            if (other.first > first) first = other.first;
            if (other.last < last) last = other.last;
        }
    };
    // In units of the origin: its rounding; of a quotient: those of the difference, of the
    // direction twice, of its inverse and of the product; and second-order terms.
    static constexpr double kOriginSlack = 4 * kUnitRoundoff;
    static constexpr double kSlack = 16 * kUnitRoundoff;

    // Where the ray is between the planes x = low and x = high, or a little longer.
    Interval within(int axis, double low, double high) const {
        const double origin = origin_[axis];
        const double slack = kOriginSlack * std::fabs(origin) + error_ + 4 * kUnderflow;
        if (!crosses_[axis])
            return origin < low - slack || origin > high + slack ? Interval{kInfinity, -kInfinity}
                                                                 : Interval{-kInfinity, kInfinity};
        const double from_low = (low - slack - origin) * inverse_[axis];
        const double from_high = (high + slack - origin) * inverse_[axis];
        const bool forward = inverse_[axis] > 0;
        const double entry = forward ? from_low : from_high;
        const double exit = forward ? from_high : from_low;
        return {entry - (kSlack * std::fabs(entry) + 4 * kUnderflow),
                exit + (kSlack * std::fabs(exit) + 4 * kUnderflow)};
    }

    double end_;
    double error_;
    double origin_[3];
    double inverse_[3];
    bool crosses_[3];
    unsigned flip_ = 0;
};

}  // namespace nuvo
