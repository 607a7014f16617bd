#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy isres(std::uint64_t* evaluations) {
    return nlopt_strategy(Search::kIsres, evaluations);
}

}  // namespace nuvo::study
