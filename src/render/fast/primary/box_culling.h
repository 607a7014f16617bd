// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_BOX_CULLING_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_BOX_CULLING_H_
#undef NUVO_RENDER_FAST_BOX_CULLING_H_
#else
#define NUVO_RENDER_FAST_BOX_CULLING_H_
#endif

#include <algorithm>

#include "fast/camera/camera_tables.h"
#include "fast/primary/macro_tile.h"
#include "fast/simd/four_columns.h"
#include "fast/simd/lanes.h"
#include "fast/tile/tile.h"

// The pixel boxes of 16 items against the tiles of a macro tile. What an item has to beat in the
// tiles of its box is read as in a hierarchical depth buffer (Greene, Kass and Miller 1993).

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class BoxCulling {
  public:
    static constexpr std::size_t kBatch = 16;

    // Boxes of larger pictures reach to the last pixel that a box can name.
    explicit BoxCulling(const MacroTile& tile)
        : x_(std::min(tile.x, kMostBoxPixels - kMacroSide)),
          y_(std::min(tile.y, kMostBoxPixels - kMacroSide)) {}

    /// Where the i-th of kBatch boxes has to stand.
    static constexpr std::size_t place(std::size_t i) { return FourColumns::place(i); }

    /// Writes the places of those of `count` boxes that may be seen in the macro tile before what
    /// is known, and the tiles where; returns their number. kBatch boxes have to be readable, as
    /// many numbers writable.
    HWY_INLINE std::size_t choose(const PixelBox* boxes, std::size_t count, const float* tile_near,
                                  float macro_near, std::int32_t* chosen,
                                  std::int32_t* tiles) const {
        static_assert(sizeof(PixelBox) == 4 * sizeof(std::int32_t));
        const FourColumns box(reinterpret_cast<const std::int32_t*>(boxes));
        const Range columns(box.column[0], x_);
        const Range rows(box.column[1], y_);
        const Floats nearest = floats_of(box.column[2]);
        alignas(64) static constexpr std::int32_t kPlaces[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                 8, 9, 10, 11, 12, 13, 14, 15};
        const Ints places = Ints::load(kPlaces);
        const Ints last_row = shift_left<2>(rows.last);
        const Ints first_row = shift_left<2>(rows.first);
        const Ints mask =
            Ints::load(kColumns).permuted(shift_left<2>(columns.first) + columns.last) &
            Ints::load(kRows).permuted(first_row + rows.last);
        // The tiles at the box's corners are all its tiles if it has no more than two each way.
        const Floats near = Floats::load(tile_near);
        const Floats corners = min(
            min(near.permuted(first_row + columns.first), near.permuted(last_row + columns.first)),
            min(near.permuted(first_row + columns.last), near.permuted(last_row + columns.last)));
        const auto few =
            (columns.last < columns.first + Ints(2)) & (rows.last < rows.first + Ints(2));
        const Floats beaten = select(mask_for<float>(few), corners, Floats(macro_near));
        const RayMask seen = mask_for<float>(columns.any & rows.any) & (nearest >= beaten) &
                             RayMask::from_bits((1U << count) - 1);
        const auto keep = mask_for<std::int32_t>(seen);
        places.compress_store(chosen, keep);
        return mask.compress_store(tiles, keep);
    }

    /// The blocks of one tile that a box touches.
    std::uint32_t blocks(const PixelBox& box, int tile) const {
        const int x = x_ + tile % kMacroTiles * kTileSide;
        const int y = y_ + tile / kMacroTiles * kTileSide;
        return kColumns[place_of(box.columns, x)] & kRows[place_of(box.rows, y)];
    }
    /// [4 first + last]: the columns first .. last of a square of 4 x 4, and the rows.
    alignas(64) static constexpr std::int32_t kColumns[16] = {
        0x1111, 0x3333, 0x7777, 0xffff, 0, 0x2222, 0x6666, 0xeeee,
        0,      0,      0x4444, 0xcccc, 0, 0,      0,      0x8888};
    alignas(64) static constexpr std::int32_t kRows[16] = {
        0x000f, 0x00ff, 0x0fff, 0xffff, 0, 0x00f0, 0x0ff0, 0xfff0,
        0,      0,      0x0f00, 0xff00, 0, 0,      0,      0xf000};

  private:
    // Of the blocks of pixels that touch the tile.
    static std::size_t place_of(std::uint32_t packed, int tile) {
        const int first = std::max(static_cast<int>(packed & 0xffff) - tile, 0);
        const int last = std::min(static_cast<int>(packed >> 16) - tile, kTileSide) - 1;
        return static_cast<std::size_t>(4 * (first / kBlockSide) + last / kBlockSide);
    }

    // Of tiles, 0..3.
    struct Range {
        HWY_INLINE Range(const Ints& packed, int tile) {
            constexpr int kTileSideLog2 = 4;
            static_assert(kTileSide == 1 << kTileSideLog2);
            const Ints most(kMacroSide);
            const Ints from = max((packed & Ints(0xffff)) - Ints(tile), Ints(0));
            const Ints to = min((shift_right<16>(packed) & Ints(0xffff)) - Ints(tile), most);
            any = from < to;
            first = shift_right<kTileSideLog2>(min(from, most - Ints(1)));
            last = shift_right<kTileSideLog2>(max(to - Ints(1), Ints(0)));
        }
        LaneMask<std::int32_t, 16> any;
        Ints first;
        Ints last;
    };

    int x_;
    int y_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_BOX_CULLING_H_
