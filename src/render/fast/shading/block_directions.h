// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_BLOCK_DIRECTIONS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_BLOCK_DIRECTIONS_H_
#undef NUVO_RENDER_FAST_BLOCK_DIRECTIONS_H_
#else
#define NUVO_RENDER_FAST_BLOCK_DIRECTIONS_H_
#endif

#include "fast/shading/shading_tables.h"
#include "fast/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The rays of a block's lanes.
class BlockDirections {
  public:
    HWY_INLINE BlockDirections(const ShadingTables& tables, const Tile& tile, int b)
        : rays_(tables.rays),
          x_(static_cast<std::size_t>(tile.x + lane_x(b * kBlockLanes))),
          y_(static_cast<std::size_t>(tile.y + lane_y(b * kBlockLanes)) * kBlockSide) {}

    /// Within ShadingRays::error, all axes together.
    HWY_INLINE Floats at(int axis) const {
        return Floats::load_repeated(rays_.column[axis].data() + x_) +
               Floats::load(rays_.row[axis].data() + y_);
    }
    /// Where a ray of a parallel projection starts, within ShadingRays::start_error.
    HWY_INLINE Floats start(int axis) const {
        return Floats::load_repeated(rays_.start_column[axis].data() + x_) +
               Floats::load(rays_.start_row[axis].data() + y_);
    }
    /// d.z for the background's zenith z.
    HWY_INLINE Floats height() const {
        return Floats::load_repeated(rays_.column_height.data() + x_) +
               Floats::load(rays_.row_height.data() + y_);
    }
    /// d.d
    HWY_INLINE Floats square() const {
        return Floats::load_repeated(rays_.column_square.data() + x_) +
               Floats::load(rays_.row_square.data() + y_);
    }

  private:
    const ShadingRays& rays_;
    std::size_t x_;
    std::size_t y_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_BLOCK_DIRECTIONS_H_
