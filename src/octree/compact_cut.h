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

/// Axes of a voxel: those about as wide as the widest, or the widest of the others.
enum class CutAxes : std::uint8_t { kWide, kNext };

/// The planes for these items; none where none of the axes can be cut.
std::optional<CutVoxel> choose_cut(CutRule rule, CutAxes axes, const Bounds3T<float>& voxel,
                                   ItemSpan items, BoxSpan boxes);

}  // namespace nuvo
