#include "fast/shadow/shadow_beam.h"

#include <algorithm>
#include <cmath>

#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

// Four roundings: of the light's place, of a difference and of a bound.
constexpr float kRounding = roundings(4);

// Seen from a light nearby the rays to a box stay within its pyramid; from the box to the light
// they are as good as parallel.
constexpr double kNearWeight = 0x1p-6;

BeamBox from_light(const LightPoint& light, const float (&low)[3], const float (&high)[3],
                   float slack) {
    BeamBox beam;
    for (int axis = 0; axis < 3; ++axis) {
        const auto from = static_cast<float>(light.toward[axis] / light.weight);
        const float rounding =
            kRounding * (std::fabs(from) + std::fmax(std::fabs(low[axis]), std::fabs(high[axis])));
        beam.origin_low[axis] = from - rounding;
        beam.origin_high[axis] = from + rounding;
        beam.direction_low[axis] = low[axis] - from - rounding - slack;
        beam.direction_high[axis] = high[axis] - from + rounding + slack;
    }
    beam.t_end = 1;
    beam.far_first = true;
    return beam;
}

BeamBox from_points(const LightPoint& light, const float (&low)[3], const float (&high)[3],
                    float slack) {
    BeamBox beam;
    for (int axis = 0; axis < 3; ++axis) {
        const auto toward = static_cast<float>(light.toward[axis]);
        const auto weight = static_cast<float>(light.weight);
        // Where shadow rays keep to a plane across the axis, a beam of one sign is as good: points
        // within `slack` of a face count as beyond it either way.
        const bool across = weight == 0 && toward == 0;
        const float rounding = across ? 0 : kRounding;
        beam.origin_low[axis] = low[axis] - slack;
        beam.origin_high[axis] = high[axis] + slack;
        beam.direction_low[axis] = toward - weight * (high[axis] + slack) - rounding;
        beam.direction_high[axis] = toward - weight * (low[axis] - slack) + rounding;
        if (across) beam.direction_low[axis] = beam.direction_high[axis] = 0x1p-100F;
    }
    constexpr double kEndless = 0x1p60;
    // A thousandth more than the distance to the light.
    beam.t_end = static_cast<float>(std::min(kEndless, 1.001 / light.weight));
    return beam;
}

// Meets every voxel of the scene.
BeamBox everywhere() {
    BeamBox beam;
    for (int axis = 0; axis < 3; ++axis) {
        beam.origin_low[axis] = beam.direction_low[axis] = -1;
        beam.origin_high[axis] = beam.direction_high[axis] = 1;
    }
    beam.t_end = 1;
    return beam;
}

}  // namespace

BeamBox beam_to_light(const LightPoint& light, const float (&low)[3], const float (&high)[3],
                      float slack) {
    // Points that are hardly known; written so that a NaN counts as one of these.
    bool known = light.finite && slack < 1;
    for (int axis = 0; axis < 3; ++axis)
        known = known && std::fabs(low[axis]) < 2 && std::fabs(high[axis]) < 2;
    if (!known) return everywhere();
    BeamBox beam = light.weight >= kNearWeight ? from_light(light, low, high, slack)
                                               : from_points(light, low, high, slack);
    beam.keep_off_zero();
    return beam;
}

}  // namespace nuvo
