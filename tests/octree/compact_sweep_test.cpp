#include "compact_sweep.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace nuvo {
namespace {

using Box = Bounds3T<float>;

// The surface area heuristic of a plane, with areas and counts written out. [eq. 11]
double cost_of(const Box& voxel, const std::vector<Box>& boxes, int axis, double plane) {
    Bounds3 left{Point3(voxel.min), Point3(voxel.max)};
    Bounds3 right = left;
    left.max[axis] = plane;
    right.min[axis] = plane;
    double of_left = 0;
    double of_right = 0;
    for (const Box& box : boxes) {
        of_left += static_cast<double>(box.min[axis]) <= plane;
        of_right += static_cast<double>(box.max[axis]) >= plane;
    }
    return left.surface_area() * of_left + right.surface_area() * of_right;
}

// Between edges of items the cost is linear, so moving a bin's border to the edges beside it never
// makes it worse: the plane is no worse than any border, nor than none.
void expect_no_border_better(const Box& voxel, const std::vector<Box>& boxes, int bins) {
    std::vector<std::uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0U);
    const Vec3<float> planes = sweep_planes(voxel, items, boxes);
    for (int axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(voxel.min[axis]);
        const double width = static_cast<double>(voxel.max[axis]) - low;
        const Bounds3 whole{Point3(voxel.min), Point3(voxel.max)};
        const bool is_cut = planes[axis] < voxel.max[axis];
        const double found = is_cut ? cost_of(voxel, boxes, axis, static_cast<double>(planes[axis]))
                                    : whole.surface_area() * static_cast<double>(boxes.size());
        // Planes stand 2^-20 clear of edges.
        EXPECT_LE(found, whole.surface_area() * static_cast<double>(boxes.size()) * 1.0001);
        for (int i = 1; i < bins; ++i)
            EXPECT_LE(found, cost_of(voxel, boxes, axis, low + width * i / bins) * 1.0001)
                << "axis " << axis << ", border " << i << " of " << bins;
    }
}

TEST(CompactSweep, IsNoWorseThanAnyBordersOfItsBins) {
    for (const Box& voxel :
         {Box{{0, 0, 0}, {1, 1, 1}}, Box{{-1, 2, -0.5F}, {0, 2.25F, 3}},
          Box{{0.5F, -4, 1}, {4.5F, -3.5F, 1.125F}}, Box{{0, 0, 0}, {0.25F, 3, 1}}})
        for (const auto& [count, bins] :
             {std::pair{5, 8}, {40, 8}, {63, 8}, {64, 16}, {255, 16}, {256, 32}, {900, 32}})
            for (unsigned seed = 1; seed <= 4; ++seed) {
                SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(count) +
                             " items");
                std::mt19937_64 random(seed);
                std::uniform_real_distribution<float> place(0, 1);
                std::vector<Box> boxes;
                for (int i = 0; i < count; ++i) {
                    Box box;
                    for (int axis = 0; axis < 3; ++axis) {
                        const float width = voxel.max[axis] - voxel.min[axis];
                        // Denser below; some lie in several bins.
                        const float at = place(random) * place(random);
                        box.min[axis] = voxel.min[axis] + width * at;
                        box.max[axis] =
                            std::min(voxel.max[axis],
                                     box.min[axis] + width * place(random) * place(random) / 4);
                    }
                    boxes.push_back(box);
                }
                expect_no_border_better(voxel, boxes, bins);
            }
}

}  // namespace
}  // namespace nuvo
