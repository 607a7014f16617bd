#include "methods.h"

namespace nuvo::study {

MidpointStrategy published(Evaluations*) { return published_midpoint; }

}  // namespace nuvo::study
