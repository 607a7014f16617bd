#include <algorithm>
#include <nlopt.hpp>

#include "nuvo/octree/midpoint.h"

namespace nuvo {
namespace {

constexpr int kMaxEvaluations = 100;
constexpr std::size_t kEvaluationsPerObject = 3;

double score_of(const std::vector<double>& x, std::vector<double>&, void* data) {
    return (*static_cast<const MidpointScore*>(data))({x[0], x[1], x[2]});
}

}  // namespace

std::optional<Point3> mlsl_sbplx_midpoint(const SplitQuery& query) {
    if (query.boxes.empty()) return std::nullopt;
    const Bounds3& box = query.voxel.bounds;
    const Point3 center = box.center();
    std::vector<double> lower(3);
    std::vector<double> upper(3);
    for (int axis = 0; axis < 3; ++axis) {
        const double median = object_median(query.boxes, axis);
        // A median on or beyond a face is the thesis' null pointer: the voxel is not cut.
        for (const double m : {center[axis], median})
            if (!(box.min[axis] < m && m < box.max[axis])) return std::nullopt;
        lower[axis] = std::min(center[axis], median);
        upper[axis] = std::max(center[axis], median);
    }
    std::vector<double> best{center.x, center.y, center.z};
    if (lower == upper) return center;

    MidpointScore score(query);
    nlopt::opt search(nlopt::G_MLSL_LDS, 3);
    search.set_local_optimizer(nlopt::opt(nlopt::LN_SBPLX, 3));
    search.set_min_objective(score_of, &score);
    search.set_lower_bounds(lower);
    search.set_upper_bounds(upper);
    search.set_maxeval(static_cast<int>(
        std::min<std::size_t>(kMaxEvaluations, kEvaluationsPerObject * query.boxes.size())));
    double best_score = 0;
    search.optimize(best, best_score);
    return Point3{best[0], best[1], best[2]};
}

}  // namespace nuvo
