#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"

namespace nuvo {

/// Fetches the corners of triangles in any order, 16 at a time. They lie behind a primitive's
/// source, its mesh and its indices; while one batch is used the next ones' are prefetched, each by
/// one step.
class CornerFetch {
  public:
    static constexpr std::size_t kBatch = 16;

    explicit CornerFetch(const FastScene& scene) : scene_(scene) {}

    /// Adds at most kBatch triangles and moves all that are on their way on by one step. The oldest
    /// are then in slot() and corners().
    void advance(const Slot* slots, std::size_t count) {
        Batch& newest = batches_[newest_];
        newest.count = count;
        std::copy_n(slots, count, newest.slot.begin());
        for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(&scene_.source(slots[i]));
        follow_source(batches_[(newest_ + 3) % kSteps]);
        follow_indices(batches_[(newest_ + 2) % kSteps]);
        newest_ = (newest_ + 1) % kSteps;
        gather(batches_[newest_]);
    }
    /// Whether nothing is on its way.
    bool empty() const {
        return std::all_of(batches_.begin(), batches_.end(),
                           [](const Batch& batch) { return batch.count == 0; });
    }

    std::size_t count() const { return count_; }
    Slot slot(std::size_t i) const { return slots_[i]; }
    /// Those of places 8 half to 8 half + 7; beyond count() the first one's.
    const TriangleBatch& corners(std::size_t half) const { return corners_[half]; }

  private:
    struct Batch {
        std::size_t count = 0;
        std::array<Slot, kBatch> slot{};
        std::array<const IndexTriple*, kBatch> indices;
        std::array<const Point3*, kBatch> positions;
    };

    void follow_source(Batch& batch) const {
        for (std::size_t i = 0; i < batch.count; ++i) {
            const PrimitiveSource& source = scene_.source(batch.slot[i]);
            const TriangleMesh& mesh = scene_.mesh(source);
            batch.indices[i] = &mesh.triangles[source.triangle];
            batch.positions[i] = mesh.positions.data();
            __builtin_prefetch(batch.indices[i]);
        }
    }
    static void follow_indices(const Batch& batch) {
        for (std::size_t i = 0; i < batch.count; ++i)
            for (const std::uint32_t index : *batch.indices[i])
                __builtin_prefetch(batch.positions[i] + index);
    }
    void gather(Batch& batch) {
        for (std::size_t i = 0; i < batch.count; ++i) {
            TriangleBatch& to = corners_[i / TriangleBatch::kSize];
            for (std::size_t k = 0; k < 3; ++k)
                to.put(i % TriangleBatch::kSize, k, batch.positions[i][(*batch.indices[i])[k]]);
        }
        const std::size_t rest = batch.count % TriangleBatch::kSize;
        if (rest != 0) corners_[batch.count / TriangleBatch::kSize].fill_up(rest);
        const std::uint32_t front_only = scene_.front_only(batch.slot.data());
        for (std::size_t half = 0; half < corners_.size(); ++half)
            corners_[half].front_only =
                front_only >> half * TriangleBatch::kSize & ((1U << TriangleBatch::kSize) - 1);
        slots_ = batch.slot;
        count_ = std::exchange(batch.count, std::size_t{0});
    }

    const FastScene& scene_;
    static constexpr std::size_t kSteps = 4;
    std::array<Batch, kSteps> batches_{};
    std::size_t newest_ = 0;
    std::size_t count_ = 0;
    std::array<Slot, kBatch> slots_{};
    std::array<TriangleBatch, kBatch / TriangleBatch::kSize> corners_;
};

}  // namespace nuvo
