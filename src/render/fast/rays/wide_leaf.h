#pragma once

#include <cstdint>
#include <span>

#include "fast/rays/wide_octree.h"

namespace nuvo {

/// Appends a leaf with these slots (ascending), of which something lies in `box`, and returns its
/// place. The grid spans the box, too: there the rays come in.
std::uint32_t append_leaf(const FastScene& scene, std::span<const Slot> slots,
                          const Bounds3T<float>& box, BigVector<std::uint32_t>& words);

/// The box of `slot`, from outside.
Bounds3T<float> whole_box(const FastScene& scene, Slot slot);

/// The box of what lies of `slot` in the voxel, from outside; may be empty.
Bounds3T<float> clipped_box(const FastScene& scene, Slot slot, const Bounds3T<float>& voxel);

}  // namespace nuvo
