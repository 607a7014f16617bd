// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_LIGHT_CELLS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_LIGHT_CELLS_H_
#undef NUVO_RENDER_FAST_LIGHT_CELLS_H_
#else
#define NUVO_RENDER_FAST_LIGHT_CELLS_H_
#endif

#include <algorithm>
#include <bit>

#include "fast/light/light_buffer.h"
#include "fast/simd/vector_lanes.h"
#include "fast/tile/tile.h"

// Where a light sees points, and the cells of its grids.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Points = VectorLanes<float, kBlockLanes>;
/// Of a block of a tile.
HWY_INLINE Points points_of(const Tile& tile, int block) {
    return Points::load(tile.point, static_cast<std::size_t>(block) * kBlockLanes);
}

/// The step of u (i = 0) or v (1): monotonic.
HWY_INLINE Floats step_of(const LightMap& map, int i, const Floats& u) {
    const Floats at = (u - Floats(map.low[i])) * Floats(map.steps[i]);
    return floor(min(max(at, Floats(0.0F)), Floats(kLightSteps - 1)));
}
/// The column or row of a step, of `count`.
HWY_INLINE Ints cell_of(const Ints& step, int count) { return shift_right<16>(step * Ints(count)); }

/// The highest of each of the four bytes: of several windows, the least around all.
HWY_INLINE std::uint32_t highest_bytes(const Ints& v) {
#if HWY_TARGET == HWY_SCALAR
    std::uint32_t all = 0;
    for (const auto& part : v.part) {
        const auto lane = static_cast<std::uint32_t>(hn::GetLane(part));
        for (const std::uint32_t byte : {0xffU, 0xff00U, 0xff0000U, 0xff000000U})
            all = std::max(all & byte, lane & byte) | (all & ~byte);
    }
    return all;
#else
    using Shape = Ints::Shape;
    const Ints::Tag tag;
    const hn::Repartition<std::uint8_t, Ints::Tag> bytes;
    auto all = v.part[0];
    const auto add = [&](const auto& other) HWY_ATTR {
        all = hn::BitCast(tag, hn::Max(hn::BitCast(bytes, all), hn::BitCast(bytes, other)));
    };
    for (std::size_t i = 1; i < Shape::kParts; ++i) add(v.part[i]);
    if constexpr (Shape::kPart > 8) add(hn::Reverse(tag, all));
    if constexpr (Shape::kPart > 4) add(hn::Reverse8(tag, all));
    add(hn::Reverse4(tag, all));
    add(hn::Reverse2(tag, all));
    return static_cast<std::uint32_t>(hn::GetLane(all));
#endif
}

/// Where 16 points are looked up.
struct LightPlaces {
    HWY_INLINE LightPlaces(const LightMap& map, const LightPoint& light, const Points& p,
                           const Floats& error) {
        const Floats weight(static_cast<float>(light.weight));
        Floats w[3];
        for (int axis = 0; axis < 3; ++axis)
            w[axis] = neg_mul_add(p[axis], weight, Floats(static_cast<float>(light.toward[axis])));
        Floats stretch(map.stretch);
        if (map.inside) {
            in_cube(w);
            stretch = stretch / depth;
            known = (depth >= Floats(map.nearest)).bits();
        } else {
            const int k = map.axis;
            const int axes[2] = {(k + 1) % 3, (k + 2) % 3};
            const Floats to_plane = p[k] / w[k];
            for (int i = 0; i < 2; ++i) u[i] = neg_mul_add(to_plane, w[axes[i]], p[axes[i]]);
            depth = p[k] * Floats(-map.sign);
            known = 0xffff;
        }
        for (int i = 0; i < 2; ++i) step[i] = integers_from(step_of(map, i, u[i]));
        moved = stretch * error;
        known &= ((error <= Floats(kMostError * map.point_size)) &
                  (moved <= Floats(map.most_moved)) & (max_norm(p) <= Floats(map.point_size)))
                     .bits();
        good = known & (error <= Floats(map.point_error)).bits();
    }

    /// Of a grid.
    struct Cells {
        Ints cell;
        Ints window;  ///< CellBox::window() of each; of several: highest_bytes()
    };
    HWY_INLINE Cells cells(const LightGrid& grid) const {
        constexpr auto kLast = static_cast<std::int32_t>(kCellSteps) - 1;
        const Ints x = shift_right<kStepsLog2>(step[0] * Ints(grid.columns));  // as cell_step()
        const Ints y = shift_right<kStepsLog2>(step[1] * Ints(grid.rows));
        const Ints column = shift_right<kCellStepsLog2>(x);
        const Ints row = shift_right<kCellStepsLog2>(y) + face * Ints(grid.rows);
        const Ints high = (x & Ints(kLast)) | shift_left<8>(y & Ints(kLast));
        const Ints low = Ints(kLast | kLast << 8) - high;
        return {
            column + row * Ints(grid.columns) + Ints(static_cast<std::int32_t>(grid.first_cell)),
            high | shift_left<16>(low) | Ints(CellBox::kMeets)};
    }

    Floats u[2];
    Ints step[2];  ///< of kLightSteps
    Floats depth;
    Floats moved;  ///< bounds what u is off by
    Ints face{0};
    std::uint32_t known;  ///< lanes that can be looked up
    std::uint32_t good;   ///< lanes for which one cell of a grid is enough

  private:
    static constexpr int kCellStepsLog2 = std::countr_zero(kCellSteps);
    static constexpr int kStepsLog2 = std::countr_zero(kLightSteps / kCellSteps);
    // In units of LightMap::point_size; worse known points may be met all over a grid, or on
    // several faces.
    static constexpr float kMostError = 0x1p-10F;

    HWY_INLINE void in_cube(const Floats (&w)[3]) {
        const Floats ax = abs(w[0]);
        const Floats ay = abs(w[1]);
        const Floats az = abs(w[2]);
        const RayMask x = (ax >= ay) & (ax >= az);
        const RayMask y = without(ay >= az, x);
        const auto choose = [&](const Floats& a, const Floats& b, const Floats& c)
                                HWY_ATTR { return select(x, a, select(y, b, c)); };
        const Floats deep = choose(w[0], w[1], w[2]);
        depth = abs(deep);
        const Floats inverse = Floats(1.0F) / depth;
        u[0] = choose(w[1], w[2], w[0]) * inverse;
        u[1] = choose(w[2], w[0], w[1]) * inverse;
        face = integers_from(choose(Floats(0.0F), Floats(2.0F), Floats(4.0F)) +
                             select(deep < Floats(0.0F), Floats(1.0F), Floats(0.0F)));
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_LIGHT_CELLS_H_
