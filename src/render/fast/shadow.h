#pragma once

#include <cstdint>
#include <vector>

#include "primary.h"
#include "referee.h"
#include "shadow_tables.h"
#include "tile.h"

// Shadow rays: a tile's lit points are gathered into clusters that lie together, each cluster walks
// the octree as one beam between its box and the light, and an item is tested against the boxes of
// 16 packets first, then against 16 points at a time.

namespace nuvo {

/// A lane of a tile and an item of which floats cannot tell whether it blocks it.
struct OpenShadow {
    std::uint32_t lane;
    Slot item;
};

/// What one thread needs.
struct ShadowJob {
    const ShadowTables& tables;
    bool redo_exactly;
    Mailbox mailbox{};
    std::vector<OpenShadow> open{};
};

/// Decides which points of a tile the lights reach. For one thread.
class ShadowStage {
  public:
    ShadowStage(const ShadowTables& tables, InstructionSet isa, bool redo_exactly);

    /// Sets in `lit` the lanes of `wanted` that nothing blocks from the light.
    void trace(const Tile& tile, std::size_t light, const TileMask& wanted, const Referee& referee,
               TileMask& lit);

  private:
    ShadowJob job_;
    void (*trace_)(ShadowJob&, const Tile&, std::size_t light, const TileMask& wanted,
                   TileMask& lit);
};

}  // namespace nuvo
