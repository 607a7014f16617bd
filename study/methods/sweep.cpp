#include "methods.h"

namespace nuvo::study {

MidpointStrategy sweep(Evaluations*) { return sweep_midpoint; }

}  // namespace nuvo::study
