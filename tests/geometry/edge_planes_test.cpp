#include <gtest/gtest.h>

#include "geometry/predicates_oracle.h"
#include "geometry/worst_case.h"

namespace nuvo {
namespace {

using oracle::Rational;
using oracle::RationalVector;

constexpr unsigned kSeed = 20261134;

// (P - p) x (Q - p) by a power of two, each component within (1 + 2^-10) roundoffs, at scales where
// the products themselves are far beyond the range; its size is the same at each scale.
TEST(EdgePlanes, AreTheExactNormalsRounded) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    worst_case::Draw draw(kSeed);
    for (int i = 0; i < 120; ++i) {
        const double scale = std::exp2(300 * (i % 5 - 2));
        Triangle t{draw.vector() * scale, draw.vector() * scale, draw.vector() * scale};
        Point3 p = draw.vector() * scale;
        if (i % 3 == 1) p.z = t.a.z = t.b.z = t.c.z;  // normals along z alone
        if (i % 3 == 2) t.b = t.a + (t.a - p) * 0.5 + draw.vector() * (scale * 0x1p-50);
        const EdgePlanes planes = edge_planes_through(t, p);
        const Point3 corner[3] = {t.a, t.b, t.c};
        for (int e = 0; e < 3; ++e) {
            const RationalVector from = oracle::rational(corner[(e + 2) % 3]) - oracle::rational(p);
            const RationalVector to = oracle::rational(corner[(e + 1) % 3]) - oracle::rational(p);
            const RationalVector n = cross(from, to);
            const Rational exact[3] = {n.x, n.y, n.z};
            const double size = max_norm(planes.normal[e]);
            EXPECT_GE(size, 0.5);
            EXPECT_LT(size, 1.5);
            int largest = 0;
            for (int axis = 1; axis < 3; ++axis)
                if (abs(exact[axis]) > abs(exact[largest])) largest = axis;
            const oracle::Real quotient =
                oracle::Real(planes.normal[e][largest]) / oracle::real(exact[largest]);
            ASSERT_GT(quotient, 0);
            int exponent = 0;  // of the power of two next to it
            (void)frexp(oracle::Real(quotient * oracle::Real(1.25)), &exponent);
            const oracle::Real power = ldexp(oracle::Real(1), exponent - 1);
            for (int axis = 0; axis < 3; ++axis) {
                const oracle::Real truth = oracle::real(exact[axis]) * power;
                const oracle::Real off =
                    abs(oracle::Real(oracle::Real(planes.normal[e][axis]) - truth));
                EXPECT_LE(off, abs(truth) * oracle::Real(0x1p-53 * (1 + 0x1p-10)))
                    << "case " << i << ", edge " << e << ", axis " << axis;
            }
        }
    }
}

}  // namespace
}  // namespace nuvo
