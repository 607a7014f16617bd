#include "fast/scene/triangle_chunk.h"

#include <algorithm>
#include <vector>

#include "nuvo/math/parallel.h"

namespace nuvo {
namespace {

// Meshes are prefetched by this many triangles ahead.
constexpr Slot kAhead = 48;

// The lists of a small mesh: those of a large one are longer, and read in about their order.
void ask_for(const TriangleMesh& mesh) {
    constexpr std::size_t kLine = 64;
    constexpr std::size_t kLines = 3;
    const auto* const positions = reinterpret_cast<const char*>(mesh.positions.data());
    const auto* const triangles = reinterpret_cast<const char*>(mesh.triangles.data());
    for (std::size_t i = 0; i < kLines; ++i) __builtin_prefetch(positions + i * kLine);
    __builtin_prefetch(triangles);
    __builtin_prefetch(triangles + kLine);
}

}  // namespace

void TriangleChunk::fetch(const FastScene& scene, SlotList list, Slot first_place,
                          Slot last_place) {
    slots = list;
    first = first_place;
    last = last_place;
    // Those of a list lie far apart in memory.
    if (list.list != nullptr) scene.prefetch({list.list->data() + first, last - first});
    const Slot end = list.list != nullptr ? last : scene.triangle_end();  // of places to look at
    Slot place = first;
    while (place < last) {
        const PrimitiveSource& source = scene.source(list[place]);
        const Object& object = scene.scene().objects[source.object];
        const TriangleMesh& mesh = scene.mesh(source);
        const std::uint32_t front_only = scene.front_only(object) ? 1 : 0;
        const std::uint32_t shadowless = object.casts_shadow ? 0 : 1;
        if (end - place > kAhead) ask_for(scene.mesh(scene.source(list[place + kAhead])));
        for (; place < last && scene.source(list[place]).object == source.object; ++place) {
            const IndexTriple& corners = mesh.triangles[scene.source(list[place]).triangle];
            TriangleBatch& batch = batches[(place - first) / TriangleBatch::kSize];
            const std::size_t lane = (place - first) % TriangleBatch::kSize;
            batch.front_only = (lane == 0 ? 0 : batch.front_only) | front_only << lane;
            batch.shadowless = (lane == 0 ? 0 : batch.shadowless) | shadowless << lane;
            for (std::size_t k = 0; k < 3; ++k) batch.put(lane, k, mesh.positions[corners[k]]);
        }
    }
    const std::size_t rest = (last - first) % TriangleBatch::kSize;
    if (rest != 0) batches[(last - first) / TriangleBatch::kSize].fill_up(rest);
}

void for_each_chunk(const FastScene& scene, SlotList slots, Slot count, int threads,
                    const std::function<void(const TriangleChunk&)>& work) {
    // A thread takes so many chunks at a time: few, so that a small scene's can be shared.
    constexpr std::size_t kChunksAtOnce = 8;
    constexpr std::size_t kStep = kChunksAtOnce * TriangleChunk::kTriangles;
    for_each_index(threads, (count + kStep - 1) / kStep, [&](std::size_t i, int) {
        TriangleChunk chunk;
        const std::size_t last = std::min<std::size_t>(count, (i + 1) * kStep);
        for (std::size_t first = i * kStep; first < last; first += TriangleChunk::kTriangles) {
            chunk.fetch(
                scene, slots, static_cast<Slot>(first),
                static_cast<Slot>(std::min<std::size_t>(last, first + TriangleChunk::kTriangles)));
            work(chunk);
        }
    });
}

}  // namespace nuvo
