// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_PRIMARY_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_PRIMARY_LANES_H_
#undef NUVO_RENDER_FAST_PRIMARY_LANES_H_
#else
#define NUVO_RENDER_FAST_PRIMARY_LANES_H_
#endif

#include "fast/camera/camera_tables.h"
#include "fast/primary/macro_tile.h"
#include "fast/simd/lanes.h"
#include "fast/tile/tile.h"

// The rays of a tile, and what a hit has to beat. A tile's directions are affine in the offset from
// its middle.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Where the lanes of a block are: pixels from the tile's centre.
struct alignas(64) LaneOffsets {
    constexpr LaneOffsets() {
        for (int lane = 0; lane < kTileLanes; ++lane) {
            x[lane / kBlockLanes][lane % kBlockLanes] =
                static_cast<float>(lane_x(lane)) - 0.5F * (kTileSide - 1);
            y[lane / kBlockLanes][lane % kBlockLanes] =
                static_cast<float>(lane_y(lane)) - 0.5F * (kTileSide - 1);
        }
        for (int b = 0; b < kTileBlocks; ++b) {
            block_x[b] = static_cast<float>(b % 4 * kBlockSide) - 0.5F * (kTileSide - kBlockSide);
            block_y[b] = static_cast<float>(b / 4 * kBlockSide) - 0.5F * (kTileSide - kBlockSide);
        }
    }
    float x[kTileBlocks][kBlockLanes] = {};
    float y[kTileBlocks][kBlockLanes] = {};
    float block_x[kTileBlocks] = {};  ///< the centres of blocks
    float block_y[kTileBlocks] = {};
};
inline constexpr LaneOffsets kOffsets;

inline constexpr float kHalfBlock = 0.5F * (kBlockSide - 1);
inline constexpr float kHalfTile = 0.5F * (kTileSide - 1);

/// The middle of a tile.
struct TileRays {
    TileRays(const CameraRays& rays, int tile_x, int tile_y) : camera(rays) {
        const double x = rays.center_x(tile_x) + kHalfTile;
        const double y = rays.center_y(tile_y) + kHalfTile;
        center = rays.direction(x, y);
        if (rays.parallel) start = rays.offset(x, y);
    }

    const CameraRays& camera;
    Vector3 center;  ///< the direction through it
    Vector3 start;   ///< from the anchor to where the ray through it starts
};

/// Bounds on q of a candidate against those of the nearest so far.
struct Candidates {
    HWY_INLINE Candidates(const MacroTile& tile, int block, const Floats& low_q,
                          const Floats& high_q)
        : low(low_q),
          high(high_q),
          surely_nearer(low_q > Floats::load(tile.near_high + block * kBlockLanes)),
          perhaps_nearer(high_q >= Floats::load(tile.near_low + block * kBlockLanes)) {}

    HWY_INLINE void store(MacroTile& tile, int block, const RayMask& mask, Slot slot) const {
        low.store(tile.near_low + block * kBlockLanes, mask);
        high.store(tile.near_high + block * kBlockLanes, mask);
        Ints(slot).store(tile.slot + block * kBlockLanes, mask_for<std::int32_t>(mask));
    }

    Floats low;
    Floats high;
    RayMask surely_nearer;
    RayMask perhaps_nearer;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_PRIMARY_LANES_H_
