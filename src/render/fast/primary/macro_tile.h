#pragma once

#include <algorithm>
#include <cstdint>

#include "fast/tile/tile.h"

namespace nuvo {

inline constexpr int kMacroTiles = 4;  ///< a side
inline constexpr int kMacroSide = kMacroTiles * kTileSide;

/// What a macro tile's hits on quadrics have besides; each as in Tile.
struct MacroQuadrics {
    static constexpr int kLanes = kMacroTiles * kMacroTiles * kTileLanes;
    float normal[3][kLanes];
    float error[kLanes];
};

/// 4 x 4 tiles whose primary rays are traced together. What tiles hold stands tile by tile: block b
/// of tile t is block 16 t + b.
struct alignas(64) MacroTile {
    static constexpr int kTiles = kMacroTiles * kMacroTiles;
    static constexpr int kBlocks = kTiles * kTileBlocks;
    static constexpr int kLanes = kTiles * kTileLanes;

    // Each as in Tile.
    std::uint16_t inside[kBlocks];
    std::uint16_t hit[kBlocks];
    Slot slot[kLanes];
    float near_low[kLanes];
    float near_high[kLanes];

    int x = 0;  ///< the first pixel
    int y = 0;

    int tile_x(int tile) const { return x + tile % kMacroTiles * kTileSide; }
    int tile_y(int tile) const { return y + tile / kMacroTiles * kTileSide; }

    /// Lets `out` be one of its tiles, of which it holds the hits as long as both are in use;
    /// `quadrics`: null if the scene has none.
    void show(int tile, const MacroQuadrics* quadrics, Tile& out) const {
        const int block = tile * kTileBlocks;
        const int lane = tile * kTileLanes;
        out.x = tile_x(tile);
        out.y = tile_y(tile);
        std::copy_n(inside + block, kTileBlocks, out.inside);
        std::copy_n(hit + block, kTileBlocks, out.hit);
        out.slot = slot + lane;
        out.near_low = near_low + lane;
        out.near_high = near_high + lane;
        if (quadrics == nullptr) return;
        for (int axis = 0; axis < 3; ++axis)
            out.quadric_normal[axis] = quadrics->normal[axis] + lane;
        out.quadric_error = quadrics->error + lane;
    }
};

}  // namespace nuvo
