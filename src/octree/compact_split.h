#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compact_cut.h"

namespace nuvo {

/// A voxel cut, and which of its octants each item touches.
struct Split {
    CutVoxel voxel;
    std::array<std::size_t, 8> counts{};  ///< items in each octant
    std::size_t references = 0;           ///< their sum

    std::uint8_t occupied() const {
        unsigned mask = 0;
        for (unsigned o = 0; o < 8; ++o) mask |= (counts[o] != 0 ? 1U : 0U) << o;
        return static_cast<std::uint8_t>(mask);
    }
};

/// Tries cuts and hands items down to octants. One for each thread: it keeps its buffers.
class Splitter {
  public:
    Splitter(BoxSpan boxes, const CompactBuildOptions& options)
        : boxes_(boxes), options_(options) {}

    /// The cut of a voxel with these items, unless it cannot be cut or it would not pay.
    std::optional<Split> try_split(const Bounds3T<float>& voxel, ItemSpan items);

    /// Writes the items of the octants in turn, in order, as the last try_split() found them: those
    /// of octant o to out[first[o]] on, with one place of scratch behind them.
    void distribute(ItemSpan items, const std::array<std::size_t, 8>& first,
                    std::uint32_t* out) const;

    double leaf_cost(const Bounds3T<float>& voxel, std::size_t count) const {
        return half_area(voxel) * (options_.costs.leaf + static_cast<double>(count));
    }
    double interior_cost(const Bounds3T<float>& voxel) const {
        return half_area(voxel) * options_.costs.interior;
    }

  private:
    void classify(const CutVoxel& voxel, ItemSpan items);
    void refine(const CutVoxel& voxel);
    bool pays(const Split& split, std::size_t count) const;

    BoxSpan boxes_;
    const CompactBuildOptions& options_;
    std::vector<std::uint8_t> masks_;       // octants of each item
    std::vector<std::uint32_t> doubtful_;   // items with more than one octant,
    std::vector<std::uint32_t> places_;     // their places in masks_
    std::vector<std::uint8_t> candidates_;  // and their octants
};

}  // namespace nuvo
