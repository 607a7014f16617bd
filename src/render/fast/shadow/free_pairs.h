#pragma once

#include <cstdint>
#include <vector>

#include "fast/scene/fast_scene.h"

namespace nuvo {

/// Triangles that hide no point of another triangle from a light, for all its points at once: none
/// of its corners lies beyond their plane. So coplanar and coincident triangles are not decided
/// point by point. [numerics: coincident triangles] Keeps what was asked; for one thread.
class FreePairs {
  public:
    explicit FreePairs(const FastScene& scene) : scene_(scene) {}

    /// True: surely no point of `lit` is hidden from the light by `occluder`.
    bool free(Slot lit, Slot occluder, std::size_t light) {
        if (kept_.empty()) kept_.resize(kKept);
        const auto number = static_cast<std::uint32_t>(light);
        Kept& kept = kept_[(lit * 0x9e3779b1U + occluder * 0x85ebca6bU + number * 0xc2b2ae35U) >>
                           (32 - kKeptLog2)];
        if (kept.lit != lit || kept.occluder != occluder || kept.light != number)
            kept = {lit, occluder, number, is_free(lit, occluder, light)};
        return kept.free;
    }

  private:
    static constexpr unsigned kKeptLog2 = 14;
    static constexpr std::size_t kKept = std::size_t{1} << kKeptLog2;
    struct Kept {
        Slot lit = kNoSlot;
        Slot occluder = kNoSlot;
        std::uint32_t light = 0;
        bool free = false;
    };

    bool is_free(Slot lit, Slot occluder, std::size_t light) const;

    const FastScene& scene_;
    std::vector<Kept> kept_;
};

}  // namespace nuvo
