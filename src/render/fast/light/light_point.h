#pragma once

#include "fast/scene/fast_scene.h"
#include "nuvo/scene/light.h"

namespace nuvo {

/// A light as the point toward / weight of the local frame; weight 0: the direction `toward` to the
/// light. No component is greater than 1; the weight is a power of two.
struct LightPoint {
    LightPoint(const Light& light, const LocalFrame& frame);

    Vector3 toward;
    double weight = 0;
    bool finite = true;  ///< false: out of the range of doubles, nothing below is sure
};

}  // namespace nuvo
