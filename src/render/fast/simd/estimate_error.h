#pragma once

#include "nuvo/math/error_bounds.h"

namespace nuvo {

/// Bounds on the relative errors of inverse_sqrt() and reciprocal() of vector_math.h.
inline constexpr float kInverseSqrtError = roundings(2) + 0x1.8p-28F;
inline constexpr float kReciprocalError = roundings(1) + 0x1p-28F;

}  // namespace nuvo
