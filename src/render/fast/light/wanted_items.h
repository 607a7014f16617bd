#pragma once

#include "fast/light/light_items.h"
#include "fast/light/wanted_depths.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// A node of the octree and its voxel.
struct WantedNode {
    std::uint32_t node;
    float low[3];
    float high[3];
};

/// The slots of those items, ascending, that may stand between the light and a point of `wanted`.
/// Asks of `all` for `touch` and quadrics only.
BigVector<Slot> wanted_items(const LightItems& all, const WantedDepths& wanted, InstructionSet isa,
                             int threads);

}  // namespace nuvo
