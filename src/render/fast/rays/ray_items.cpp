#include "fast/rays/ray_items.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nuvo {
namespace {

// A triangle is large against a voxel that it is so many times as wide as.
constexpr float kLarge = 2;
// Parts are taken whose boxes fill at most so much of the whole one's. A triangle in a plane across
// an axis, whose box has no volume, gains nothing from them.
constexpr float kFilled = 0.5F;

Bounds3T<float> rounded_outwards(const Bounds3& box) {
    Bounds3T<float> out;
    for (int axis = 0; axis < 3; ++axis) {
        out.min[axis] = float_below(box.min[axis]);
        out.max[axis] = -float_below(-box.max[axis]);
    }
    return out;
}

RayItem whole(const FastScene& scene, Slot slot) {
    const Bounds3& world = scene.primitives().item_boxes[scene.id(slot)];
    const Bounds3 local{scene.frame().local(world.min), scene.frame().local(world.max)};
    return {rounded_outwards(local), slot,
            slot < scene.triangle_end() ? static_cast<float>(max_norm(local.widths()))
                                        : kFloatInfinity};
}

using Polygon = std::array<Point3, 16>;

// Sutherland and Hodgman 1974: the part of the polygon on one side of a plane.
std::size_t cut_polygon(Polygon& polygon, std::size_t count, int axis, double plane, bool above) {
    Polygon out;
    std::size_t kept = 0;
    const auto inside = [&](const Point3& p) {
        return above ? p[axis] >= plane : p[axis] <= plane;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Point3& a = polygon[i];
        const Point3& b = polygon[(i + 1) % count];
        if (inside(a)) out[kept++] = a;
        if (inside(a) == inside(b)) continue;
        Point3 p = a + (b - a) * ((plane - a[axis]) / (b[axis] - a[axis]));
        p[axis] = plane;
        out[kept++] = p;
    }
    polygon = out;
    return kept;
}

// The box of what lies of the triangle in the voxel, from outside; may be empty.
Bounds3T<float> clipped_box(const Triangle& t, const Bounds3T<float>& voxel) {
    Polygon polygon{t.a, t.b, t.c};
    std::size_t count = 3;
    const Bounds3 all = t.bounds();
    for (int axis = 0; axis < 3 && count > 0; ++axis) {
        // Room for the corners' own rounding.
        const double low = voxel.min[axis] - 0x1p-40;
        const double high = voxel.max[axis] + 0x1p-40;
        if (all.min[axis] < low) count = cut_polygon(polygon, count, axis, low, true);
        if (all.max[axis] > high) count = cut_polygon(polygon, count, axis, high, false);
    }
    if (count == 0) return {};
    Bounds3 part;
    for (std::size_t i = 0; i < count; ++i) part = part.extended(polygon[i]);
    const Bounds3T<float> box = rounded_outwards(part);
    return {max(box.min, voxel.min), min(box.max, voxel.max)};
}

// Calls visit(slot, voxel) for each triangle that a leaf lists.
template <typename Visit>
void for_each_listed(const FastScene& scene, std::uint32_t place, const Bounds3T<float>& voxel,
                     const Visit& visit) {
    const CompactOctree& octree = scene.octree();
    const CompactNode& node = octree.nodes[place];
    if (node.is_leaf()) {
        for (std::uint32_t i = 0; i < node.item_count(); ++i) {
            const Slot slot = octree.items[node.first_item() + i];
            if (slot < scene.triangle_end()) visit(slot, voxel);
        }
        return;
    }
    node.for_each_child(voxel, [&](std::uint32_t child, const Bounds3T<float>& box) {
        for_each_listed(scene, child, box, visit);
    });
}

}  // namespace

// One rounding to float, and of the doubles what roundings of numbers up to 1 can add.
float float_below(double x) { return static_cast<float>(x - (std::fabs(x) * 0x1p-23 + 0x1p-50)); }

Triangle local_triangle(const FastScene& scene, Slot slot) {
    const Triangle t = scene.triangle(slot);
    const LocalFrame& frame = scene.frame();
    return {frame.local(t.a), frame.local(t.b), frame.local(t.c)};
}

std::vector<RayItem> ray_items(const FastScene& scene) {
    std::vector<RayItem> items;
    items.reserve(scene.slot_end());
    for (Slot slot = 0; slot < scene.slot_end(); ++slot) items.push_back(whole(scene, slot));
    if (scene.triangle_end() == 0) return items;
    const Bounds3T<float>& root = scene.octree().bounds;
    std::vector<char> is_cut(items.size(), 0);
    for_each_listed(scene, 0, root, [&](Slot slot, const Bounds3T<float>& voxel) {
        if (items[slot].width() > kLarge * max_norm(voxel.widths())) is_cut[slot] = 1;
    });
    if (std::find(is_cut.begin(), is_cut.end(), 1) == is_cut.end()) return items;
    std::vector<RayItem> parts;
    std::vector<float> volumes(items.size(), 0);
    for_each_listed(scene, 0, root, [&](Slot slot, const Bounds3T<float>& voxel) {
        if (is_cut[slot] == 0) return;
        const Bounds3T<float> box = clipped_box(local_triangle(scene, slot), voxel);
        if (box.empty()) return;
        parts.emplace_back(box, slot, items[slot].width());
        volumes[slot] += parts.back().box.volume();
    });
    for (const RayItem& item : items)
        if (!(volumes[item.slot()] > 0 && volumes[item.slot()] <= kFilled * item.box.volume()))
            is_cut[item.slot()] = 0;
    std::erase_if(items, [&](const RayItem& item) { return is_cut[item.slot()] != 0; });
    for (const RayItem& part : parts)
        if (is_cut[part.slot()] != 0) items.push_back(part);
    return items;
}

}  // namespace nuvo
