#include "nuvo/octree/build.h"

#include "depth_first.h"

namespace nuvo {

Octree build_octree(std::span<const Bounds3> boxes, const BuildOptions& options) {
    return DepthFirstBuilder(boxes, options).build();
}

SahTotals sah_totals(const Octree& octree) {
    SahTotals totals;
    for (const Node& node : octree.nodes()) {
        const double area = node.voxel.bounds.surface_area();
        if (node.is_leaf()) {
            totals.leaf_area += area;
            totals.leaf_area_objects += area * node.item_count;
            ++totals.leaves;
        } else {
            totals.interior_area += area;
        }
    }
    return totals;
}

}  // namespace nuvo
