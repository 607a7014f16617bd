#pragma once

#include <vector>

#include "fast/light/shadow_planes.h"
#include "fast/shadow/shadow_tables.h"

namespace nuvo {

/// The planes of triangles that a walk of the octree meets. Where a light's table does not hold all
/// they are made, 8 neighbours at a time, and the latest are kept. For one thread.
class WalkPlanes {
  public:
    explicit WalkPlanes(const ShadowTables& tables) : tables_(tables) {}

    /// Null: the triangle hides nothing from the light. Valid until the next call.
    const ShadowPlanes* of(std::size_t light, Slot slot) {
        const ShadowTable& table = tables_.table(light);
        if (table.complete())
            return hides(table.hides[slot / 8], slot) ? &table.planes[slot] : nullptr;
        if (batches_.empty()) batches_.resize(kPlaces);
        const Slot first = slot / kEight * kEight;
        Batch& batch = batches_[(slot / kEight + light) % kPlaces];
        if (batch.first != first || batch.light != light) make(batch, light, first);
        return hides(batch.hides, slot) ? &batch.planes[slot - first] : nullptr;
    }

    /// False: what a table holds says that the item hides nothing from the light.
    bool may_hide(std::size_t light, Slot slot) const {
        const ShadowTable& table = tables_.table(light);
        return !table.complete() || slot >= table.triangles || hides(table.hides[slot / 8], slot);
    }

  private:
    static constexpr std::size_t kPlaces = 256;
    static constexpr Slot kEight = TriangleBatch::kSize;

    struct Batch {
        ShadowPlanes planes[TriangleBatch::kSize];
        Slot first = kNoSlot;
        std::size_t light = 0;
        std::uint8_t hides = 0;
    };

    static bool hides(std::uint8_t eight, Slot slot) { return (eight >> slot % 8 & 1) != 0; }
    void make(Batch& batch, std::size_t light, Slot first);

    const ShadowTables& tables_;
    std::vector<Batch> batches_;
    TriangleChunk chunk_;
};

}  // namespace nuvo
