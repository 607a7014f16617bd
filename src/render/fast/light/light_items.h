#pragma once

#include <algorithm>
#include <cstdint>

#include "fast/scene/fast_scene.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// Where a light stands towards a quadric; kNoShadow: it sees no front of it, or the shape casts
/// no shadow.
enum class LightSide : std::uint8_t { kOutside, kInside, kNoShadow, kUnknown };

/// What may stand in a light's way: items by their places in a list.
struct LightItems {
    const FastScene& scene;
    const BigVector<LocalSphere>& quadrics;  ///< or spheres around them, by slot - triangle_end
    double touch;                            ///< what lies within this of a shadow ray may block it
    SlotList slots = {};                     ///< theirs
    /// Which triangles may hide something, by place, 8 in a byte, and 2 more bytes; null: all.
    const std::uint8_t* hides = nullptr;

    Slot size() const {
        return slots.list ? static_cast<Slot>(slots.list->size()) : scene.slot_end();
    }
    Slot slot(Slot place) const { return slots[place]; }
    /// The places of triangles end here.
    Slot triangles() const {
        if (slots.list == nullptr) return scene.triangle_end();
        return static_cast<Slot>(
            std::lower_bound(slots.list->begin(), slots.list->end(), scene.triangle_end()) -
            slots.list->begin());
    }
};

}  // namespace nuvo
