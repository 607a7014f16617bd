#pragma once

#include "fast_scene.h"

namespace nuvo {

/// The rays that the exact profile traces for the picture; `triangles` as Referee takes it.
RayCounts count_rays(const FastScene& scene, const Bounds3& triangles, InstructionSet isa,
                     Resolution resolution);

}  // namespace nuvo
