#pragma once

#include <vector>

#include "fast/tile/tile.h"

// The directions of a picture's rays in float, as sums of a column's part and a row's. The camera's
// axes are perpendicular, so the squares of their lengths are such sums, too.

namespace nuvo {

/// Column parts stand by the pixel's x, row parts four times for each y, side by side: so the 16
/// lanes of a block are 4 columns, repeated, and 16 floats of rows. Both go on to the end of the
/// last tile.
struct ShadingRays {
    ShadingRays(const CameraRays& camera, const Vector3& zenith);

    std::vector<float> column[3];      ///< right X by axis
    std::vector<float> row[3];         ///< forward + down Y by axis
    std::vector<float> column_height;  ///< right X along the background's zenith z
    std::vector<float> row_height;     ///< forward + down Y along it
    std::vector<float> column_square;  ///< |right X|^2
    std::vector<float> row_square;     ///< |forward + down Y|^2

    float longest = 0;   ///< bounds |d|
    float error = 0;     ///< bounds |d in float - d|
    float relative = 0;  ///< the same in units of |d|
    /// Bounds the error of d.z / |d| from these sums by inverse_sqrt(), the product included.
    float sine_error = 0;

    std::size_t memory_bytes() const;
};

}  // namespace nuvo
