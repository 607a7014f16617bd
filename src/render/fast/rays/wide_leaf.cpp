#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "fast/rays/ray_items.h"
#include "fast/rays/wide_bvh.h"

// Corners are copied in 16 bits on a grid that spans the leaf's triangles: half the memory of
// floats, and more accurate than those where a leaf is less than 1 / 256 of the scene.

namespace nuvo {
namespace {

struct Grid {
    Vec3<float> base{0, 0, 0};
    std::array<int, 3> exponent{};
};

Grid grid_over(const Bounds3& box) {
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        grid.base[axis] = float_below(box.min[axis]);
        const double width = box.max[axis] - static_cast<double>(grid.base[axis]);
        std::frexp(width / kLargestCorner, &grid.exponent[axis]);
    }
    const int widest = *std::max_element(grid.exponent.begin(), grid.exponent.end());
    const int flattest = std::max(std::min(widest, kFlattestExponent), kLeastExponent);
    for (int& exponent : grid.exponent) exponent = std::max(exponent, flattest);
    return grid;
}

WideLeafHead head_of(const Grid& grid) {
    WideLeafHead head{};
    for (int axis = 0; axis < 3; ++axis) {
        head.base[axis] = grid.base[axis];
        head.exponent[axis] = static_cast<std::int8_t>(grid.exponent[axis]);
    }
    head.finest_unit() = std::ldexp(1.0F, *std::min_element(head.exponent, head.exponent + 3));
    return head;
}

// Nine rows of corners' numbers, two in a word.
void put_corners(const Grid& grid, std::span<const Triangle> triangles, std::uint32_t* words) {
    std::array<std::uint16_t, 9 * kMostOfLeaf> numbers;
    std::size_t count = 0;
    for (const auto corner : {&Triangle::a, &Triangle::b, &Triangle::c})
        for (int axis = 0; axis < 3; ++axis)
            for (const Triangle& t : triangles)
                numbers[count++] = static_cast<std::uint16_t>(std::nearbyint(
                    std::ldexp((t.*corner)[axis] - static_cast<double>(grid.base[axis]),
                               -grid.exponent[axis])));
    std::memcpy(words, numbers.data(), count * sizeof(std::uint16_t));
}

// Four rows of centers and radii.
void put_spheres(const FastScene& scene, std::span<const Slot> slots, std::uint32_t* words) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const LocalSphere s = scene.local(std::get<Sphere>(scene.object(scene.id(slots[i])).shape));
        for (std::size_t axis = 0; axis < 3; ++axis)
            words[axis * slots.size() + i] =
                std::bit_cast<std::uint32_t>(s.center[static_cast<int>(axis)]);
        words[3 * slots.size() + i] = std::bit_cast<std::uint32_t>(s.radius);
    }
}

}  // namespace

std::uint32_t append_leaf(const FastScene& scene, std::span<const Slot> slots,
                          const Bounds3T<float>& box, BigVector<std::uint32_t>& words) {
    const auto number_below = [&](Slot end) {
        return static_cast<std::size_t>(std::lower_bound(slots.begin(), slots.end(), end) -
                                        slots.begin());
    };
    const std::size_t triangles = number_below(scene.triangle_end());
    const std::size_t spheres = number_below(scene.sphere_end()) - triangles;
    std::array<Triangle, kMostOfLeaf> corners;
    Bounds3 span{Point3(box.min), Point3(box.max)};
    for (std::size_t i = 0; i < triangles; ++i) {
        corners[i] = local_triangle(scene, slots[i]);
        span = span.extended(corners[i].bounds());
    }
    const Grid grid = grid_over(span);
    WideLeafHead head = head_of(grid);
    head.triangles = static_cast<std::uint8_t>(triangles);
    head.spheres = static_cast<std::uint8_t>(spheres);
    head.others = static_cast<std::uint8_t>(slots.size() - triangles - spheres);
    const std::size_t place = words.size();
    words.resize(place + kLeafHeadWords + slots.size() + 4 * spheres + (9 * triangles + 1) / 2, 0);
    std::uint32_t* at = words.data() + place;
    std::memcpy(at, &head, sizeof head);
    at += kLeafHeadWords;
    for (const Slot slot : slots) {
        const bool front_only = scene.front_only(scene.object(scene.id(slot)));
        *at++ = slot | (front_only ? kFrontOnly : 0);
    }
    put_spheres(scene, slots.subspan(triangles, spheres), at);
    put_corners(grid, std::span(corners).first(triangles), at + 4 * spheres);
    return static_cast<std::uint32_t>(place);
}

}  // namespace nuvo
