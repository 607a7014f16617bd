#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy mlsl_cobyla(Evaluations* evaluations) {
    return nlopt_strategy(Search::kMlslCobyla, evaluations);
}

}  // namespace nuvo::study
