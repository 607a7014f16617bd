#include "methods.h"
#include "methods/nlopt_search.h"

namespace nuvo::study {

MidpointStrategy isres(Evaluations* evaluations) {
    return nlopt_strategy(Search::kIsres, evaluations);
}

}  // namespace nuvo::study
