#include "nlopt_search.h"

#include <algorithm>
#include <nlopt.hpp>
#include <stdexcept>

#include "objective.h"

namespace nuvo::study {
namespace {

constexpr std::size_t kEvaluationsPerObject = 3;
constexpr unsigned long kSeed = 1;

struct Counted {
    const MidpointScore& score;
    std::uint64_t calls = 0;
};

double score_of(const std::vector<double>& x, std::vector<double>&, void* data) {
    auto& counted = *static_cast<Counted*>(data);
    ++counted.calls;
    return counted.score.product({x[0], x[1], x[2]});
}

nlopt::opt global_search(Search search) {
    switch (search) {
        case Search::kMlslLdsSbplx:
        case Search::kMlslCobyla:
            return nlopt::opt(nlopt::G_MLSL_LDS, 3);
        case Search::kMlslSbplx:
            return nlopt::opt(nlopt::G_MLSL, 3);
        case Search::kIsres:
            return nlopt::opt(nlopt::GN_ISRES, 3);
        case Search::kAuglagCobyla:
        case Search::kAuglagSbplx:
            break;
    }
    return nlopt::opt(nlopt::AUGLAG, 3);
}

bool is_local_cobyla(Search search) {
    return search == Search::kMlslCobyla || search == Search::kAuglagCobyla;
}

}  // namespace

std::optional<Point3> nlopt_midpoint(const SplitQuery& query, Search search,
                                     Evaluations* evaluations) {
    std::vector<double> lower(3), upper(3);
    const Point3 center = query.voxel.bounds.center();
    for (int axis = 0; axis < 3; ++axis) {
        const Interval interval = interval_of(query, axis, Space::kMedians);
        if (interval.empty()) return std::nullopt;
        lower[axis] = interval.low;
        upper[axis] = interval.high;
    }
    if (lower == upper) return center;
    const MidpointScore score(query);
    Counted counted{score};
    nlopt::srand(kSeed);
    nlopt::opt opt = global_search(search);
    const auto budget = static_cast<int>(
        std::min(static_cast<std::size_t>(evaluations ? evaluations->most : Evaluations{}.most),
                 kEvaluationsPerObject * query.boxes.size()));
    if (search != Search::kIsres)
        opt.set_local_optimizer(
            nlopt::opt(is_local_cobyla(search) ? nlopt::LN_COBYLA : nlopt::LN_SBPLX, 3));
    opt.set_min_objective(score_of, &counted);
    opt.set_lower_bounds(lower);
    opt.set_upper_bounds(upper);
    opt.set_maxeval(budget);
    std::vector<double> best{center.x, center.y, center.z};
    double least = 0;
    try {
        opt.optimize(best, least);
    } catch (const std::runtime_error&) {  // the bounds are too near to each other for its steps
    } catch (const std::invalid_argument&) {
    }
    if (evaluations) evaluations->done += counted.calls;
    return Point3{best[0], best[1], best[2]};
}

MidpointStrategy nlopt_strategy(Search search, Evaluations* evaluations) {
    return [=](const SplitQuery& query) { return nlopt_midpoint(query, search, evaluations); };
}

}  // namespace nuvo::study
