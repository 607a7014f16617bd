// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_BOX_CULLING_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_BOX_CULLING_H_
#undef NUVO_RENDER_FAST_BOX_CULLING_H_
#else
#define NUVO_RENDER_FAST_BOX_CULLING_H_
#endif

#include <algorithm>

#include "fast/primary/camera_tables.h"
#include "fast/primary/pixel_boxes.h"
#include "fast/simd/lanes.h"
#include "fast/tile/tile.h"

// The pixel boxes of 16 items against the blocks of one tile. What an item has to beat in the
// blocks of its box is read as in a hierarchical depth buffer (Greene, Kass and Miller 1993).

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class BoxCulling {
  public:
    static constexpr std::size_t kBatch = 16;

    // Boxes of larger pictures reach to the last pixel that a box can name.
    explicit BoxCulling(const Tile& tile)
        : x_(std::min(tile.x, kMostBoxPixels - kTileSide)),
          y_(std::min(tile.y, kMostBoxPixels - kTileSide)) {}

    /// Where the i-th of kBatch boxes has to stand.
    static constexpr std::size_t place(std::size_t i) { return i % 4 * 4 + i / 4; }

    /// Writes the slots of those of `count` boxes that may be seen in the tile before what is
    /// known, and the blocks where; returns their number. kBatch boxes have to be readable, as many
    /// numbers writable.
    HWY_INLINE std::size_t choose(const PixelBox* boxes, std::size_t count, const float* block_near,
                                  float tile_near, std::int32_t* chosen,
                                  std::int32_t* blocks) const {
        const Columns box(boxes);
        const Range columns(box.number[0], x_);
        const Range rows(box.number[1], y_);
        const Floats nearest = floats_of(box.number[2]);
        const Ints& slot = box.number[3];
        const Ints last_row = shift_left<2>(rows.last);
        const Ints first_row = shift_left<2>(rows.first);
        const Ints mask =
            blocks_of_columns().permuted(shift_left<2>(columns.first) + columns.last) &
            blocks_of_rows().permuted(first_row + rows.last);
        // The blocks at the box's corners are all its blocks if it has no more than two each way.
        const Floats near = Floats::load(block_near);
        const Floats corners = min(
            min(near.permuted(first_row + columns.first), near.permuted(last_row + columns.first)),
            min(near.permuted(first_row + columns.last), near.permuted(last_row + columns.last)));
        const auto few =
            (columns.last < columns.first + Ints(2)) & (rows.last < rows.first + Ints(2));
        const Floats beaten = select(mask_for<float>(few), corners, Floats(tile_near));
        const RayMask seen = mask_for<float>(columns.any & rows.any) & (nearest >= beaten) &
                             RayMask::from_bits((1U << count) - 1);
        const auto keep = mask_for<std::int32_t>(seen);
        slot.compress_store(chosen, keep);
        return mask.compress_store(blocks, keep);
    }

  private:
    // The numbers of 16 boxes by column: squares of 4 x 4 are transposed within each quarter of a
    // register, hence place().
    struct Columns {
        explicit HWY_INLINE Columns(const PixelBox* boxes) {
            static_assert(sizeof(PixelBox) == 4 * sizeof(std::int32_t));
            const auto* const numbers = reinterpret_cast<const std::int32_t*>(boxes);
#if HWY_TARGET == HWY_SCALAR
            for (std::size_t i = 0; i < kBatch; ++i)
                for (std::size_t k = 0; k < 4; ++k)
                    number[k].part[i] = hn::Set(Ints::Tag(), numbers[4 * place(i) + k]);
#else
            const Ints row[4] = {Ints::load(numbers), Ints::load(numbers + kBatch),
                                 Ints::load(numbers + 2 * kBatch),
                                 Ints::load(numbers + 3 * kBatch)};
            const Ints::Tag tag;
            const hn::Repartition<std::int64_t, Ints::Tag> pairs;
            const auto lower = [&](const auto& a, const auto& b) HWY_ATTR {
                return hn::BitCast(
                    tag, hn::InterleaveLower(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
            };
            const auto upper = [&](const auto& a, const auto& b) HWY_ATTR {
                return hn::BitCast(
                    tag, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
            };
            for (std::size_t i = 0; i < Ints::Shape::kParts; ++i) {
                const auto low_01 = hn::InterleaveLower(tag, row[0].part[i], row[1].part[i]);
                const auto low_23 = hn::InterleaveLower(tag, row[2].part[i], row[3].part[i]);
                const auto high_01 = hn::InterleaveUpper(tag, row[0].part[i], row[1].part[i]);
                const auto high_23 = hn::InterleaveUpper(tag, row[2].part[i], row[3].part[i]);
                number[0].part[i] = lower(low_01, low_23);
                number[1].part[i] = upper(low_01, low_23);
                number[2].part[i] = lower(high_01, high_23);
                number[3].part[i] = upper(high_01, high_23);
            }
#endif
        }
        Ints number[4];
    };

    // Of blocks, 0..3.
    struct Range {
        HWY_INLINE Range(const Ints& packed, int tile) {
            constexpr int kBlockSideLog2 = 2;
            static_assert(kBlockSide == 1 << kBlockSideLog2);
            const Ints most(kTileSide);
            const Ints from = max((packed & Ints(0xffff)) - Ints(tile), Ints(0));
            const Ints to = min((shift_right<16>(packed) & Ints(0xffff)) - Ints(tile), most);
            any = from < to;
            first = shift_right<kBlockSideLog2>(min(from, most - Ints(1)));
            last = shift_right<kBlockSideLog2>(max(to - Ints(1), Ints(0)));
        }
        LaneMask<std::int32_t, 16> any;
        Ints first;
        Ints last;
    };

    // [4 first + last]: the blocks of these columns.
    static HWY_INLINE Ints blocks_of_columns() {
        alignas(64) static constexpr std::int32_t kBlocks[16] = {
            0x1111, 0x3333, 0x7777, 0xffff, 0, 0x2222, 0x6666, 0xeeee,
            0,      0,      0x4444, 0xcccc, 0, 0,      0,      0x8888};
        return Ints::load(kBlocks);
    }
    static HWY_INLINE Ints blocks_of_rows() {
        alignas(64) static constexpr std::int32_t kBlocks[16] = {
            0x000f, 0x00ff, 0x0fff, 0xffff, 0, 0x00f0, 0x0ff0, 0xfff0,
            0,      0,      0x0f00, 0xff00, 0, 0,      0,      0xf000};
        return Ints::load(kBlocks);
    }

    int x_;
    int y_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_BOX_CULLING_H_
