#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy mlsl_lds_sbplx(Evaluations* evaluations) {
    return nlopt_strategy(Search::kMlslLdsSbplx, evaluations);
}

}  // namespace nuvo::study
