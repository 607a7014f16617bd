#pragma once

#include <cstdint>

#include "fast/scene/fast_scene.h"
#include "fast/tile/pair_cache.h"
#include "nuvo/geometry/predicates.h"

namespace nuvo {

/// What is known of the shadow that one triangle casts on another, for all its points at once.
enum class PairShadow : std::int8_t {
    kOpen,  ///< nothing
    kNone,  ///< no point is hidden: the occluder leaves all in light, or stays behind the lit plane
    // The occluder stands on the lit plane with an edge, on the light's side or on either if the
    // light lies in the plane: points are hidden that the other edges and its plane do not clear.
    kPastEdgeAB,
    kPastEdgeAC,
    kPastEdgeBC,
};

/// Finds that by exact signs, once for a pair and a light, so that coplanar and coincident
/// triangles and those that meet in an edge are not decided point by point. [numerics: coincident
/// triangles] Keeps what was asked; for one thread.
class PairShadows {
  public:
    explicit PairShadows(const FastScene& scene) : scene_(scene) {}

    PairShadow of(Slot lit, Slot occluder, std::size_t light) {
        return kept_.of({lit, occluder, static_cast<std::uint32_t>(light)},
                        [&] { return find(lit, occluder, light); });
    }
    std::size_t memory_bytes() const { return kept_.memory_bytes() + counts_.memory_bytes(); }

  private:
    PairShadow find(Slot lit, Slot occluder, std::size_t light);

    const FastScene& scene_;
    StageCounts counts_;
    PairCache<PairShadow> kept_;
};

}  // namespace nuvo
