#include "fast/scene/ball_map.h"

#include <gtest/gtest.h>

#include "true_ball.h"

namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261137;

TEST(BallMap, IsAsNearToTheTrueOneAsItSays) {
    std::mt19937_64 random(kSeed);
    double share = 0;
    double stretched = 0;
    int sure = 0;
    for (int round = 0; round < 4000; ++round) {
        const Point3 center = uniform_point(random, 1);
        const double radius = std::exp2(uniform(random, -20, -1));
        const Ellipsoid e = random_ellipsoid(random, center, radius, round % 2 == 0 ? -1 : -8);
        LocalFrame frame;
        frame.scale = std::exp2(static_cast<double>(random() % 8) - 4);
        const BallMap map = ball_map(e, frame);
        if (!map.sure) continue;
        ++sure;
        const TrueBall exact(e, frame.scale, map.radius);
        for (int i = 0; i < 20; ++i) {
            const Vector3 v = uniform_point(random, 1) - Point3{};
            RealVector off;
            for (int k = 0; k < 3; ++k)
                off[k] =
                    dot(RealVector(map.to_ball.row[k]), RealVector(v)) - exact(RealVector(v))[k];
            const Real size = largest(RealVector(v));
            ASSERT_LE(largest(off), Real(map.error) * size) << "round " << round;
            ASSERT_LE(largest(exact(RealVector(v))), Real(map.stretch) * size) << "round " << round;
            ASSERT_GE(largest(exact(RealVector(v))), size) << "round " << round;
            attain(share, largest(off), Real(map.error) * size);
            attain(stretched, largest(exact(RealVector(v))), Real(map.stretch) * size);
        }
    }
    EXPECT_GT(sure, 3000);
    EXPECT_GT(share, 0.03);
    EXPECT_GT(stretched, 0.9);
}

TEST(BallMap, LeavesFlatEllipsoidsToTheExactStage) {
    Ellipsoid e;
    e.radius = 0.5;
    EXPECT_TRUE(ball_map(e, {}).sure);
    e.linear.row[1] = e.linear.row[1] * 0x1p-12;
    EXPECT_FALSE(ball_map(e, {}).sure);
    e.linear.row[1] = {0, 0, 0};
    EXPECT_FALSE(ball_map(e, {}).sure);
}

}  // namespace
}  // namespace nuvo::testing
