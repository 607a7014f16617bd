// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_COUNTED_POINTS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_COUNTED_POINTS_H_
#undef NUVO_RENDER_FAST_COUNTED_POINTS_H_
#else
#define NUVO_RENDER_FAST_COUNTED_POINTS_H_
#endif

#include <bit>

#include "fast/light/light_cells.h"
#include "fast/light/wanted_depths.h"
#include "fast/simd/lanes.h"

// The cells of WantedDepths in which points count: all where they may be, as deep as they may be.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// 16 points, by lane.
class CountedPoints {
  public:
    /// `places`: by the map of `depths`, or by another of the same light and scene, which may have
    /// other steps and know fewer points.
    HWY_INLINE CountedPoints(const WantedDepths& depths, const LightPlaces& places,
                             const Floats& error, std::uint32_t there)
        : side_(depths.cells_a_side()) {
        lanes = there & places.known;
        if (lanes == 0) return;
        for (int i = 0; i < 2; ++i) {
            const auto cell_at = [&](const Floats& u) HWY_ATTR {
                return integers_from(step_of(depths.map(), i, u)) >> Ints(depths.step_bits());
            };
            first_[i] = cell_at(places.u[i] - places.moved);
            last_[i] = cell_at(places.u[i] + places.moved);
        }
        depth = places.depth + error;
        row_ = places.face * Ints(side_);
        cell = (row_ + first_[1]) * Ints(side_) + first_[0];
        single = lanes & ((first_[0] == last_[0]) & (first_[1] == last_[1])).bits();
    }

    /// Calls use(cell, depth, lane) for all cells of the other lanes.
    template <typename Use>
    HWY_INLINE void for_each_of_spread(Use&& use) const {
        alignas(64) std::int32_t low[2][kBlockLanes];
        alignas(64) std::int32_t high[2][kBlockLanes];
        alignas(64) std::int32_t rows[kBlockLanes];
        alignas(64) float depths[kBlockLanes];
        for (int i = 0; i < 2; ++i) {
            first_[i].store(low[i]);
            last_[i].store(high[i]);
        }
        row_.store(rows);
        depth.store(depths);
        for (std::uint32_t rest = lanes & ~single; rest != 0; rest &= rest - 1) {
            const int lane = std::countr_zero(rest);
            for (std::int32_t y = low[1][lane]; y <= high[1][lane]; ++y)
                for (std::int32_t x = low[0][lane]; x <= high[0][lane]; ++x)
                    use((rows[lane] + y) * side_ + x, depths[lane], lane);
        }
    }

    std::uint32_t lanes;       ///< that count
    std::uint32_t single = 0;  ///< of these those in one cell
    Ints cell;                 ///< of these
    Floats depth;

  private:
    int side_;
    Ints first_[2];
    Ints last_[2];
    Ints row_;
};

/// Which of `lanes` lie in no cell deeper than a point that was counted there: items that may hide
/// them are wanted.
HWY_NOINLINE inline std::uint32_t covered(const WantedDepths& depths, const LightPlaces& places,
                                          const Floats& error, std::uint32_t lanes) {
    const CountedPoints counted(depths, places, error, lanes);
    if (counted.lanes == 0) return 0;
    const float* const cells = depths.cells();
    const Floats known =
        Floats::gather(cells, select(Ints::Mask::from_bits(counted.single), counted.cell, Ints(0)));
    std::uint32_t out = counted.single & (counted.depth <= known).bits();
    if (std::uint32_t spread = counted.lanes & ~counted.single; HWY_UNLIKELY(spread != 0)) {
        counted.for_each_of_spread([&](std::int32_t cell, float depth, int lane) {
            if (!(depth <= cells[cell])) spread &= ~(1U << lane);
        });
        out |= spread;
    }
    return out;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_COUNTED_POINTS_H_
