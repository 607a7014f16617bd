#pragma once

#include "fast/scene/fast_scene.h"

namespace nuvo {

/// The rays that the exact profile traces for the picture.
RayCounts count_rays(const FastScene& scene, InstructionSet isa, Resolution resolution,
                     Progress* progress = nullptr);

}  // namespace nuvo
