#pragma once

#include <cstdint>
#include <vector>

#include "fast/shadow/pair_shadows.h"
#include "fast/shadow/shadow_tables.h"
#include "fast/shadow/walk_planes.h"
#include "fast/tile/exact_fallback.h"
#include "fast/tile/mailbox.h"
#include "fast/tile/tile.h"

// Shadow rays: the items that may hide a point from a light are found in the light's buffer, and
// each is tested against the 16 points of a block at a time.

namespace nuvo {

/// A lane of a tile and an item of which floats cannot tell whether it blocks it.
struct OpenShadow {
    std::uint32_t lane;
    Slot item;
};

/// What one thread needs.
struct ShadowJob {
    const ShadowTables& tables;
    PairShadows& pairs;
    bool redo_exactly;
    bool new_points;  ///< others than those for which items were listed
    Mailbox mailbox{};
    std::vector<OpenShadow> open{};
    WalkPlanes walk_planes{tables};
};

/// Decides which points of a tile the lights reach. For one thread.
class ShadowStage {
  public:
    /// `pairs`: of the same scene. `new_points`: it is asked about others than those that were
    /// wanted of the tables. Keeps references.
    ShadowStage(const ShadowTables& tables, PairShadows& pairs, InstructionSet isa,
                bool redo_exactly, bool new_points = false);

    /// Sets in `lit` the lanes of `wanted` that nothing blocks from the light.
    void trace(const Tile& tile, std::size_t light, const TileMask& wanted,
               const ExactFallback& fallback, TileMask& lit);

  private:
    ShadowJob job_;
    void (*trace_)(ShadowJob&, const Tile&, std::size_t light, const TileMask& wanted,
                   const ExactFallback&, TileMask& lit);
};

}  // namespace nuvo
