#include <algorithm>
#include <nlopt.hpp>
#include <stdexcept>

#include "nuvo/octree/midpoint.h"

namespace nuvo {

// The published program's numbers; its lengths are scene units. [docs/thesis-map.md, section 7]
namespace published {
namespace {

constexpr float kNearestToFace = 0.1F;    // of either end of the search box
constexpr float kThinnestSearch = 0.05F;  // a box no wider is not searched
constexpr float kSmallestHalfWidth = 1;   // of a voxel that is cut without a search
constexpr std::size_t kMostEvaluations = 100;
constexpr std::size_t kEvaluationsBesideObjects = 8;
constexpr int kLocalEvaluations = 15;

using Float3 = Vec3<float>;

float least(const Float3& v) { return std::min({v.x, v.y, v.z}); }

// Added up in the order of the items, and rounded at each step.
Float3 mean_center(std::span<const Bounds3> boxes) {
    Float3 sum;
    for (const Bounds3& box : boxes) sum += Float3(box.center());
    return sum / static_cast<float>(boxes.size());
}

double sum_of(const std::vector<double>& x, std::vector<double>&, void* data) {
    return static_cast<const MidpointScore*>(data)->sum({x[0], x[1], x[2]});
}

std::optional<Point3> searched(const SplitQuery& query, const Float3& lower, const Float3& upper) {
    MidpointScore score(query);
    nlopt::opt local(nlopt::LN_SBPLX, 3);
    local.set_maxeval(kLocalEvaluations);
    nlopt::opt search(nlopt::G_MLSL_LDS, 3);
    search.set_local_optimizer(local);
    search.set_min_objective(sum_of, &score);
    search.set_lower_bounds({lower.x, lower.y, lower.z});
    search.set_upper_bounds({upper.x, upper.y, upper.z});
    search.set_maxeval(static_cast<int>(
        std::min(query.boxes.size() + kEvaluationsBesideObjects, kMostEvaluations)));
    std::vector<double> best{lower.x, lower.y, lower.z};
    double best_score = 0;
    try {
        search.optimize(best, best_score);
    } catch (const nlopt::roundoff_limited&) {  // what was found so far is good enough
    } catch (const std::exception&) {
        return std::nullopt;
    }
    return Point3{best[0], best[1], best[2]};
}

}  // namespace
}  // namespace published

std::optional<Point3> published_midpoint(const SplitQuery& query) {
    using namespace published;
    if (query.boxes.empty()) return std::nullopt;
    const Float3 low_face(query.voxel.bounds.min);
    const Float3 high_face(query.voxel.bounds.max);
    const Float3 midpoint(query.voxel.midpoint);
    const Float3 mean = mean_center(query.boxes);
    Float3 lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
        const float inside = std::clamp(mean[axis], low_face[axis], high_face[axis]);
        lower[axis] = std::min(inside, midpoint[axis]);
        upper[axis] = std::max(inside, midpoint[axis]);
    }
    if (!(least(high_face - upper) >= kNearestToFace && least(lower - low_face) >= kNearestToFace))
        return std::nullopt;
    if (least(upper - lower) > kThinnestSearch) return searched(query, lower, upper);
    if (least(high_face - midpoint) > kSmallestHalfWidth &&
        least(midpoint - low_face) > kSmallestHalfWidth)
        return Point3(upper);
    return std::nullopt;
}

}  // namespace nuvo
