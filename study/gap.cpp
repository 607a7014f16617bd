#include "gap.h"

#include <algorithm>

namespace nuvo::study {
namespace {

/// Values this near are the same: a plane stands a few margins clear of the edge at which the
/// optimum is taken.
constexpr double kSame = 0x1p-26;

}  // namespace

std::vector<AskedVoxel> asked_voxels(const Scene& scene, const Primitives& primitives,
                                     const TreeOptions& options, std::size_t most) {
    std::vector<AskedVoxel> all;
    BuildOptions build;
    build.midpoint = [&](const SplitQuery& query) {
        if (query.boxes.size() >= 2)
            all.push_back({query.voxel, {query.boxes.begin(), query.boxes.end()}, query.margin});
        return spatial_midpoint(query);
    };
    build.worth = costs_of(primitives, options.step);
    build.overlaps = overlap_test(scene, primitives, options.leaves);
    build.margin = margin_of(primitives);
    build.max_references = 4 * primitives.item_count() + (1 << 20);
    build_octree(primitives.item_boxes, build);
    if (all.size() <= most) return all;
    std::vector<AskedVoxel> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(std::move(all[i * all.size() / most]));
    return some;
}

Gap gap_of(const Method& method, std::span<const AskedVoxel> voxels, Weight weight, Space space) {
    Gap gap;
    Evaluations evaluations;
    std::size_t asked = 0;
    const MidpointStrategy strategy = method.make(&evaluations);
    for (const AskedVoxel& asked_voxel : voxels) {
        const SplitQuery query{asked_voxel.voxel, asked_voxel.boxes, asked_voxel.margin};
        const std::optional<double> least = least_objective(query, weight, space);
        if (!least) continue;
        ++asked;
        const std::optional<Point3> planes = strategy(query);
        if (!planes) {
            ++gap.without;
            continue;
        }
        const double value = objective(query, *planes, weight);
        ++gap.voxels;
        if (value <= *least * (1 + kSame)) {
            ++gap.exact;
        } else if (*least == 0) {
            ++gap.unbounded;
        } else {
            const double excess = value / *least - 1;
            gap.mean += excess;
            gap.worst = std::max(gap.worst, excess);
        }
    }
    const std::size_t bounded = gap.voxels - gap.unbounded;
    if (bounded > 0) gap.mean /= static_cast<double>(bounded);
    if (asked > 0)
        gap.evaluations = static_cast<double>(evaluations.done) / static_cast<double>(asked);
    return gap;
}

}  // namespace nuvo::study
