#pragma once

#include <cmath>

#include "nuvo/math/bounds.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/label.h"

namespace nuvo {

/// A box with the point it is cut at. Faces and midpoint are stored and widths derived, so that
/// neighbours share their faces to the bit. [thesis 4.4, fig. 16]
struct Voxel {
    Bounds3 bounds;
    Point3 midpoint;

    /// A voxel that would be cut at its spatial centre.
    static constexpr Voxel centered(const Bounds3& bounds) { return {bounds, bounds.center()}; }

    /// The thesis' +x, +y, +z and -x, -y, -z widths. [fig. 16]
    constexpr Vector3 positive_width() const { return bounds.max - midpoint; }
    constexpr Vector3 negative_width() const { return midpoint - bounds.min; }

    /// Digit 1..8 of the octant that holds p; octants are half-open: a point on the midpoint's
    /// plane belongs to the upper side. [COMP1011]
    constexpr int octant_of(const Point3& p) const {
        return octant_digit((p.x >= midpoint.x ? 1 : 0) | (p.y >= midpoint.y ? 2 : 0) |
                            (p.z >= midpoint.z ? 4 : 0));
    }
    /// The box of octant `digit` (1..8). [thesis appendix D]
    constexpr Bounds3 octant(int digit) const {
        const int bits = octant_bits(digit);
        Bounds3 box;
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = (bits >> axis & 1) != 0;
            box.min[axis] = upper ? midpoint[axis] : bounds.min[axis];
            box.max[axis] = upper ? bounds.max[axis] : midpoint[axis];
        }
        return box;
    }
    /// Half-open containment: bottom, left and front faces in; top, right and back out. [COMP1011]
    constexpr bool contains(const Point3& p) const {
        return bounds.min.x <= p.x && p.x < bounds.max.x && bounds.min.y <= p.y &&
               p.y < bounds.max.y && bounds.min.z <= p.z && p.z < bounds.max.z;
    }
};

/// Whether the box is at most 8 units in the last place of its coordinates thick on that axis: each
/// half must still hold points that differ from its faces.
inline bool too_thin_to_cut(const Bounds3& box, int axis) {
    constexpr double kThinnestUlps = 8;
    const double size = std::fmax(std::fabs(box.min[axis]), std::fabs(box.max[axis]));
    const double ulp = std::nextafter(size, kInfinity) - size;
    return !(box.max[axis] - box.min[axis] > kThinnestUlps * ulp);
}

}  // namespace nuvo
