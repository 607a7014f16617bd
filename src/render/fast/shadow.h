#pragma once

#include <algorithm>
#include <array>
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

/// The items that lately hid clusters from one light, which often hide the next one, too. Asked as
/// long as that is true often enough.
class OccluderCache {
  public:
    static constexpr std::size_t kSlots = 4;

    const std::array<Slot, kSlots>& slots() const { return slots_; }
    bool worth_a_try() {
        if (luck_ >= 0) return true;
        return ++skipped_ % kPatience == 0;
    }
    /// Tells whether a try made the walk needless.
    void tried(bool done) {
        luck_ += done ? kGain : -1;
        luck_ = std::clamp(luck_, -kGain, kPatience);
    }
    void put(Slot slot) {
        if (std::find(slots_.begin(), slots_.end(), slot) != slots_.end()) return;
        slots_[next_] = slot;
        next_ = (next_ + 1) % kSlots;
    }

  private:
    // A walk costs some times as much as asking the cache.
    static constexpr int kGain = 4;
    static constexpr int kPatience = 16;

    std::array<Slot, kSlots> slots_{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
    std::size_t next_ = 0;
    int luck_ = 0;
    int skipped_ = 0;
};

/// What one thread needs.
struct ShadowJob {
    const ShadowTables& tables;
    bool redo_exactly;
    Mailbox mailbox{};
    std::vector<OpenShadow> open{};
    std::vector<OccluderCache> caches{};  ///< by light
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
