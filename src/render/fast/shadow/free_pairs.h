#pragma once

#include <cstdint>

#include "fast/scene/fast_scene.h"
#include "fast/scene/pair_cache.h"

namespace nuvo {

/// Triangles that hide no point of another triangle from a light, for all its points at once: none
/// of its corners lies beyond their plane. So coplanar and coincident triangles are not decided
/// point by point. [numerics: coincident triangles] Keeps what was asked; for one thread.
class FreePairs {
  public:
    explicit FreePairs(const FastScene& scene) : scene_(scene) {}

    /// True: surely no point of `lit` is hidden from the light by `occluder`.
    bool free(Slot lit, Slot occluder, std::size_t light) {
        return kept_.of({lit, occluder, static_cast<std::uint32_t>(light)},
                        [&] { return is_free(lit, occluder, light); });
    }

  private:
    bool is_free(Slot lit, Slot occluder, std::size_t light) const;

    const FastScene& scene_;
    PairCache<bool> kept_;
};

}  // namespace nuvo
