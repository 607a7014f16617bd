#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "fast/scene/fast_scene.h"

// Corners lie behind an object, its mesh and the mesh's lists: several times as far away as the
// numbers that are made of them. So they are prefetched, and fetched by chunks that stay in the
// nearest cache while the tables of all lights are made of them.

namespace nuvo {

/// The corners of 8 triangles in world space by coordinate: a.x, a.y, a.z, b.x ... c.z.
struct alignas(64) TriangleBatch {
    static constexpr std::size_t kSize = 8;
    double corner[9][kSize];
    std::uint32_t front_only;  ///< bit i: the back of triangle i is invisible
    std::uint32_t shadowless;  ///< bit i: it casts no shadow

    /// Corner k (0: a) of triangle i.
    void put(std::size_t i, std::size_t k, const Point3& p) {
        corner[3 * k][i] = p.x;
        corner[3 * k + 1][i] = p.y;
        corner[3 * k + 2][i] = p.z;
    }
    /// Fills the places from `count` on with the first triangle.
    void fill_up(std::size_t count) {
        for (auto& column : corner) std::fill(column + count, column + kSize, column[0]);
    }
    Triangle triangle(std::size_t i) const {
        return {{corner[0][i], corner[1][i], corner[2][i]},
                {corner[3][i], corner[4][i], corner[5][i]},
                {corner[6][i], corner[7][i], corner[8][i]}};
    }
};

/// Some triangles by their places. first is a multiple of TriangleBatch::kSize.
struct TriangleChunk {
    static constexpr Slot kTriangles = 256;

    /// Fetches those of places [first, last).
    void fetch(const FastScene& scene, SlotList list, Slot first_place, Slot last_place);

    SlotList slots;
    Slot first = 0;
    Slot last = 0;
    std::array<TriangleBatch, kTriangles / TriangleBatch::kSize> batches;

    /// Calls work(batch, its first place, its number of triangles); beyond that number a batch is
    /// filled up with its first triangle.
    template <typename Work>
    void for_each_batch(Work&& work) const {
        for (Slot slot = first; slot < last; slot += TriangleBatch::kSize)
            work(batches[(slot - first) / TriangleBatch::kSize], slot,
                 std::min<std::size_t>(TriangleBatch::kSize, last - slot));
    }
};

/// Calls work(chunk) for the triangles of the first `count` places, on up to `threads` threads at a
/// time.
void for_each_chunk(const FastScene& scene, SlotList slots, Slot count, int threads,
                    const std::function<void(const TriangleChunk&)>& work);

}  // namespace nuvo
