#include "nuvo/render/primitives.h"

#include <algorithm>
#include <vector>

#include "nuvo/math/parallel.h"

namespace nuvo {
namespace {

// Meshes lie anywhere in memory: they are asked for by so many objects before they are needed.
constexpr std::size_t kPrefetchAhead = 8;

// Adds what has been appended since there were so many primitives; sees kinds in order.
class Summarizer {
  public:
    explicit Summarizer(Primitives& out) : out_(out) {}

    void add(PrimitiveKind kind, const Bounds3& box) {
        KindSummary& summary = out_.kinds[static_cast<std::size_t>(kind)];
        summary.count += out_.sources.size() - primitives_;
        summary.box = summary.box.extended(box);
        if (out_.sources.size() == primitives_) return;
        primitives_ = out_.sources.size();
        out_.sorted_by_kind &= kind >= last_;
        last_ = kind;
    }

  private:
    Primitives& out_;
    std::size_t primitives_ = 0;
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

// Some of a mesh's triangles.
struct MeshPart {
    Bounds3 box;           // of those with an area
    std::size_t flat = 0;  // how many have none
};

// Fills the places of triangles [begin, end) as if all of the mesh's had an area; the mesh's first
// has place `first`.
MeshPart fill_part(const TriangleMesh& mesh, PrimitiveSource source, std::size_t first, bool whole,
                   std::size_t begin, std::size_t end, Primitives& out) {
    MeshPart part;
    for (std::size_t i = begin; i < end; ++i) {
        const Triangle triangle = mesh.triangle(i);
        const Bounds3 box = triangle.bounds();
        if (has_zero_area(triangle))
            ++part.flat;
        else
            part.box = part.box.extended(box);
        source.triangle = static_cast<std::uint32_t>(i);
        out.sources[first + i] = source;
        if (!whole) out.item_boxes[first + i] = box;
    }
    return part;
}

// Takes the triangles without area out of the places from `first` on.
void drop_flat(const TriangleMesh& mesh, std::size_t first, bool whole, Primitives& out) {
    std::size_t to = first;
    for (std::size_t from = first; from < out.sources.size(); ++from) {
        if (has_zero_area(mesh.triangle(out.sources[from].triangle))) continue;
        out.sources[to] = out.sources[from];
        if (!whole) out.item_boxes[to] = out.item_boxes[from];
        ++to;
    }
    out.sources.resize(to);
    if (!whole) out.item_boxes.resize(to);
}

// Returns the box around its items; single primitives among these have still to be numbered.
Bounds3 add_mesh(const TriangleMesh& mesh, std::uint32_t object, LeafContent leaves, int threads,
                 Primitives& out) {
    const bool whole = leaves == LeafContent::kShapes;
    const std::size_t first = out.sources.size();
    const std::size_t count = mesh.triangles.size();
    out.sources.resize(first + count);
    if (!whole) out.item_boxes.resize(first + count);
    constexpr std::size_t kStep = 4096;
    const auto fill = [&](std::size_t begin, std::size_t end) {
        return fill_part(mesh, {object, 0}, first, whole, begin, end, out);
    };
    MeshPart all;
    if (count <= kStep) {
        all = fill(0, count);
    } else {
        std::vector<MeshPart> parts((count + kStep - 1) / kStep);
        for_each_index(threads, parts.size(), [&](std::size_t i, int) {
            parts[i] = fill(i * kStep, std::min(count, (i + 1) * kStep));
        });
        for (const MeshPart& part : parts) {
            all.box = all.box.extended(part.box);
            all.flat += part.flat;
        }
    }
    out.zero_area_triangles += all.flat;
    if (all.flat > 0) drop_flat(mesh, first, whole, out);
    if (!whole || out.sources.size() == first) return all.box;
    out.item_first.push_back(static_cast<PrimitiveId>(first));
    return out.item_boxes.emplace_back(mesh.bounds());
}

// Items that are single primitives have their numbers.
void number_items(int threads, Primitives& out) {
    out.item_first.resize(out.sources.size());
    for_each_part(threads, out.sources.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) out.item_first[i] = static_cast<PrimitiveId>(i);
    });
}

}  // namespace

Primitives flatten(const Scene& scene, LeafContent leaves, int threads) {
    const bool whole = leaves == LeafContent::kShapes;
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
        Bounds3 box;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
            if (!any_mesh) {
                const std::size_t most = scene.objects.size() + triangles_from(scene, i);
                make_room(most, whole ? 0 : most, out);
                any_mesh = true;
            }
            box = add_mesh(*mesh, i, leaves, threads, out);
        } else {
            box = bounds(shape);
            if (whole) out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
            out.item_boxes.push_back(box);
            out.sources.push_back({i, 0});
        }
        summarizer.add(kind_of(shape), box);
        out.all_cast_shadows &= scene.objects[i].casts_shadow;
    }
    if (!whole) number_items(threads, out);
    out.item_first.push_back(static_cast<PrimitiveId>(out.sources.size()));
    return out;
}

}  // namespace nuvo
