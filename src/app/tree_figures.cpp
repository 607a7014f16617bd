#include <bit>
#include <limits>
#include <utility>

#include "nuvo/app/report.h"
#include "nuvo/octree/build.h"

namespace nuvo::app {
namespace {

// Relative to the other box; an axis on which that has no width does not count. In factors, for
// volumes leave the range of double first.
double volume_share(const Bounds3& box, const Bounds3& of) {
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double whole = of.widths()[axis];
        if (whole > 0) share *= box.widths()[axis] / whole;
    }
    return share;
}

LeafHistogram histogram(const Octree& octree) {
    LeafHistogram all;
    for (const Node& node : octree.nodes())
        if (node.is_leaf())
            all.add(static_cast<std::size_t>(label_digits(node.label)),
                    volume_share(node.voxel.bounds, octree.root().voxel.bounds), node.item_count);
    return all;
}

LeafHistogram histogram(const CompactOctree& octree) {
    struct Open {
        std::uint32_t node;
        std::size_t level;
        Bounds3T<float> box;
    };
    LeafHistogram all;
    std::vector<Open> open;
    const Bounds3 root{Point3(octree.bounds.min), Point3(octree.bounds.max)};
    if (!octree.nodes.empty()) open.push_back({0, 0, octree.bounds});
    while (!open.empty()) {
        const auto [index, level, box] = open.back();
        open.pop_back();
        const CompactNode& node = octree.nodes[index];
        if (node.is_leaf()) {
            if (node.item_count() > 0)
                all.add(level, volume_share({Point3(box.min), Point3(box.max)}, root),
                        node.item_count());
            continue;
        }
        node.for_each_child(
            box, [&, deeper = level + 1](std::uint32_t child, const Bounds3T<float>& its_box) {
                open.push_back({child, deeper, its_box});
            });
    }
    return all;
}

}  // namespace

void LeafHistogram::add(std::size_t level, double volume_share, std::size_t item_count) {
    if (levels.size() <= level) levels.resize(level + 1);
    ++levels[level].leaves;
    levels[level].volume_share += volume_share;
    const auto power = static_cast<std::size_t>(std::bit_width(item_count));
    if (items.size() <= power) items.resize(power + 1);
    ++items[power];
}

TreeFigures figures(const Octree& octree) {
    return {octree.depth_tried().value_or(octree.depth()),
            octree.leaf_count(),
            octree.nodes().size(),
            octree.reference_count(),
            octree.memory_bytes(),
            octree.smallest_width(),
            octree.out_of_budget(),
            histogram(octree),
            octree.nodes().size() * sizeof(Node),
            octree.reference_count() * sizeof(ItemId)};
}

FinalSah final_sah(const Octree& octree, const SahCosts& prices) {
    const double area = octree.root().voxel.bounds.surface_area();
    return {
        area > 0 ? sah(sah_totals(octree), area, prices) : std::numeric_limits<double>::quiet_NaN(),
        prices};
}

TileFigures figures(const FastTracer& tracer, const FastOptions& options) {
    const CompactOctree& octree = tracer.octree();
    TileFigures tiles;
    tiles.threads = options.threads;
    tiles.isa = options.isa;
    tiles.depth = octree.depth();
    tiles.voxels = octree.leaf_count();
    tiles.nodes = octree.nodes.size();
    tiles.references = octree.items.size();
    tiles.memory = tracer.memory();
    tiles.leaves = histogram(octree);
    return tiles;
}

}  // namespace nuvo::app
