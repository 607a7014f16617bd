#include "fast/scene/fast_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fast/scene/local_triangles.h"
#include "fast/scene/octant_tests.h"
#include "fast/scene/slot_order.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/parallel.h"
#include "nuvo/octree/compact_build.h"

// Everything that is rounded here is rounded outwards: a box holds the true primitive as the local
// frame's exact mapping places it. Of the floats made for the octree's construction only triangles'
// corners, and which backs are invisible, outlive it.

namespace nuvo {
namespace {

// Below (above) the true number from which `nearest` was rounded: by one unit in the last place and
// more, at least by the smallest normal number. Local coordinates in double are off by a relative
// 2^-53 or an absolute 2^-1074, of which nothing matters here.
float below(float nearest) {
    return nearest - (std::fabs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
float above(float nearest) { return -below(-nearest); }

Bounds3T<float> local_box(const LocalFrame& frame, const Bounds3& box) {
    const Vec3<float> low(frame.local(box.min));
    const Vec3<float> high(frame.local(box.max));
    return {{below(low.x), below(low.y), below(low.z)},
            {above(high.x), above(high.y), above(high.z)}};
}

// What the octree's construction needs, by slot.
struct LocalItems {
    BigVector<Bounds3T<float>> boxes;
    BigVector<LocalTriangle> triangles;
    BigVector<LocalSphere> spheres;
    BigVector<std::uint8_t> front_only;  // of triangles, 8 in a byte
};

LocalItems local_items(const FastScene& fast, int threads) {
    LocalItems items;
    items.boxes.resize(fast.slot_end());
    items.triangles.resize(fast.triangle_end());
    items.spheres.resize(fast.sphere_end() - fast.triangle_end());
    items.front_only.resize((items.triangles.size() + 7) / 8);
    const LocalTrianglesJob job{fast.frame(), items.triangles.data(), items.boxes.data(),
                                items.front_only.data()};
    for_each_chunk(fast, {}, fast.triangle_end(), threads,
                   [&](const TriangleChunk& chunk) { make_local_triangles(job, chunk); });
    for_each_part(threads, fast.quadrics().size(), [&](std::size_t begin, std::size_t end) {
        for (const QuadricSlot& quadric : fast.quadrics().subspan(begin, end - begin)) {
            fast.prefetched_after(quadric);
            items.boxes[quadric.slot] =
                local_box(fast.frame(), fast.primitives().item_boxes[quadric.id]);
            if (quadric.slot < fast.sphere_end())
                items.spheres[quadric.slot - fast.triangle_end()] =
                    fast.local(std::get<Sphere>(fast.object(quadric.id).shape));
        }
    });
    return items;
}

// Items ascend, so those of a kind stand together. Of an ellipsoid the box decides.
OctantTest octant_test(const LocalItems& items) {
    const auto triangle_end = static_cast<std::uint32_t>(items.triangles.size());
    const auto sphere_end = triangle_end + static_cast<std::uint32_t>(items.spheres.size());
    return [&items, triangle_end, sphere_end](const CutVoxel& voxel,
                                              std::span<const std::uint32_t> slots,
                                              std::span<std::uint8_t> masks) {
        const auto place = [&](std::uint32_t end) {
            return static_cast<std::size_t>(std::lower_bound(slots.begin(), slots.end(), end) -
                                            slots.begin());
        };
        const std::size_t triangles = triangle_end == 0 ? 0 : place(triangle_end);
        const std::size_t spheres = sphere_end == triangle_end ? triangles : place(sphere_end);
        if (triangles > 0)
            clear_octants(items.triangles, voxel, slots.first(triangles), masks.first(triangles));
        if (spheres > triangles)
            clear_octants(items.spheres, triangle_end, voxel,
                          slots.subspan(triangles, spheres - triangles),
                          masks.subspan(triangles, spheres - triangles));
    };
}

CompactOctree octree_of(const LocalItems& items, CompactBuildOptions options) {
    options.overlaps = octant_test(items);
    return build_compact_octree(items.boxes, options);
}

}  // namespace

FastScene::FastScene(const Scene& scene, const Primitives& primitives,
                     std::optional<OctreeType> type, int threads, BackFaces back_faces,
                     Progress* progress)
    : scene_(scene), primitives_(primitives), back_faces_(back_faces) {
    for (const KindSummary& kind : primitives.kinds) box_ = box_.extended(kind.box);
    frame_ = local_frame(primitives, box_);
    if (!box_.empty()) largest_coordinate_ = std::max(max_norm(box_.min), max_norm(box_.max));
    const auto count = [&](PrimitiveKind kind) {
        return static_cast<Slot>(primitives.kind(kind).count);
    };
    triangle_end_ = count(PrimitiveKind::kTriangle);
    sphere_end_ = triangle_end_ + count(PrimitiveKind::kSphere);
    slot_end_ = sphere_end_ + count(PrimitiveKind::kEllipsoid);
    order_slots();
    map_ellipsoids(threads);
    CompactBuildOptions options;
    options.rule = std::nullopt;
    if (type) options.rule = *type == OctreeType::kUniform ? CutRule::kSpatial : CutRule::kSweep;
    options.threads = threads;
    options.progress = progress;
    LocalItems items = local_items(*this, options.threads);
    octree_ = octree_of(items, options);
    triangles_ = std::move(items.triangles);
    if (std::any_of(items.front_only.begin(), items.front_only.end(),
                    [](std::uint8_t eight) { return eight != 0; }))
        front_only_ = std::move(items.front_only);
    if (!octree_.bounds.empty())
        reach_ = std::max(max_norm(octree_.bounds.min), max_norm(octree_.bounds.max));
}

void FastScene::order_slots() {
    if (primitives_.sorted_by_kind && slot_end_ == triangle_end_) return;
    std::vector<PrimitiveId> of_kind[3];
    for (PrimitiveId id = 0; id < slot_end_; ++id)
        of_kind[static_cast<std::size_t>(kind_of(object(id).shape))].push_back(id);
    for (const PrimitiveKind kind : {PrimitiveKind::kSphere, PrimitiveKind::kEllipsoid})
        sort_in_space(primitives_, box_, of_kind[static_cast<std::size_t>(kind)]);
    std::vector<Slot> slots(slot_end_);
    bool document_order = true;
    for (const std::vector<PrimitiveId>& ids : of_kind)
        for (const PrimitiveId id : ids) {
            const auto slot = static_cast<Slot>(ids_.size());
            document_order &= id == slot;
            slots[id] = slot;
            ids_.push_back(id);
        }
    quadrics_.reserve(slot_end_ - triangle_end_);
    for (PrimitiveId id = 0; id < slot_end_; ++id)
        if (slots[id] >= triangle_end_) quadrics_.push_back({id, slots[id]});
    if (document_order) ids_ = {};
}

// Each step asks for memory by what the one before has fetched: for all slots a step before the
// next.
void FastScene::prefetch(std::span<const Slot> slots) const {
    if (!ids_.empty())
        for (const Slot slot : slots) __builtin_prefetch(&ids_[slot]);
    for (const Slot slot : slots) __builtin_prefetch(&source(slot));
    for (const Slot slot : slots) prefetch_object(object(id(slot)));
    const auto for_each_triangle = [&](auto&& use) {
        for (const Slot slot : slots) {
            if (slot >= triangle_end_) continue;
            const PrimitiveSource& from = source(slot);
            use(mesh(from), from.triangle);
        }
    };
    for_each_triangle([](const TriangleMesh& mesh, std::uint32_t triangle) {
        __builtin_prefetch(&mesh.triangles[triangle]);
    });
    for_each_triangle([](const TriangleMesh& mesh, std::uint32_t triangle) {
        for (const std::uint32_t corner : mesh.triangles[triangle])
            __builtin_prefetch(&mesh.positions[corner]);
    });
}

void FastScene::map_ellipsoids(int threads) {
    balls_.resize(slot_end_ - sphere_end_);
    for_each_part(threads, balls_.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto slot = sphere_end_ + static_cast<Slot>(i);
            balls_[i] = ball_map(std::get<Ellipsoid>(object(id(slot)).shape), frame_);
        }
    });
}

}  // namespace nuvo
