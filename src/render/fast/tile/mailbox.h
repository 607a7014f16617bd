#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/scene/fast_scene.h"

// An item listed in several leaves is tested once a ray or beam: the number of the last run that
// tested it is kept (mailboxes: Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray
// tracing"; Arnaldi, Priol and Bouatouch 1987, "A new space subdivision method for ray tracing CSG
// modelled scenes"), here in a few places that items share, not in one of its own for each.

namespace nuvo {

/// Remembers which items were tested lately; forgets one when another takes its place.
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
    static constexpr std::size_t kPlaces = 4096;
    std::array<std::uint64_t, kPlaces> last_{};
    std::uint64_t run_ = 0;
};

}  // namespace nuvo
