#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>

#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// Which triangles a picture shows, by batches of 8 slots. The first batch counts as seen: kernels
/// read slot 0 in lanes that show no triangle.
class SeenTriangles {
  public:
    explicit SeenTriangles(const FastScene& scene)
        : end_(scene.triangle_end()), seen_((end_ + kBatch - 1) / kBatch, 0) {
        if (end_ > 0) seen_[0] = 1;
    }

    /// By several threads at a time; slots of other items, and kNoSlot, are passed over.
    void add(std::span<const Slot> slots) {
        Slot last = kNoSlot;
        for (const Slot slot : slots) {
            const Slot batch = slot / kBatch;
            if (batch == last || slot >= end_) continue;
            last = batch;
            std::atomic_ref(seen_[batch]).store(1, std::memory_order_relaxed);
        }
    }

    /// The slots of all batches of which something is seen, ascending.
    BigVector<Slot> slots() const {
        BigVector<Slot> out;
        for (Slot batch = 0; batch < seen_.size(); ++batch) {
            if (seen_[batch] == 0) continue;
            for (Slot slot = batch * kBatch; slot < std::min(end_, (batch + 1) * kBatch); ++slot)
                out.push_back(slot);
        }
        return out;
    }

  private:
    static constexpr Slot kBatch = TriangleBatch::kSize;

    Slot end_;
    BigVector<std::uint8_t> seen_;
};

}  // namespace nuvo
