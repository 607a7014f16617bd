#include "nuvo/scene/background.h"

#include <algorithm>
#include <cmath>

namespace nuvo {

namespace {

/// The colour `angle` radians from the pole: linear in angle between the bands, and beyond the last
/// angle the last colour.
Color gradient(const std::vector<Color>& colors, const std::vector<double>& angles, double angle) {
    const std::size_t bands = std::min(angles.size(), colors.size() - 1);
    double lower = 0;
    for (std::size_t i = 0; i < bands; ++i) {
        const double upper = angles[i];
        if (angle <= upper) {
            if (!(upper > lower)) return colors[i + 1];
            const double part = (angle - lower) / (upper - lower);
            return colors[i] * (1 - part) + colors[i + 1] * part;
        }
        lower = upper;
    }
    return colors[bands];
}

}  // namespace

Color Background::color(const Vector3& direction) const {
    const double y = std::clamp(dot(direction, zenith), -1.0, 1.0);
    if (sky_color.size() == 1 && ground_color.size() == 1 && sky_angle.empty() &&
        ground_angle.empty())
        return sky_color[0] * ((y + 1) / 2) + ground_color[0] * ((1 - y) / 2);  // [eq. 36]
    // Of an arc cosine narrow bands around the poles would come out in steps.
    const Vector3 sideways = cross(direction, zenith);
    const double across = std::sqrt(dot(sideways, sideways));
    // The ground is a part of a sphere within the sky's, from the nadir to its last angle.
    if (!ground_color.empty() && y <= 0) {
        const double angle = std::atan2(across, -y);
        if (ground_angle.empty() || angle <= ground_angle.back())
            return gradient(ground_color, ground_angle, angle);
    }
    if (sky_color.empty()) return {};
    if (sky_color.size() == 1) return sky_color[0];
    return gradient(sky_color, sky_angle, std::atan2(across, y));
}

}  // namespace nuvo
