#include "methods.h"

namespace nuvo::study {

MidpointStrategy spatial(std::uint64_t*) { return spatial_midpoint; }

}  // namespace nuvo::study
