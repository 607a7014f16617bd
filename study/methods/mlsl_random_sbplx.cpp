#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy mlsl_random_sbplx(Evaluations* evaluations) {
    return nlopt_strategy(Search::kMlslSbplx, evaluations);
}

}  // namespace nuvo::study
