#pragma once

#include <vector>

#include "nuvo/math/vec.h"

namespace nuvo {

/// X3D Background (ISO/IEC 19775-1 clause 24). Angles are radians: the sky's from the zenith, the
/// ground's from the nadir; each list of angles has one entry fewer than its colours. Where the
/// last of the ground's angles is less than pi / 2, the sky shows between it and the horizon.
struct Background {
    std::vector<Color> sky_color{{0, 0, 0}};
    std::vector<double> sky_angle;
    std::vector<Color> ground_color;
    std::vector<double> ground_angle;
    Vector3 zenith{0, 1, 0};  ///< a unit vector

    friend bool operator==(const Background&, const Background&) = default;

    /// The colour seen along the unit vector `direction`. One sky and one ground colour without
    /// angles blend over the whole sphere [eq. 36]; all else is the standard's gradient.
    Color color(const Vector3& direction) const;
};

}  // namespace nuvo
