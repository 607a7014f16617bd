#pragma once

#include <cmath>

#include "fields.h"
#include "nuvo/math/affine.h"

namespace nuvo::x3d {

inline bool is_finite(const Vector3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Where a node stands: the product of its ancestors' Transforms, and what is known about it from
/// their scale fields rather than from rounded matrices.
struct Placement {
    Affine3 to_world;
    bool uniform = true;    ///< every scale so far is equal along its three axes, up to signs
    bool mirrored = false;  ///< right-handed turns left-handed: the determinant is negative
    bool singular = false;  ///< some scale is zero
    /// World units in one local unit: the product of |scale| where `uniform`, else the cube root of
    /// |determinant|.
    double length_scale = 1;
    Matrix3 turn;  ///< the product of the rotation fields alone

    /// The placement of the children of a Transform that stands here:
    /// P' = T C R SR S -SR -C P (ISO/IEC 19775-1 clause 10).
    Placement inside(const Fields& transform) const;
    /// The same with all lengths multiplied.
    Placement scaled(double factor) const;
    /// A normal in world space, up to length: by the inverse transpose. Not for singular
    /// placements.
    Vector3 normal(const Vector3& local) const;
};

}  // namespace nuvo::x3d
