#pragma once

#include <cstdint>

// Vectors of four floats, which every target has, for work on a box's three axes at once.

namespace nuvo {

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

inline Four splat(float value) { return Four{value, value, value, value}; }
inline Four least(Four a, Four b) { return a < b ? a : b; }
inline Four most(Four a, Four b) { return a > b ? a : b; }

}  // namespace nuvo
