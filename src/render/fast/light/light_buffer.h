#pragma once

#include <cstdint>
#include <vector>

#include "fast/light/light_items.h"
#include "fast/light/light_map.h"
#include "fast/light/light_point.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/render/fast.h"

// What may stand between a light and a point is looked up in a grid of the shadow rays of the light
// (Haines and Greenberg 1986, "The light buffer: a shadow-testing accelerator"): each cell lists
// the items that some shadow ray through it may meet. Lists leave out nothing, so the answer is the
// octree's; they are short where items are about as large as cells.

namespace nuvo {

/// Lists tell places within a cell by so many steps on both axes.
inline constexpr std::uint32_t kCellSteps = 128;

/// One of kLightSteps in steps of `count` cells, counted from the first cell on: monotonic.
inline std::uint32_t cell_step(std::uint32_t step, int count) {
    return step * static_cast<std::uint32_t>(count) / (kLightSteps / kCellSteps);
}

/// A box of steps within a cell, one byte for each side.
struct CellBox {
    std::uint32_t low[2];
    std::uint32_t high[2];

    /// An item's box meets a window iff window() - item() keeps the highest bit of all four bytes:
    /// none of the item's is greater then.
    std::uint32_t item() const { return packed(low, high); }
    std::uint32_t window() const { return packed(high, low) | kMeets; }
    static constexpr std::uint32_t kMeets = 0x80808080;

  private:
    static std::uint32_t packed(const std::uint32_t (&a)[2], const std::uint32_t (&b)[2]) {
        return a[0] | a[1] << 8 | (kCellSteps - 1 - b[0]) << 16 | (kCellSteps - 1 - b[1]) << 24;
    }
};

/// Cells of one size: columns x rows of them on each face.
struct LightGrid {
    int columns = 1;
    int rows = 1;
    std::uint32_t first_cell = 0;
    bool sparse = false;  ///< most of its cells are empty: LightBuffer::occupied is asked first
};

/// Some entries of a cell's list, each number of all of them side by side.
struct LightGroup {
    static constexpr std::uint32_t kMost = 16;
    static constexpr std::size_t kWords = 3;  ///< of an entry

    const std::uint32_t* words;
    std::uint32_t count;

    /// Each one's CellBox::item().
    const std::uint32_t* boxes() const { return words; }
    /// No part of it lies less deep: floats.
    const std::uint32_t* nears() const { return words + count; }
    /// Among the LightItems.
    const Slot* places() const { return words + 2 * std::size_t{count}; }
};

/// Steps of a grid's cells from low to high on both axes, as cell_step() counts them.
struct CellSteps {
    /// Of those of kLightSteps from `first` to `last`.
    CellSteps(const LightGrid& grid, const std::uint32_t (&first)[2],
              const std::uint32_t (&last)[2])
        : low{cell_step(first[0], grid.columns), cell_step(first[1], grid.rows)},
          high{cell_step(last[0], grid.columns), cell_step(last[1], grid.rows)} {}

    std::uint32_t first_cell(int axis) const { return low[axis] / kCellSteps; }
    std::uint32_t last_cell(int axis) const { return high[axis] / kCellSteps; }
    /// What lies in a cell that they meet.
    CellBox in(std::uint32_t column, std::uint32_t row) const {
        const std::uint32_t start[2] = {column * kCellSteps, row * kCellSteps};
        CellBox box;
        for (int i = 0; i < 2; ++i) {
            box.low[i] = std::max(low[i], start[i]) - start[i];
            box.high[i] = std::min(high[i] - start[i], kCellSteps - 1);
        }
        return box;
    }

    std::uint32_t low[2];
    std::uint32_t high[2];
};

/// The light buffer of one light. Items are listed on the finest grid on which they cover few
/// cells.
struct LightBuffer {
    static constexpr std::size_t kMaxGrids = 4;
    /// So many entries of a list are looked at before it is asked what they blocked.
    static constexpr std::uint32_t kRound = 4 * LightGroup::kMost;

    LightBuffer() = default;
    LightBuffer(const LightPoint& light, const LightItems& items, InstructionSet isa);

    /// False where nothing may be looked up: the light is too far.
    bool usable() const { return !grids.empty(); }
    std::size_t memory_bytes() const {
        return (starts.size() + occupied.size() + entries.size()) * sizeof(std::uint32_t);
    }
    /// The next group of a list that ends at `end`; `begin` is a whole number of groups behind the
    /// list's start.
    LightGroup group(std::uint32_t begin, std::uint32_t end) const {
        return {entries.data() + LightGroup::kWords * std::size_t{begin},
                std::min(LightGroup::kMost, end - begin)};
    }

    LightMap map;
    bool near_first = false;           ///< lists longer than kRound are sorted by nearness
    bool long_lists = false;           ///< a short walk of the octree is tried before
    std::vector<LightGrid> grids;      ///< from fine to coarse
    BigVector<std::uint32_t> starts;   ///< of the cells' lists, and the end
    BigVector<std::uint32_t> entries;  ///< in groups, and room for one more to be read
    BigVector<std::int32_t> occupied;  ///< a bit a cell, 32 in a word: whether it lists anything
};

}  // namespace nuvo
