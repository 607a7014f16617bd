#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "nuvo/math/vec.h"

namespace nuvo::testing {

/// 60 digits: the truth that bounds of floats and doubles are held against.
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;
using RealVector = Vec3<Real>;

/// Of what a bound allows, the most that an error took.
inline void attain(double& share, const Real& error, const Real& bound) {
    share = std::fmax(share, static_cast<double>(Real(error / bound)));
}

}  // namespace nuvo::testing
