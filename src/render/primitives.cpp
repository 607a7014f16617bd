#include "nuvo/render/primitives.h"

namespace nuvo {
namespace {

// Meshes lie anywhere in memory: they are asked for by so many objects before they are needed.
constexpr std::size_t kPrefetchAhead = 8;

// Adds what has been appended since there were so many items and primitives; sees kinds in order.
class Summarizer {
  public:
    explicit Summarizer(Primitives& out) : out_(out) {}

    void add(PrimitiveKind kind) {
        KindSummary& summary = out_.kinds[static_cast<std::size_t>(kind)];
        summary.count += out_.sources.size() - primitives_;
        Bounds3 box = summary.box;
        for (; items_ < out_.item_boxes.size(); ++items_)
            box = box.extended(out_.item_boxes[items_]);
        summary.box = box;
        if (out_.sources.size() == primitives_) return;
        primitives_ = out_.sources.size();
        out_.sorted_by_kind &= kind >= last_;
        last_ = kind;
    }

  private:
    Primitives& out_;
    std::size_t primitives_ = 0;
    std::size_t items_ = 0;
    PrimitiveKind last_ = PrimitiveKind::kTriangle;
};

void ask_for(const Object& object) {
    __builtin_prefetch(&object);
    __builtin_prefetch(reinterpret_cast<const char*>(&object + 1) - 1);
}

void ask_for_lists(const Shape& shape) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape);
    if (!mesh) return;
    __builtin_prefetch(mesh->triangles.data());
    __builtin_prefetch(mesh->positions.data());
    __builtin_prefetch(reinterpret_cast<const char*>(mesh->positions.data()) + 64);
}

void make_room(std::size_t primitives, std::size_t items, Primitives& out) {
    out.sources.reserve(primitives);
    out.item_first.reserve(items + 1);
    out.item_boxes.reserve(items);
}

std::size_t triangles_from(const Scene& scene, std::size_t first) {
    std::size_t count = 0;
    for (std::size_t i = first; i < scene.objects.size(); ++i)
        if (const auto* mesh = std::get_if<TriangleMesh>(&scene.objects[i].shape))
            count += mesh->triangles.size();
    return count;
}

void add_mesh(const TriangleMesh& mesh, std::uint32_t object, LeafContent leaves, Primitives& out) {
    const bool whole = leaves == LeafContent::kShapes;
    const std::size_t first = out.sources.size();
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
    make_room(scene.objects.size(), scene.objects.size(), out);
    bool any_mesh = false;
    Summarizer summarizer(out);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (i + 2 * kPrefetchAhead < scene.objects.size())
            ask_for(scene.objects[i + 2 * kPrefetchAhead]);
        if (i + kPrefetchAhead < scene.objects.size())
            ask_for_lists(scene.objects[i + kPrefetchAhead].shape);
        const Shape& shape = scene.objects[i].shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
            if (!any_mesh) {
                const std::size_t most = scene.objects.size() + triangles_from(scene, i);
                make_room(most, leaves == LeafContent::kPrimitives ? most : 0, out);
                any_mesh = true;
            }
            add_mesh(*mesh, i, leaves, out);
        } else {
            out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
            out.item_boxes.push_back(bounds(shape));
            out.sources.push_back({i, 0});
        }
        summarizer.add(kind_of(shape));
        out.all_cast_shadows &= scene.objects[i].casts_shadow;
    }
    out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
    return out;
}

}  // namespace nuvo
