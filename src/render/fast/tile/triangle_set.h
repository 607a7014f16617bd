#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>

#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// A set of triangles by batches of 8 slots: a batch is in it as a whole.
class TriangleSet {
  public:
    TriangleSet() = default;
    /// None of the scene's.
    explicit TriangleSet(const FastScene& scene)
        : end_(scene.triangle_end()), has_((end_ + kBatch - 1) / kBatch, 0) {}

    /// By several threads at a time; slots of other items, and kNoSlot, are passed over.
    void add(std::span<const Slot> slots) {
        Slot last = kNoSlot;
        for (const Slot slot : slots) {
            const Slot batch = slot / kBatch;
            if (batch == last || slot >= end_) continue;
            last = batch;
            std::atomic_ref(has_[batch]).store(1, std::memory_order_relaxed);
        }
    }
    bool has_all() const {
        return std::find(has_.begin(), has_.end(), std::uint8_t{0}) == has_.end();
    }
    void add_all() { std::fill(has_.begin(), has_.end(), std::uint8_t{1}); }

    /// About how many triangles: those of whole batches.
    std::size_t size() const {
        return kBatch * static_cast<std::size_t>(std::count(has_.begin(), has_.end(), 1));
    }
    /// The slots that `other` has not, ascending.
    BigVector<Slot> slots_beside(const TriangleSet& other) const {
        BigVector<Slot> out;
        for (Slot batch = 0; batch < has_.size(); ++batch) {
            if (has_[batch] == 0 || other.has_[batch] != 0) continue;
            for (Slot slot = batch * kBatch; slot < std::min(end_, (batch + 1) * kBatch); ++slot)
                out.push_back(slot);
        }
        return out;
    }
    std::size_t memory_bytes() const { return has_.size(); }

  private:
    static constexpr Slot kBatch = TriangleBatch::kSize;

    Slot end_ = 0;
    BigVector<std::uint8_t> has_;
};

}  // namespace nuvo
