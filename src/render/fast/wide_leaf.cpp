#include "wide_leaf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

// Corners are copied in 16 bits on a grid that spans the leaf's triangles: half the memory of
// floats, and more accurate than those where a leaf is less than 1 / 256 of the scene.

namespace nuvo {
namespace {

// Triangles this many times as large as the leaf's smallest would make the grid too coarse for it;
// they are tested exactly.
constexpr double kLargestRatio = 16;

Triangle local_triangle(const FastScene& scene, Slot slot) {
    const PrimitiveSource& source = scene.source(slot);
    const auto& mesh = std::get<TriangleMesh>(scene.scene().objects[source.object].shape);
    const Triangle t = mesh.triangle(source.triangle);
    const LocalFrame& frame = scene.frame();
    return {frame.local(t.a), frame.local(t.b), frame.local(t.c)};
}

double extent(const Bounds3& box) { return max_norm(box.widths()); }

struct Grid {
    Vec3<float> base;
    double unit;
};

// A grid over the box. The base is rounded downwards by up to one float unit of 1.
Grid grid_over(const Bounds3& box) {
    Grid grid;
    double width = kLeastUnit;
    for (int axis = 0; axis < 3; ++axis) {
        grid.base[axis] = static_cast<float>(box.min[axis] - 0x1p-23);
        width = std::max(width, box.max[axis] - static_cast<double>(grid.base[axis]));
    }
    int exponent = 0;
    std::frexp(width / kLargestCorner, &exponent);
    grid.unit = std::max(std::ldexp(1.0, exponent), kLeastUnit);
    return grid;
}

void put_floats(std::span<const float> values, std::vector<std::uint32_t>& words) {
    for (const float value : values) words.push_back(std::bit_cast<std::uint32_t>(value));
}

void put_corners(const Grid& grid, std::span<const Triangle> triangles,
                 std::vector<std::uint32_t>& words) {
    std::vector<std::uint16_t> numbers;
    for (const auto corner : {&Triangle::a, &Triangle::b, &Triangle::c})
        for (int axis = 0; axis < 3; ++axis)
            for (const Triangle& t : triangles)
                numbers.push_back(static_cast<std::uint16_t>(std::nearbyint(
                    ((t.*corner)[axis] - static_cast<double>(grid.base[axis])) / grid.unit)));
    const std::size_t place = words.size();
    words.resize(place + (numbers.size() + 1) / 2);
    std::memcpy(words.data() + place, numbers.data(), numbers.size() * sizeof(std::uint16_t));
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

}  // namespace

std::uint32_t append_leaf(const FastScene& scene, std::span<const Slot> slots,
                          std::vector<std::uint32_t>& words) {
    std::vector<Slot> copied;
    std::vector<Slot> others;
    std::vector<Triangle> triangles;
    double smallest = INFINITY;
    for (const Slot slot : slots)
        if (slot < scene.triangle_end())
            smallest = std::min(smallest, extent(local_triangle(scene, slot).bounds()));
    Bounds3 box;
    for (const Slot slot : slots) {
        if (slot >= scene.triangle_end()) break;
        const Triangle t = local_triangle(scene, slot);
        if (extent(t.bounds()) > kLargestRatio * smallest) {
            others.push_back(slot);
            continue;
        }
        copied.push_back(slot);
        triangles.push_back(t);
        box = box.extended(t.bounds());
    }
    WideLeafHead head{};
    head.triangles = static_cast<std::uint32_t>(triangles.size());
    Grid grid{{0, 0, 0}, 1};
    if (!box.empty()) grid = grid_over(box);
    for (int axis = 0; axis < 3; ++axis) head.base[axis] = grid.base[axis];
    head.unit = static_cast<float>(grid.unit);
    std::array<std::vector<float>, 4> spheres;
    for (const Slot slot : slots) {
        if (slot < scene.triangle_end()) continue;
        if (slot >= scene.sphere_end()) {
            others.push_back(slot);
            continue;
        }
        const auto& s = std::get<Sphere>(scene.scene().objects[scene.source(slot).object].shape);
        const Point3 center = scene.frame().local(s.center);
        copied.push_back(slot);
        for (int axis = 0; axis < 3; ++axis)
            spheres[axis].push_back(static_cast<float>(center[axis]));
        spheres[3].push_back(static_cast<float>(s.radius * scene.frame().scale));
    }
    head.spheres = static_cast<std::uint32_t>(spheres[3].size());
    head.others = static_cast<std::uint32_t>(others.size());
    const std::size_t place = words.size();
    words.resize(place + kLeafHeadWords);
    std::memcpy(words.data() + place, &head, sizeof head);
    words.insert(words.end(), copied.begin(), copied.end());
    words.insert(words.end(), others.begin(), others.end());
    for (const auto& values : spheres) put_floats(values, words);
    put_corners(grid, triangles, words);
    return static_cast<std::uint32_t>(place);
}

Bounds3T<float> clipped_box(const FastScene& scene, Slot slot, const Bounds3T<float>& voxel) {
    Bounds3 box;
    if (slot < scene.triangle_end()) {
        const Triangle t = local_triangle(scene, slot);
        Polygon polygon{t.a, t.b, t.c};
        std::size_t count = 3;
        for (int axis = 0; axis < 3 && count > 0; ++axis) {
            // Room for the corners' own rounding.
            count = cut_polygon(polygon, count, axis, voxel.min[axis] - 0x1p-40, true);
            count = cut_polygon(polygon, count, axis, voxel.max[axis] + 0x1p-40, false);
        }
        for (std::size_t i = 0; i < count; ++i) box = box.extended(polygon[i]);
    } else {
        const Bounds3& world = scene.primitives().item_boxes[scene.id(slot)];
        box = {scene.frame().local(world.min), scene.frame().local(world.max)};
    }
    if (box.empty()) return {};
    Bounds3T<float> out;
    for (int axis = 0; axis < 3; ++axis) {
        // Rounded outwards: half a float unit of 1 to nearest, the rest for doubles' roundings.
        out.min[axis] = std::max(static_cast<float>(box.min[axis] - 0x1p-23), voxel.min[axis]);
        out.max[axis] = std::min(static_cast<float>(box.max[axis] + 0x1p-23), voxel.max[axis]);
    }
    return out;
}

}  // namespace nuvo
