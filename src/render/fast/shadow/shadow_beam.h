#pragma once

#include "fast/shadow/shadow_tables.h"
#include "fast/tile/beam_box.h"

namespace nuvo {

/// Holds all shadow rays from points of the box [low, high], each coordinate of which may be off by
/// `slack`, to the light. From a light nearby to the points, visited from their end; else from the
/// points towards the light.
BeamBox beam_to_light(const LightPoint& light, const float (&low)[3], const float (&high)[3],
                      float slack);

}  // namespace nuvo
