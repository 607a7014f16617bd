#include "fast_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "big_vector.h"
#include "nuvo/math/parallel.h"
#include "nuvo/octree/compact_build.h"
#include "octant_tests.h"
#include "slot_order.h"

// Everything that is rounded here is rounded outwards: a box holds the true primitive as the local
// frame's exact mapping places it. The floats made of corners and centres serve the octree's
// construction only and are gone with it.

namespace nuvo {
namespace {

enum Kind : std::uint8_t { kTriangleKind, kSphereKind, kEllipsoidKind };

Kind kind_of(const Object& object) {
    if (std::holds_alternative<TriangleMesh>(object.shape)) return kTriangleKind;
    return std::holds_alternative<Sphere>(object.shape) ? kSphereKind : kEllipsoidKind;
}

Bounds3 box_of(const Primitives& primitives) {
    Bounds3 box;
    for (const Bounds3& b : primitives.item_boxes) box = box.extended(b);
    return box;
}

LocalFrame frame_of(const Primitives& primitives) {
    const Bounds3 box = box_of(primitives);
    if (box.empty()) return {};
    LocalFrame frame;
    frame.center = box.center();
    const double half = max_norm(box.max * 0.5 - box.min * 0.5);
    int exponent = 0;
    std::frexp(half, &exponent);  // half < 2^exponent
    // A box thinner than 2^-1023 stays thinner than 1.
    if (half > 0)
        frame.scale =
            std::ldexp(1.0, std::min(-exponent, std::numeric_limits<double>::max_exponent - 1));
    return frame;
}

// Below (above) the true number from which `nearest` was rounded: by one unit in the last place and
// more, at least by the smallest normal number. Local coordinates in double are off by a relative
// 2^-53 or an absolute 2^-1074, of which nothing matters here.
float below(float nearest) {
    return nearest - (std::fabs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
float above(float nearest) { return -below(-nearest); }

Bounds3T<float> widened(const Bounds3T<float>& box) {
    return {{below(box.min.x), below(box.min.y), below(box.min.z)},
            {above(box.max.x), above(box.max.y), above(box.max.z)}};
}

Bounds3T<float> local_box(const LocalFrame& frame, const Bounds3& box) {
    return widened({Vec3<float>(frame.local(box.min)), Vec3<float>(frame.local(box.max))});
}

// What the octree's construction needs, by slot.
struct LocalItems {
    BigVector<Bounds3T<float>> boxes;
    BigVector<LocalTriangle> triangles;
    BigVector<LocalSphere> spheres;
};

class LocalItemsMaker {
  public:
    explicit LocalItemsMaker(const FastScene& fast) : fast_(fast), frame_(fast.frame()) {
        items_.boxes.resize(fast.slot_end());
        items_.triangles.resize(fast.triangle_end());
        items_.spheres.resize(fast.sphere_end() - fast.triangle_end());
    }

    LocalItems make(int threads) && {
        constexpr Slot kChunk = 4096;
        const Slot end = fast_.triangle_end();
        for_each_index(threads, (end + kChunk - 1) / kChunk, [&](std::size_t i, int) {
            const Slot first = static_cast<Slot>(i) * kChunk;
            const Slot last = std::min(end, first + kChunk);
            put_triangles(first, last);
        });
        const std::vector<FastScene::Round>& rounds = fast_.rounds();
        for_each_index(threads, (rounds.size() + kChunk - 1) / kChunk, [&](std::size_t i, int) {
            const std::size_t last = std::min(rounds.size(), (i + 1) * kChunk);
            for (std::size_t k = i * kChunk; k < last; ++k) put_round(rounds[k]);
        });
        return std::move(items_);
    }

  private:
    void put_triangles(Slot slot, Slot last) {
        while (slot < last) {
            const std::uint32_t object = fast_.source(slot).object;
            const auto& mesh = std::get<TriangleMesh>(fast_.scene().objects[object].shape);
            for (; slot < last && fast_.source(slot).object == object; ++slot) {
                const IndexTriple& corners = mesh.triangles[fast_.source(slot).triangle];
                Bounds3T<float> box;
                for (std::size_t i = 0; i < 3; ++i) {
                    const Vec3<float> p(frame_.local(mesh.positions[corners[i]]));
                    items_.triangles[slot].corner[i] = p;
                    box = box.extended(p);
                }
                items_.boxes[slot] = widened(box);
            }
        }
    }

    void put_round(const FastScene::Round& round) {
        const auto& [id, slot] = round;
        items_.boxes[slot] = local_box(frame_, fast_.primitives().item_boxes[id]);
        if (slot >= fast_.sphere_end()) return;
        const Object& object = fast_.scene().objects[fast_.primitives().sources[id].object];
        const Sphere& sphere = std::get<Sphere>(object.shape);
        items_.spheres[slot - fast_.triangle_end()] = {
            Vec3<float>(frame_.local(sphere.center)),
            static_cast<float>(sphere.radius * frame_.scale)};
    }

    const FastScene& fast_;
    const LocalFrame& frame_;
    LocalItems items_;
};

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

}  // namespace

FastScene::FastScene(const Scene& scene, const Primitives& primitives, OctreeType type, int threads)
    : scene_(scene), primitives_(primitives), frame_(frame_of(primitives)) {
    order_slots();
    CompactBuildOptions options;
    options.rule = type == OctreeType::kUniform ? CutRule::kSpatial : CutRule::kSweep;
    options.threads = threads;
    octree_ = octree(options);
}

void FastScene::order_slots() {
    std::vector<PrimitiveId> of_kind[3];
    const auto end = static_cast<PrimitiveId>(primitives_.sources.size());
    for (PrimitiveId id = 0; id < end; ++id)
        of_kind[kind_of(scene_.objects[primitives_.sources[id].object])].push_back(id);
    triangle_end_ = static_cast<Slot>(of_kind[kTriangleKind].size());
    sphere_end_ = triangle_end_ + static_cast<Slot>(of_kind[kSphereKind].size());
    slot_end_ = end;
    if (slot_end_ != triangle_end_) {
        const Bounds3 box = box_of(primitives_);
        sort_in_space(primitives_, box, of_kind[kSphereKind]);
        sort_in_space(primitives_, box, of_kind[kEllipsoidKind]);
    }
    std::vector<Slot> slots(end);
    bool document_order = true;
    for (const std::vector<PrimitiveId>& ids : of_kind) {
        for (const PrimitiveId id : ids) {
            const auto slot = static_cast<Slot>(ids_.size());
            document_order &= id == slot;
            slots[id] = slot;
            ids_.push_back(id);
        }
    }
    rounds_.reserve(slot_end_ - triangle_end_);
    for (PrimitiveId id = 0; id < end; ++id)
        if (slots[id] >= triangle_end_) rounds_.push_back({id, slots[id]});
    if (document_order) ids_ = {};
}

CompactOctree FastScene::octree(CompactBuildOptions options) const {
    const LocalItems items = LocalItemsMaker(*this).make(options.threads);
    options.overlaps = octant_test(items);
    return build_compact_octree(items.boxes, options);
}

}  // namespace nuvo
