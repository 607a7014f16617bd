#include "nuvo/app/memory.h"

#include <sys/resource.h>

#include "nuvo/math/big_vector.h"

namespace nuvo::app {
namespace {

std::size_t memory_bytes(const TriangleMesh& mesh) {
    return vector_bytes(mesh.positions) + vector_bytes(mesh.triangles) +
           vector_bytes(mesh.normals) + vector_bytes(mesh.normal_triangles) +
           vector_bytes(mesh.colors) + vector_bytes(mesh.color_triangles);
}

}  // namespace

std::size_t peak_memory_bytes() {
    constexpr std::size_t kUnit = 1024;  // Linux tells kilobytes
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return kUnit * static_cast<std::size_t>(usage.ru_maxrss);
}

std::size_t memory_bytes(const Scene& scene) {
    std::size_t bytes =
        vector_bytes(scene.objects) + vector_bytes(scene.materials) + vector_bytes(scene.lights);
    for (const Object& object : scene.objects)
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
            bytes += memory_bytes(*mesh);
    return bytes;
}

std::size_t memory_bytes(const Primitives& primitives) {
    return vector_bytes(primitives.sources) + vector_bytes(primitives.item_first) +
           vector_bytes(primitives.item_boxes);
}

}  // namespace nuvo::app
