#include <gtest/gtest.h>

#include <cmath>

#include "nuvo/geometry/predicates.h"

namespace nuvo {
namespace {

// d = 2^-1074 (1, 0, 0) from 0: u = d.(c x b) = -10.1 x 2^-1074, which came out as 70 x 2^-1074.
TEST(PredicatesUnderflow, TheBoundOfAnEdgeHoldsForTheLeastDirection) {
    const Vector3 b{50, 100.3, 100};
    const Vector3 c{50, 100.4, 100.6};
    const double computed = dot(b, cross(Vector3{0x1p-1074, 0, 0}, c));
    const double error = detail::edge_error_bound(0x1p-1074, 100.6);
    EXPECT_GE(error, std::fabs(computed - -10 * 0x1p-1074));
}

// The bound does not vanish where a (f.f + R^2) does.
TEST(PredicatesUnderflow, TheBoundOfADiscriminantIsMoreThanTwoRoundings) {
    EXPECT_GT(detail::discriminant_error_bound(0x1p-700, 0x1p-800), 2 * 0x1p-1074);
}

}  // namespace
}  // namespace nuvo
