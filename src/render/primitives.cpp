#include "nuvo/render/primitives.h"

#include <algorithm>

namespace nuvo {
namespace {

// For `more` elements, at least doubling what there is: so growing stays linear.
template <typename T>
void make_room(std::vector<T>& list, std::size_t more) {
    const std::size_t needed = list.size() + more;
    if (needed > list.capacity()) list.reserve(std::max(needed, 2 * list.capacity()));
}

void add_mesh(const TriangleMesh& mesh, std::uint32_t object, LeafContent leaves, Primitives& out) {
    const bool whole = leaves == LeafContent::kShapes;
    const std::size_t first = out.sources.size();
    make_room(out.sources, mesh.triangles.size());
    if (!whole) {
        make_room(out.item_first, mesh.triangles.size());
        make_room(out.item_boxes, mesh.triangles.size());
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle triangle = mesh.triangle(i);
        if (has_zero_area(triangle)) {
            ++out.zero_area_triangles;
            continue;
        }
        if (!whole) {
            out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
            out.item_boxes.push_back(triangle.bounds());
        }
        out.sources.push_back({object, static_cast<std::uint32_t>(i)});
    }
    if (whole && out.sources.size() > first) {
        out.item_first.push_back(static_cast<PrimitiveId>(first));
        out.item_boxes.push_back(mesh.bounds());
    }
}

}  // namespace

Primitives flatten(const Scene& scene, LeafContent leaves) {
    Primitives out;
    out.sources.reserve(scene.objects.size());
    out.item_first.reserve(scene.objects.size() + 1);
    out.item_boxes.reserve(scene.objects.size());
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Shape& shape = scene.objects[i].shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
            add_mesh(*mesh, i, leaves, out);
        } else {
            out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
            out.item_boxes.push_back(bounds(shape));
            out.sources.push_back({i, 0});
        }
    }
    out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
    return out;
}

}  // namespace nuvo
