#pragma once

#include "scenes.h"

namespace nuvo::generator {

/// The distance at which a camera 45 degrees high sees `half_height` * 1.05 up and down.
double fitting_distance(double half_height);

/// The part of the fitting distance at which the camera stands: `own` unless another is asked for.
double camera_fraction(CameraPlace place, double own);

}  // namespace nuvo::generator
