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

/// An item of a cell's list.
struct LightEntry {
    Slot place;            ///< among the LightItems
    float near;            ///< no part of it lies less deep
    std::uint16_t low[2];  ///< steps between which it lies
    std::uint16_t high[2];
};
static_assert(sizeof(LightEntry) == 16);

/// Cells of one size: columns x rows of them on each face.
struct LightGrid {
    int columns = 1;
    int rows = 1;
    std::uint32_t first_cell = 0;
    bool sparse = false;  ///< most of its cells are empty: LightBuffer::occupied is asked first
};

/// The light buffer of one light. Items are listed on the finest grid on which they cover few
/// cells.
struct LightBuffer {
    static constexpr std::size_t kMaxGrids = 4;

    LightBuffer() = default;
    LightBuffer(const LightPoint& light, const LightItems& items, InstructionSet isa);

    /// False where nothing may be looked up: the light is too far, or lists would be too long.
    bool usable() const { return !grids.empty(); }
    std::size_t memory_bytes() const {
        return (starts.size() + occupied.size()) * sizeof(std::uint32_t) +
               entries.size() * sizeof(LightEntry);
    }

    LightMap map;
    bool near_first = false;           ///< lists are sorted by LightEntry::near
    std::vector<LightGrid> grids;      ///< from fine to coarse
    BigVector<std::uint32_t> starts;   ///< of the cells' lists, and the end
    BigVector<LightEntry> entries;     ///< and room for a few more to be read
    BigVector<std::int32_t> occupied;  ///< a bit a cell, 32 in a word: whether it lists anything
};

}  // namespace nuvo
