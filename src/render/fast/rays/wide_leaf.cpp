#include "fast/rays/wide_leaf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

// Corners are copied in 16 bits on a grid that spans the leaf's triangles: half the memory of
// floats, and more accurate than those where a leaf is less than 1 / 256 of the scene.

namespace nuvo {
namespace {

// Triangles this many times as large as a grid's smallest would make it too coarse for that one.
constexpr double kLargestRatio = 16;

// One rounding to float, and of the doubles what roundings of numbers up to 1 can add.
float below(double x) { return static_cast<float>(x - (std::fabs(x) * 0x1p-23 + 0x1p-50)); }
float above(double x) { return -below(-x); }

Bounds3T<float> rounded_outwards(const Bounds3& box) {
    Bounds3T<float> out;
    for (int axis = 0; axis < 3; ++axis) {
        out.min[axis] = below(box.min[axis]);
        out.max[axis] = above(box.max[axis]);
    }
    return out;
}

Triangle local_triangle(const FastScene& scene, Slot slot) {
    const Triangle t = scene.triangle(slot);
    const LocalFrame& frame = scene.frame();
    return {frame.local(t.a), frame.local(t.b), frame.local(t.c)};
}

struct Grid {
    Vec3<float> base{0, 0, 0};
    std::array<int, 3> exponent{};
};

Grid grid_over(const Bounds3& box) {
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        grid.base[axis] = below(box.min[axis]);
        const double width = box.max[axis] - static_cast<double>(grid.base[axis]);
        std::frexp(width / kLargestCorner, &grid.exponent[axis]);
    }
    const int widest = *std::max_element(grid.exponent.begin(), grid.exponent.end());
    const int flattest = std::max(std::min(widest, kFlattestExponent), kLeastExponent);
    for (int& exponent : grid.exponent) exponent = std::max(exponent, flattest);
    return grid;
}

void put_corners(const Grid& grid, std::span<const Triangle> triangles,
                 BigVector<std::uint32_t>& words) {
    if (triangles.empty()) return;
    std::vector<std::uint16_t> numbers;
    for (const auto corner : {&Triangle::a, &Triangle::b, &Triangle::c})
        for (int axis = 0; axis < 3; ++axis)
            for (const Triangle& t : triangles)
                numbers.push_back(static_cast<std::uint16_t>(std::nearbyint(
                    std::ldexp((t.*corner)[axis] - static_cast<double>(grid.base[axis]),
                               -grid.exponent[axis]))));
    if (numbers.size() % 2 != 0) numbers.push_back(0);
    const std::size_t place = words.size();
    words.resize(place + numbers.size() / 2);
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

// Primitives of one head by what becomes of them.
struct Sorted {
    std::vector<Slot> triangles;
    std::vector<Triangle> corners;
    std::vector<Slot> spheres;
    std::array<std::vector<float>, 4> centers_and_radii;
    std::vector<Slot> others;
};

struct SizedTriangle {
    double extent;
    Slot slot;
    Triangle corners;
};

// Into as many heads as their sizes ask for.
void sort_triangles(const FastScene& scene, std::span<const Slot> slots, std::vector<Sorted>& out) {
    std::vector<SizedTriangle> triangles;
    for (const Slot slot : slots) {
        const Triangle t = local_triangle(scene, slot);
        triangles.push_back({max_norm(t.bounds().widths()), slot, t});
    }
    std::sort(triangles.begin(), triangles.end(),
              [](const auto& a, const auto& b) { return a.extent < b.extent; });
    double smallest = triangles.empty() ? 0 : triangles.front().extent;
    for (const SizedTriangle& t : triangles) {
        if (t.extent > kLargestRatio * smallest) {
            smallest = t.extent;
            out.emplace_back();
        }
        out.back().triangles.push_back(t.slot);
        out.back().corners.push_back(t.corners);
    }
}

void sort_others(const FastScene& scene, std::span<const Slot> slots, Sorted& out) {
    for (const Slot slot : slots) {
        if (slot >= scene.sphere_end()) {
            out.others.push_back(slot);
            continue;
        }
        const LocalSphere s = scene.local(std::get<Sphere>(scene.object(scene.id(slot)).shape));
        out.spheres.push_back(slot);
        for (int axis = 0; axis < 3; ++axis) out.centers_and_radii[axis].push_back(s.center[axis]);
        out.centers_and_radii[3].push_back(s.radius);
    }
}

// `slots` ascend. More than a byte can count are all tested exactly: there is no telling them
// apart, or the octree would have.
std::vector<Sorted> sort_by_kind(const FastScene& scene, std::span<const Slot> slots) {
    std::vector<Sorted> out(1);
    if (slots.size() >= WideLeafHead::kMany) {
        out[0].others.assign(slots.begin(), slots.end());
        return out;
    }
    const auto spheres = std::lower_bound(slots.begin(), slots.end(), scene.triangle_end());
    const auto count = static_cast<std::size_t>(spheres - slots.begin());
    sort_others(scene, slots.subspan(count), out[0]);
    sort_triangles(scene, slots.first(count), out);
    return out;
}

WideLeafHead head_of(const Sorted& sorted, const Grid& grid, bool more) {
    WideLeafHead head{};
    for (int axis = 0; axis < 3; ++axis) {
        head.base[axis] = grid.base[axis];
        head.exponent[axis] = static_cast<std::int8_t>(grid.exponent[axis]);
    }
    head.finest_unit() = std::ldexp(1.0F, *std::min_element(head.exponent, head.exponent + 3));
    head.triangles = static_cast<std::uint8_t>(sorted.triangles.size());
    head.spheres = static_cast<std::uint8_t>(sorted.spheres.size());
    head.others =
        static_cast<std::uint8_t>(std::min<std::size_t>(sorted.others.size(), WideLeafHead::kMany));
    head.more = more;
    return head;
}

void put_part(const FastScene& scene, const Sorted& sorted, const Bounds3T<float>& box, bool more,
              BigVector<std::uint32_t>& words) {
    Bounds3 span{Point3(box.min), Point3(box.max)};
    for (const Triangle& t : sorted.corners) span = span.extended(t.bounds());
    const Grid grid = span.empty() ? Grid{} : grid_over(span);
    const WideLeafHead head = head_of(sorted, grid, more);
    const std::size_t place = words.size();
    words.resize(place + kLeafHeadWords);
    std::memcpy(words.data() + place, &head, sizeof head);
    if (head.others == WideLeafHead::kMany)
        words.push_back(static_cast<std::uint32_t>(sorted.others.size()));
    for (const auto* part : {&sorted.triangles, &sorted.spheres, &sorted.others})
        for (const Slot slot : *part) {
            const bool front_only = scene.front_only(scene.object(scene.id(slot)));
            words.push_back(slot | (front_only ? kFrontOnly : 0));
        }
    for (const std::vector<float>& values : sorted.centers_and_radii)
        for (const float value : values) words.push_back(std::bit_cast<std::uint32_t>(value));
    put_corners(grid, sorted.corners, words);
}

}  // namespace

std::uint32_t append_leaf(const FastScene& scene, std::span<const Slot> slots,
                          const Bounds3T<float>& box, BigVector<std::uint32_t>& words) {
    const std::vector<Sorted> parts = sort_by_kind(scene, slots);
    const std::size_t place = words.size();
    for (const Sorted& part : parts) put_part(scene, part, box, &part != &parts.back(), words);
    return static_cast<std::uint32_t>(place);
}

Bounds3T<float> whole_box(const FastScene& scene, Slot slot) {
    const Bounds3& world = scene.primitives().item_boxes[scene.id(slot)];
    return rounded_outwards({scene.frame().local(world.min), scene.frame().local(world.max)});
}

Bounds3T<float> clipped_box(const FastScene& scene, Slot slot, const Bounds3T<float>& voxel) {
    Bounds3T<float> box;
    if (slot < scene.triangle_end()) {
        const Triangle t = local_triangle(scene, slot);
        Polygon polygon{t.a, t.b, t.c};
        std::size_t count = 3;
        const Bounds3 whole = t.bounds();
        for (int axis = 0; axis < 3 && count > 0; ++axis) {
            // Room for the corners' own rounding.
            const double low = voxel.min[axis] - 0x1p-40;
            const double high = voxel.max[axis] + 0x1p-40;
            if (whole.min[axis] < low) count = cut_polygon(polygon, count, axis, low, true);
            if (whole.max[axis] > high) count = cut_polygon(polygon, count, axis, high, false);
        }
        if (count == 0) return {};
        Bounds3 part;
        for (std::size_t i = 0; i < count; ++i) part = part.extended(polygon[i]);
        box = rounded_outwards(part);
    } else {
        box = whole_box(scene, slot);
    }
    return {max(box.min, voxel.min), min(box.max, voxel.max)};
}

}  // namespace nuvo
