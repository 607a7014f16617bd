#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy auglag_cobyla(Evaluations* evaluations) {
    return nlopt_strategy(Search::kAuglagCobyla, evaluations);
}

}  // namespace nuvo::study
