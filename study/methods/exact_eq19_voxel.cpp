#include "methods.h"

namespace nuvo::study {

MidpointStrategy exact_eq19_voxel(Evaluations*) {
    return [](const SplitQuery& query) {
        return exact_midpoint(query, Weight::kShare, Space::kVoxel);
    };
}

}  // namespace nuvo::study
