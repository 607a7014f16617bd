// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_DEPTH_PYRAMID_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_DEPTH_PYRAMID_H_
#undef NUVO_RENDER_FAST_DEPTH_PYRAMID_H_
#else
#define NUVO_RENDER_FAST_DEPTH_PYRAMID_H_
#endif

#include <bit>

#include "fast/primary/box_culling.h"
#include "fast/primary/frustum.h"
#include "fast/primary/macro_tile.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// What has to be beaten in a macro tile: in q, the least near_low of each block, of each tile
/// and of all (Greene, Kass and Miller 1993, "Hierarchical Z-buffer visibility"). Less where hits
/// have changed since the last update().
class DepthPyramid {
  public:
    /// Of a tile that shows nothing yet; its `inside` is known.
    DepthPyramid(const MacroTile& tile, float background) : tile_(tile) {
        for (int b = 0; b < MacroTile::kBlocks; ++b)
            blocks_[b] = tile.inside[b] != 0 ? background : kFloatInfinity;
        for (int t = 0; t < MacroTile::kTiles; ++t) update_tile(t);
        all_ = lowest(Floats::load(tiles_));
    }

    const float* tiles() const { return tiles_; }
    float all() const { return all_; }
    /// Of the blocks of tile t.
    HWY_INLINE Floats blocks(int t) const { return Floats::load(blocks_ + kTileBlocks * t); }

    /// Whether `nearest` is not surely behind everything in these blocks.
    HWY_INLINE bool is_open(BlockRange range, float nearest) const {
        if (nearest < all_) return false;
        const int first_column = range.first_column();
        const int last_column = range.last_column();
        const int first_row = range.first_row();
        const int last_row = range.last_row();
        const int left = first_column / kMacroTiles;
        const int right = last_column / kMacroTiles;
        const int top = first_row / kMacroTiles;
        const int bottom = last_row / kMacroTiles;
        const auto among = [&](const Floats& near, int from_x, int to_x, int from_y,
                               int to_y) HWY_ATTR {
            const std::int32_t places =
                BoxCulling::kColumns[4 * from_x + to_x] & BoxCulling::kRows[4 * from_y + to_y];
            return ((near <= Floats(nearest)).bits() & static_cast<std::uint32_t>(places)) != 0;
        };
        if (left == right && top == bottom)
            return among(blocks(kMacroTiles * top + left), first_column % 4, last_column % 4,
                         first_row % 4, last_row % 4);
        return among(Floats::load(tiles_), left, right, top, bottom);
    }

    /// The hits of block b have changed.
    HWY_INLINE void changed(int b) {
        changed_tiles_ |= 1U << (b / kTileBlocks);
        changed_blocks_[b / kTileBlocks] |= 1U << b % kTileBlocks;
    }
    HWY_INLINE void update() {
        if (changed_tiles_ == 0) return;
        for (; changed_tiles_ != 0; changed_tiles_ &= changed_tiles_ - 1) {
            const int t = std::countr_zero(changed_tiles_);
            for (std::uint32_t& blocks = changed_blocks_[t]; blocks != 0; blocks &= blocks - 1) {
                const int b = kTileBlocks * t + std::countr_zero(blocks);
                blocks_[b] = lowest(Floats::load(tile_.near_low + b * kBlockLanes));
            }
            update_tile(t);
        }
        all_ = lowest(Floats::load(tiles_));
    }

  private:
    HWY_INLINE void update_tile(int t) { tiles_[t] = lowest(blocks(t)); }

    const MacroTile& tile_;
    alignas(64) float blocks_[MacroTile::kBlocks];
    alignas(64) float tiles_[MacroTile::kTiles];
    float all_ = 0;
    std::uint32_t changed_tiles_ = 0;
    std::uint32_t changed_blocks_[MacroTile::kTiles] = {};
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_DEPTH_PYRAMID_H_
