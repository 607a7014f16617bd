#pragma once

#include <cstdint>
#include <cstring>

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

    int x = 0;  ///< the first pixel
    int y = 0;

    // Each as in Tile.
    std::uint16_t inside[kBlocks];
    std::uint16_t hit[kBlocks];
    Slot slot[kLanes];
    float near_low[kLanes];
    float near_high[kLanes];

    int tile_x(int tile) const { return x + tile % kMacroTiles * kTileSide; }
    int tile_y(int tile) const { return y + tile / kMacroTiles * kTileSide; }

    /// Copies one of its tiles; `quadrics`: null if the scene has none.
    void copy(int tile, const MacroQuadrics* quadrics, Tile& out) const {
        out.x = tile_x(tile);
        out.y = tile_y(tile);
        copy_part(inside, tile, out.inside);
        copy_part(hit, tile, out.hit);
        copy_part(slot, tile, out.slot);
        copy_part(near_low, tile, out.near_low);
        copy_part(near_high, tile, out.near_high);
        if (quadrics == nullptr) return;
        for (int axis = 0; axis < 3; ++axis)
            copy_part(quadrics->normal[axis], tile, out.quadric_normal[axis]);
        copy_part(quadrics->error, tile, out.quadric_error);
    }

  private:
    template <typename T, std::size_t N>
    static void copy_part(const T* from, int tile, T (&to)[N]) {
        std::memcpy(to, from + static_cast<std::size_t>(tile) * N, sizeof to);
    }
};

}  // namespace nuvo
