#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fast/scene/fast_scene.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// The sphere's largest number.
inline float size_of(const LocalSphere& sphere) {
    return std::fmax(sphere.radius, max_norm(sphere.center));
}

/// Where a light stands towards a quadric; kBlind: it sees no front of it, or the shape casts
/// no shadow.
enum class LightSide : std::uint8_t { kOutside, kInside, kBlind, kUnknown };

/// What may stand in a light's way: items by their places in a list.
struct LightItems {
    const FastScene& scene;
    const BigVector<LocalSphere>& quadrics;  ///< or spheres around them, by slot - triangle_end
    double touch;                            ///< what lies within this of a shadow ray may block it
    /// Ascending; null: all slots, each at its own place.
    const BigVector<Slot>* slots = nullptr;
    /// Which triangles may hide something, by place, 8 in a byte, and 2 more bytes; null: all.
    const std::uint8_t* hides = nullptr;

    Slot size() const { return slots ? static_cast<Slot>(slots->size()) : scene.slot_end(); }
    Slot slot(Slot place) const { return slots ? (*slots)[place] : place; }
    /// The places of triangles end here.
    Slot triangles() const {
        if (!slots) return scene.triangle_end();
        return static_cast<Slot>(
            std::lower_bound(slots->begin(), slots->end(), scene.triangle_end()) - slots->begin());
    }
};

}  // namespace nuvo
