#include "methods.h"

#include <algorithm>
#include <array>

namespace nuvo::study {
namespace {

constexpr std::array kMethods{
    Method{"spatial", "the uniform octree", spatial},
    Method{"mean", "mean of the boxes' centres", mean},
    Method{"median", "median of the boxes' centres", median},
    Method{"published", "the thesis' program: MLSL (LDS) + Sbplx, eq. 16, mean", published, true},
    Method{"mlsl-lds-sbplx", "thesis 3.2.3, 5.4.2: eq. 19", mlsl_lds_sbplx, true},
    Method{"mlsl-random-sbplx", "thesis 3.2.3, with random starts", mlsl_random_sbplx, true},
    Method{"mlsl-cobyla", "thesis 3.2.3", mlsl_cobyla, true},
    Method{"isres", "thesis 3.2.3", isres, true},
    Method{"auglag-cobyla", "thesis 3.2.3", auglag_cobyla, true},
    Method{"auglag-sbplx", "thesis 3.2.3", auglag_sbplx, true},
    Method{"octree-r", "Whang et al. 1995: true areas between the medians", octree_r},
    Method{"eq19-medians", "exact minimum of eq. 16 and 19 between the medians",
           exact_eq19_medians},
    Method{"eq19-voxel", "exact minimum of eq. 16 and 19 over the voxel", exact_eq19_voxel},
    Method{"sweep", "true areas over the voxel (the program's)", sweep},
    Method{"eight-child", "SAH of the eight octants, by coordinate descent", eight_child},
    Method{"look-ahead", "two levels ahead, of four candidates", look_ahead},
    Method{"hybrid", "thesis 6.1.2: away from the centre only where it pays", hybrid},
    Method{"pruned", "sweep, cut further than pays and pruned bottom-up", sweep, false, true},
};

}  // namespace

std::span<const Method> methods() { return kMethods; }

const Method* find_method(std::string_view name) {
    const auto found = std::ranges::find(kMethods, name, &Method::name);
    return found == kMethods.end() ? nullptr : &*found;
}

}  // namespace nuvo::study
