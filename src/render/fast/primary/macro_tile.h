#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fast/tile/tile.h"

namespace nuvo {

inline constexpr int kMacroTiles = 4;  ///< a side
inline constexpr int kMacroSide = kMacroTiles * kTileSide;

/// A macro tile's first pixel.
struct TilePlace {
    int x;
    int y;
};
/// Those of a picture: squares of 4 x 4 along a Z-order curve (Morton 1966), row by row, so that
/// macro tiles near in time see the same part of the scene.
inline std::vector<TilePlace> macro_tiles(Resolution size) {
    constexpr int kSquare = 4 * kMacroSide;
    std::vector<TilePlace> places;
    for (int top = 0; top < size.height; top += kSquare)
        for (int left = 0; left < size.width; left += kSquare)
            for (int code = 0; code < 16; ++code) {
                const int x = left + kMacroSide * ((code & 1) | (code >> 1 & 2));
                const int y = top + kMacroSide * ((code >> 1 & 1) | (code >> 2 & 2));
                if (x < size.width && y < size.height) places.push_back({x, y});
            }
    return places;
}

/// Of a macro tile's hits on ellipsoids; each as in Tile.
struct EllipsoidNormals {
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
    /// `normals`: null if the scene has no ellipsoids.
    void show(int tile, const EllipsoidNormals* normals, Tile& out) const {
        const int block = tile * kTileBlocks;
        const int lane = tile * kTileLanes;
        out.x = tile_x(tile);
        out.y = tile_y(tile);
        std::copy_n(inside + block, kTileBlocks, out.inside.begin());
        std::copy_n(hit + block, kTileBlocks, out.hit.begin());
        out.slot = slot + lane;
        out.near_low = near_low + lane;
        out.near_high = near_high + lane;
        if (normals == nullptr) return;
        for (int axis = 0; axis < 3; ++axis)
            out.ellipsoid_normal[axis] = normals->normal[axis] + lane;
        out.ellipsoid_normal_error = normals->error + lane;
    }
};

}  // namespace nuvo
