#pragma once

#include <array>

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

    /// Adds a triangle; true if the newest batch is full: advance() before the next one.
    bool add(Slot slot) {
        Batch& batch = batches_[newest_];
        __builtin_prefetch(&scene_.source(slot));
        batch.slot[batch.count++] = slot;
        return batch.count == kBatch;
    }

    /// Moves every batch on by one step. The oldest is then in slots() and corners().
    void advance() {
        follow_source(batches_[newest_]);
        follow_indices(batches_[(newest_ + 2) % 3]);
        newest_ = (newest_ + 1) % 3;
        Batch& oldest = batches_[newest_];
        gather(oldest);
        count_ = oldest.count;
        slots_ = oldest.slot;
        oldest.count = 0;
        oldest.front_only = 0;
    }
    /// Whether nothing is on its way.
    bool empty() const { return batches_[0].count + batches_[1].count + batches_[2].count == 0; }

    std::size_t count() const { return count_; }
    Slot slot(std::size_t i) const { return slots_[i]; }
    /// Those of places 8 half to 8 half + 7; beyond count() the first one's.
    const TriangleBatch& corners(std::size_t half) const { return corners_[half]; }

  private:
    struct Batch {
        std::size_t count = 0;
        std::array<Slot, kBatch> slot;
        std::array<const IndexTriple*, kBatch> indices;
        std::array<const Point3*, kBatch> positions;
        std::uint32_t front_only = 0;  // a bit each
    };

    void follow_source(Batch& batch) const {
        for (std::size_t i = 0; i < batch.count; ++i) {
            const PrimitiveSource& source = scene_.source(batch.slot[i]);
            const Object& object = scene_.scene().objects[source.object];
            const auto& mesh = *std::get_if<TriangleMesh>(&object.shape);
            if (scene_.front_only(object)) batch.front_only |= 1U << i;
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
    void gather(const Batch& batch) {
        for (std::size_t i = 0; i < batch.count; ++i) {
            TriangleBatch& to = corners_[i / TriangleBatch::kSize];
            for (std::size_t k = 0; k < 3; ++k)
                to.put(i % TriangleBatch::kSize, k, batch.positions[i][(*batch.indices[i])[k]]);
        }
        const std::size_t rest = batch.count % TriangleBatch::kSize;
        if (rest != 0) corners_[batch.count / TriangleBatch::kSize].fill_up(rest);
        for (std::size_t half = 0; half < corners_.size(); ++half)
            corners_[half].front_only = batch.front_only >> half * TriangleBatch::kSize &
                                        ((1U << TriangleBatch::kSize) - 1);
    }

    const FastScene& scene_;
    std::array<Batch, 3> batches_{};
    std::size_t newest_ = 0;
    std::size_t count_ = 0;
    std::array<Slot, kBatch> slots_{};
    std::array<TriangleBatch, kBatch / TriangleBatch::kSize> corners_;
};

}  // namespace nuvo
