#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "nuvo/octree/compact_build.h"

namespace nuvo {

using ItemSpan = std::span<const std::uint32_t>;
/// From here on it is worth while to try harder.
inline constexpr std::size_t kManyItems = 32;
/// Boxes lie anywhere in memory: they are asked for by this many items before they are needed.
inline constexpr std::size_t kPrefetchAhead = 24;
using BoxSpan = std::span<const Bounds3T<float>>;

/// The planes for these items; none where no axis can be cut.
std::optional<CutVoxel> choose_cut(CutRule rule, const Bounds3T<float>& voxel, ItemSpan items,
                                   BoxSpan boxes);

}  // namespace nuvo
