#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "nuvo/octree/cost.h"
#include "nuvo/octree/midpoint.h"
#include "objective.h"

/// Every way to choose a midpoint that the sources name, and those that look further.
namespace nuvo::study {

/// Of the objective by a search, in all voxels.
struct Evaluations {
    int most = 100;  ///< in one voxel
    std::uint64_t done = 0;
};

/// A way to cut. `make` gives the strategy; a search adds to `*evaluations`, which may be null.
struct Method {
    std::string_view name;
    std::string_view source;
    MidpointStrategy (*make)(Evaluations* evaluations);
    bool searches = false;  ///< by evaluations of eq. 19
    bool prunes = false;    ///< the finished tree is pruned bottom-up
};

/// All of them, spatial first.
std::span<const Method> methods();
/// Null where there is none of that name.
const Method* find_method(std::string_view name);

// One file each in methods/.
MidpointStrategy spatial(Evaluations*);
MidpointStrategy mean(Evaluations*);
MidpointStrategy median(Evaluations*);
MidpointStrategy published(Evaluations*);
MidpointStrategy mlsl_lds_sbplx(Evaluations*);
MidpointStrategy mlsl_random_sbplx(Evaluations*);
MidpointStrategy mlsl_cobyla(Evaluations*);
MidpointStrategy isres(Evaluations*);
MidpointStrategy auglag_cobyla(Evaluations*);
MidpointStrategy auglag_sbplx(Evaluations*);
MidpointStrategy octree_r(Evaluations*);
MidpointStrategy exact_eq19_medians(Evaluations*);
MidpointStrategy exact_eq19_voxel(Evaluations*);
MidpointStrategy sweep(Evaluations*);
MidpointStrategy eight_child(Evaluations*);
MidpointStrategy look_ahead(Evaluations*);
MidpointStrategy hybrid(Evaluations*);

}  // namespace nuvo::study
