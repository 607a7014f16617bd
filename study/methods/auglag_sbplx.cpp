#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy auglag_sbplx(Evaluations* evaluations) {
    return nlopt_strategy(Search::kAuglagSbplx, evaluations);
}

}  // namespace nuvo::study
