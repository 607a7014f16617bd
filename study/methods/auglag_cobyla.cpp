#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy auglag_cobyla(std::uint64_t* evaluations) {
    return nlopt_strategy(Search::kAuglagCobyla, evaluations);
}

}  // namespace nuvo::study
