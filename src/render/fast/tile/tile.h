#pragma once

#include <array>
#include <cstdint>

#include "fast/scene/fast_scene.h"

// The state of one tile of the picture while the stages of the fast tracer work on it: primary
// rays, surfaces, and for each light samples, shadows and sums. Lanes stand block by block, a block
// being 4 x 4 pixels, so that the 16 rays of a register are neighbours on both axes.

namespace nuvo {

inline constexpr int kTileSide = 16;  ///< pixels
inline constexpr int kBlockSide = 4;  ///< pixels
inline constexpr int kBlockLanes = 16;
inline constexpr int kTileBlocks = 16;
inline constexpr int kTileLanes = kTileBlocks * kBlockLanes;

/// Pixel of a lane relative to the tile's first.
constexpr int lane_x(int lane) { return (lane / 16 % 4) * 4 + lane % 4; }
constexpr int lane_y(int lane) { return (lane / 64) * 4 + lane / 4 % 4; }

/// One bit for each lane of each block: bit i of [b] is lane 16 b + i.
using TileMask = std::array<std::uint16_t, kTileBlocks>;

/// Unless said otherwise lengths are those of the local frame.
struct alignas(64) Tile {
    int x = 0;  ///< the tile's first pixel
    int y = 0;
    TileMask inside;  ///< lanes that are pixels of the picture

    // Primary rays: kTileLanes numbers each, of the macro tile. The nearest primitive is decided
    // exactly; bounds on q of its hit. [CameraRays]
    const Slot* slot;  ///< kNoSlot: the background
    const float* near_low;
    const float* near_high;
    const float* ellipsoid_normal[3];     ///< of ellipsoids: unit, outwards
    const float* ellipsoid_normal_error;  ///< bounds the error of ellipsoid_normal on each axis
    TileMask hit;

    // Surfaces: of lanes that hit something lit.
    float point[3][kTileLanes];
    float point_error[kTileLanes];  ///< bounds |point - SurfacePoint::point| on each axis
    float normal[3][kTileLanes];    ///< for shading: unit, turned as shading_normal() turns it
};

}  // namespace nuvo
