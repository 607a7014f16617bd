#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fast/light/light_map.h"
#include "fast/light/light_point.h"
#include "fast/scene/fast_scene.h"
#include "fast/tile/tile.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// Where a light sees the points of a picture that it may light: by cell of its plane or faces how
/// deep the deepest of them lies, with a pyramid of coarser cells above. Nothing that lies deeper
/// than all points of its cells hides any of them.
class WantedDepths {
  public:
    /// None where the light tells no places of points.
    static std::optional<WantedDepths> of(const FastScene& scene, const LightPoint& light,
                                          InstructionSet isa);

    const LightPoint& light() const { return light_; }
    /// Points that it cannot look up are not counted.
    const LightMap& map() const { return map_; }

    /// Counts points; for several threads at a time.
    void add(const Tile& tile, const TileMask& wanted);
    /// Leaves those lanes whose points are known no deeper than points that were added.
    void keep_covered(const Tile& tile, TileMask& lanes) const;
    /// After all points: counts others that are near them, as the next camera may see them.
    void widen();
    /// Makes the pyramid. After all else.
    void finish();

    std::size_t memory_bytes() const { return cells_.size() * sizeof(float); }

    // For the kernels: the finest cells [face][v][u], then those of half as many a side, and so on.
    const float* cells() const { return cells_.data(); }
    int cells_a_side() const { return cells_a_side_; }
    int step_bits() const { return step_bits_; }
    const std::int32_t* level_starts() const { return level_starts_.data(); }

  private:
    WantedDepths(const LightPoint& light, InstructionSet isa) : light_(light), isa_(isa) {}

    LightPoint light_;
    LightMap map_;
    InstructionSet isa_;
    int cells_a_side_ = 0;  // of a face; a power of two
    int step_bits_ = 0;     // a cell is this many steps wide, as a power of two
    float width_ = 0;       // of a cell; inside at a depth of 1
    BigVector<float> cells_;
    std::vector<std::int32_t> level_starts_;  // from fine to coarse
};

}  // namespace nuvo
