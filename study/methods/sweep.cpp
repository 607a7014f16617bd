#include "methods.h"

namespace nuvo::study {

MidpointStrategy sweep(std::uint64_t*) { return sweep_midpoint; }

}  // namespace nuvo::study
