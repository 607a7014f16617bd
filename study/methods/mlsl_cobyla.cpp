#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy mlsl_cobyla(std::uint64_t* evaluations) {
    return nlopt_strategy(Search::kMlslCobyla, evaluations);
}

}  // namespace nuvo::study
