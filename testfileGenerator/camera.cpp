#include "camera.h"

#include <cmath>

namespace nuvo::generator {

namespace {

constexpr double kFarFraction = 1;
constexpr double kNearFraction = 0.3;

}  // namespace

double fitting_distance(double half_height) {
    const double tangent = std::sqrt(2.0) - 1;  // of 22.5 degrees
    return 1.05 * half_height / tangent;
}

double camera_fraction(CameraPlace place, double own) {
    switch (place) {
        case CameraPlace::kFar:
            return kFarFraction;
        case CameraPlace::kNear:
            return kNearFraction;
        case CameraPlace::kOwn:
            break;
    }
    return own;
}

}  // namespace nuvo::generator
