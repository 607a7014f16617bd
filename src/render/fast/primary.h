#pragma once

#include <array>
#include <cstdint>

#include "camera_tables.h"
#include "referee.h"
#include "tile.h"

// Primary rays: the octree is walked once a tile, by the beam of all its rays; in a leaf each
// primitive is tested against whole blocks first, then against 16 rays at a time.

namespace nuvo {

/// Remembers which items were tested lately, so that one listed in several leaves is tested once.
/// Forgets an item when another takes its place.
class Mailbox {
  public:
    /// Forgets all.
    void start() { ++run_; }
    /// Whether this run has asked for `slot` before, as far as is remembered.
    bool seen(Slot slot) {
        std::uint64_t& last = last_[slot % kPlaces];
        const std::uint64_t now = run_ << 32 | slot;
        const bool again = last == now;  // no branch: it would be foreseen badly
        last = now;
        return again;
    }

  private:
    static constexpr std::size_t kPlaces = 512;
    std::array<std::uint64_t, kPlaces> last_{};
    std::uint64_t run_ = 0;
};

/// What all tiles of a thread share.
struct PrimaryJob {
    const FastScene& scene;
    const CameraRays& camera;
    const CameraTables& tables;
    const Referee& referee;
    bool redo_exactly;
    Mailbox mailbox;
};

/// Finds the nearest primitives of a tile whose x and y are set; fills `inside` and the fields of
/// primary rays.
class PrimaryStage {
  public:
    explicit PrimaryStage(InstructionSet isa);
    void trace(PrimaryJob& job, Tile& tile) const { trace_(job, tile); }

  private:
    void (*trace_)(PrimaryJob&, Tile&);
};

}  // namespace nuvo
