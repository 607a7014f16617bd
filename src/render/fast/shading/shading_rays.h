#pragma once

#include <vector>

#include "fast/tile/camera_rays.h"

// The directions of a picture's rays in float, as sums of a column's part and a row's, and where
// the rays of a parallel projection start. The camera's axes are perpendicular, so the squares of
// lengths are such sums, too.

namespace nuvo {

/// Column parts stand by the pixel's x, row parts four times for each y, side by side: so the 16
/// lanes of a block are 4 columns, repeated, and 16 floats of rows. Both go on to the end of the
/// last tile.
struct ShadingRays {
    ShadingRays(const CameraRays& camera, const Vector3& zenith);

    std::vector<float> column[3];      ///< right X by axis; of a parallel projection 0
    std::vector<float> row[3];         ///< forward + down Y by axis; forward
    std::vector<float> column_height;  ///< of column along the background's zenith z
    std::vector<float> row_height;     ///< of row along it
    std::vector<float> column_square;  ///< the squares of their lengths
    std::vector<float> row_square;
    std::vector<float> start_column[3];  ///< of a parallel projection: right X by axis
    std::vector<float> start_row[3];     ///< the anchor + down Y

    float longest = 0;      ///< bounds |d|
    float error = 0;        ///< bounds |d in float - d|
    float relative = 0;     ///< the same in units of |d|
    float start_error = 0;  ///< of a parallel projection: bounds |start in float - start|
    /// Bounds the error of d.z / |d| from these sums by inverse_sqrt(), the product included.
    float sine_error = 0;

    std::size_t memory_bytes() const;
};

}  // namespace nuvo
