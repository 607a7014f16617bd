#include "methods.h"

namespace nuvo::study {

MidpointStrategy exact_eq19_medians(Evaluations*) {
    return [](const SplitQuery& query) {
        return exact_midpoint(query, Weight::kShare, Space::kMedians);
    };
}

}  // namespace nuvo::study
