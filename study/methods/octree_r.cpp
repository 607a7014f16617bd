#include "methods.h"

namespace nuvo::study {

MidpointStrategy octree_r(Evaluations*) {
    return [](const SplitQuery& query) {
        return exact_midpoint(query, Weight::kArea, Space::kMedians);
    };
}

}  // namespace nuvo::study
