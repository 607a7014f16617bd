#include "methods.h"
#include "methods/trial.h"

// Of a few cuts the one after which the octants, each cut in its turn as well as one of them can,
// cost least: it sees that a cut which gains nothing now may make gains possible.

namespace nuvo::study {
namespace {

/// A voxel of more items is cut by one level's gain: two levels would take longer than they save.
constexpr std::size_t kMostItems = 100'000;

double best_saving(Trial& trial, const Voxel& voxel, std::span<const ItemId> items, double margin) {
    const std::vector<Bounds3> boxes = trial.boxes(items);
    const SplitQuery query{voxel, boxes, margin};
    double best = 0;
    for (const auto& planes : {spatial_midpoint(query), sweep_midpoint(query)})
        if (planes)
            if (const auto cut = trial.cut(voxel, items, *planes))
                best = std::max(best, cut->saved);
    return best;
}

}  // namespace

MidpointStrategy look_ahead(Evaluations*) {
    return [](const SplitQuery& query) -> std::optional<Point3> {
        std::optional<Point3> best = spatial_midpoint(query);
        if (query.boxes.size() > kMostItems) return sweep_midpoint(query);
        Trial trial(query);
        double most = 0;
        const MidpointStrategy candidates[] = {
            spatial_midpoint, sweep_midpoint, shrinking(spatial_midpoint),
            [](const SplitQuery& q) { return exact_midpoint(q, Weight::kArea, Space::kMedians); }};
        for (const MidpointStrategy& candidate : candidates) {
            const std::optional<Point3> planes = candidate(query);
            if (!planes) continue;
            const std::optional<PayingCut> cut = trial.cut(query.voxel, trial.all(), *planes);
            if (!cut) continue;
            double saved = cut->saved;
            for (unsigned o = 0; o < 8; ++o) {
                if (cut->counts[o] == 0) continue;
                const Voxel octant =
                    Voxel::centered(cut->voxel.octant(octant_digit(static_cast<int>(o))));
                saved += best_saving(trial, octant, cut->items(trial.all(), o), query.margin);
            }
            if (!(saved > most)) continue;
            most = saved;
            best = planes;
        }
        return best;
    };
}

}  // namespace nuvo::study
