#include "fast_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nuvo/octree/compact_build.h"
#include "octant_tests.h"

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

LocalFrame frame_of(const Primitives& primitives) {
    Bounds3 box;
    for (const Bounds3& b : primitives.item_boxes) box = box.extended(b);
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

// A float at most (least) the true number that `value` is rounded from by a relative 2^-53 or an
// absolute 2^-1074: one float unit and more away from the nearest, at least the smallest normal
// one.
float rounded_down(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest - (std::fabs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
float rounded_up(double value) { return -rounded_down(-value); }

Bounds3T<float> local_box(const LocalFrame& frame, const Bounds3& box) {
    const Point3 low = frame.local(box.min);
    const Point3 high = frame.local(box.max);
    return {{rounded_down(low.x), rounded_down(low.y), rounded_down(low.z)},
            {rounded_up(high.x), rounded_up(high.y), rounded_up(high.z)}};
}

// What the octree's construction needs, by slot.
struct LocalItems {
    std::vector<Bounds3T<float>> boxes;
    std::vector<LocalTriangle> triangles;
    std::vector<LocalSphere> spheres;
};

void put_point(const Point3& p, float (&out)[3]) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = static_cast<float>(p[axis]);
}

LocalItems local_items(const FastScene& fast) {
    LocalItems items;
    const LocalFrame& frame = fast.frame();
    items.boxes.resize(fast.slot_end());
    items.triangles.resize(fast.triangle_end());
    items.spheres.resize(fast.sphere_end() - fast.triangle_end());
    for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
        items.boxes[slot] = local_box(frame, fast.primitives().item_boxes[fast.id(slot)]);
        const PrimitiveSource& source = fast.source(slot);
        const Shape& shape = fast.scene().objects[source.object].shape;
        if (slot < fast.triangle_end()) {
            const Triangle t = std::get<TriangleMesh>(shape).triangle(source.triangle);
            LocalTriangle& local = items.triangles[slot];
            put_point(frame.local(t.a), local.corner[0]);
            put_point(frame.local(t.b), local.corner[1]);
            put_point(frame.local(t.c), local.corner[2]);
        } else if (slot < fast.sphere_end()) {
            const Sphere& s = std::get<Sphere>(shape);
            LocalSphere& local = items.spheres[slot - fast.triangle_end()];
            put_point(frame.local(s.center), local.center);
            local.radius = static_cast<float>(s.radius * frame.scale);
        }
    }
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

}  // namespace

FastScene::FastScene(const Scene& scene, const Primitives& primitives, OctreeType type, int threads)
    : scene_(scene), primitives_(primitives), frame_(frame_of(primitives)) {
    std::size_t counts[3] = {};
    bool sorted = true;
    Kind last = kTriangleKind;
    for (const PrimitiveSource& source : primitives.sources) {
        const Kind kind = kind_of(scene.objects[source.object]);
        sorted &= kind >= last;
        last = kind;
        ++counts[kind];
    }
    triangle_end_ = static_cast<Slot>(counts[0]);
    sphere_end_ = static_cast<Slot>(counts[0] + counts[1]);
    slot_end_ = static_cast<Slot>(counts[0] + counts[1] + counts[2]);
    if (!sorted) {
        Slot next[3] = {0, triangle_end_, sphere_end_};
        ids_.resize(slot_end_);
        for (PrimitiveId id = 0; id < slot_end_; ++id)
            ids_[next[kind_of(scene.objects[primitives.sources[id].object])]++] = id;
    }
    const LocalItems items = local_items(*this);
    CompactBuildOptions options;
    options.rule = type == OctreeType::kUniform ? CutRule::kSpatial : CutRule::kSweep;
    options.overlaps = octant_test(items);
    options.threads = threads;
    octree_ = build_compact_octree(items.boxes, options);
}

}  // namespace nuvo
