#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "nuvo/octree/cost.h"
#include "nuvo/octree/midpoint.h"
#include "objective.h"

/// Every way to choose a midpoint that the sources name, and those that look further.
namespace nuvo::study {

/// A way to cut. `make` gives the strategy; a search adds its evaluations to `*evaluations`.
struct Method {
    std::string_view name;
    std::string_view source;
    MidpointStrategy (*make)(std::uint64_t* evaluations);
    bool searches = false;  ///< by evaluations of eq. 19
    bool prunes = false;    ///< the finished tree is pruned bottom-up
};

/// All of them, spatial first.
std::span<const Method> methods();
/// Null where there is none of that name.
const Method* find_method(std::string_view name);

// One file each in methods/.
MidpointStrategy spatial(std::uint64_t*);
MidpointStrategy mean(std::uint64_t*);
MidpointStrategy median(std::uint64_t*);
MidpointStrategy published(std::uint64_t*);
MidpointStrategy mlsl_lds_sbplx(std::uint64_t*);
MidpointStrategy mlsl_random_sbplx(std::uint64_t*);
MidpointStrategy mlsl_cobyla(std::uint64_t*);
MidpointStrategy isres(std::uint64_t*);
MidpointStrategy auglag_cobyla(std::uint64_t*);
MidpointStrategy auglag_sbplx(std::uint64_t*);
MidpointStrategy octree_r(std::uint64_t*);
MidpointStrategy exact_eq19_medians(std::uint64_t*);
MidpointStrategy exact_eq19_voxel(std::uint64_t*);
MidpointStrategy sweep(std::uint64_t*);
MidpointStrategy eight_child(std::uint64_t*);
MidpointStrategy look_ahead(std::uint64_t*);
MidpointStrategy hybrid(std::uint64_t*);

}  // namespace nuvo::study
