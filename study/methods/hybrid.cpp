#include "methods.h"
#include "methods/trial.h"

namespace nuvo::study {
namespace {

/// The sweep's cut must save so much more than the centre's: below that, the centre's halves, which
/// are alike, serve later cuts better.
constexpr double kPays = 1.05;

}  // namespace

MidpointStrategy hybrid(Evaluations*) {
    return [](const SplitQuery& query) -> std::optional<Point3> {
        Trial trial(query);
        const std::optional<Point3> center = spatial_midpoint(query);
        const std::optional<Point3> swept = sweep_midpoint(query);
        const auto by_center = trial.cut(query.voxel, trial.all(), *center);
        const auto by_sweep = trial.cut(query.voxel, trial.all(), *swept);
        if (!by_sweep) return center;
        if (!by_center) return swept;
        return by_sweep->saved > kPays * by_center->saved ? swept : center;
    };
}

}  // namespace nuvo::study
