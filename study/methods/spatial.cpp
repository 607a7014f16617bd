#include "methods.h"

namespace nuvo::study {

MidpointStrategy spatial(Evaluations*) { return spatial_midpoint; }

}  // namespace nuvo::study
