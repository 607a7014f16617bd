#include "methods.h"

namespace nuvo::study {

MidpointStrategy published(std::uint64_t*) { return published_midpoint; }

}  // namespace nuvo::study
