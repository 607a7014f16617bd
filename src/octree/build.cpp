#include "nuvo/octree/build.h"

#include "best_first.h"
#include "nuvo/math/big_vector.h"
#include "published.h"

namespace nuvo {

Octree build_octree(std::span<const Bounds3> boxes, const BuildOptions& options) {
    if (const auto* costs = std::get_if<ThesisCosts>(&options.worth))
        return PublishedBuilder(boxes, options, *costs).build();
    Octree octree = BestFirstBuilder(boxes, options).build();
    trim_heap();
    return octree;
}

SahTotals sah_totals(const Octree& octree) {
    SahTotals totals;
    for (const Node& node : octree.nodes()) {
        const double area = node.voxel.bounds.surface_area();
        const Vector3 w = node.voxel.bounds.widths();
        if (node.is_leaf()) {
            ++totals.leaves;
            // The far half of an axis that was not cut is never entered.
            if (node.item_count == 0 && (w.x == 0 || w.y == 0 || w.z == 0)) continue;
            totals.leaf_area += area;
            totals.leaf_area_objects += area * node.item_count;
        } else {
            totals.interior_area += area;
        }
    }
    return totals;
}

}  // namespace nuvo
