#include "nuvo/scene/background.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nuvo {
namespace {

const Color kRed{1, 0, 0};
const Color kGreen{0, 1, 0};
const Color kBlue{0, 0, 1};

void expect_color(const Color& actual, const Color& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-12);
}

/// The unit vector `angle` radians below the zenith.
Vector3 from_zenith(double angle) { return {std::sin(angle), std::cos(angle), 0}; }

TEST(Background, IsBlackByDefault) { EXPECT_EQ(Background{}.color({0, 1, 0}), (Color{0, 0, 0})); }

TEST(Background, OneSkyAndOneGroundColorBlendByTheDirectionsHeight) {
    const Background background{{{0.9, 0.74, 0.9}}, {}, {{0.43, 0.54, 0.72}}, {}};
    EXPECT_EQ(background.color({0, 1, 0}), (Color{0.9, 0.74, 0.9}));
    EXPECT_EQ(background.color({0, -1, 0}), (Color{0.43, 0.54, 0.72}));
    expect_color(background.color({1, 0, 0}), {0.665, 0.64, 0.81});
    expect_color(background.color({0.8, 0.6, 0}), {0.806, 0.7, 0.864});  // 0.8 sky + 0.2 ground
}

TEST(Background, ASkyAloneIsUniform) {
    const Background background{{kRed}, {}, {}, {}};
    for (const double angle : {0.0, 1.0, 2.0, 3.14})
        EXPECT_EQ(background.color(from_zenith(angle)), kRed);
}

TEST(Background, SkyBandsAreLinearInTheAngleFromTheZenith) {
    const Background background{{kRed, kGreen, kBlue}, {1, 2}, {}, {}};
    expect_color(background.color({0, 1, 0}), kRed);
    expect_color(background.color(from_zenith(0.25)), {0.75, 0.25, 0});
    expect_color(background.color(from_zenith(1)), kGreen);
    expect_color(background.color(from_zenith(1.5)), {0, 0.5, 0.5});
    expect_color(background.color(from_zenith(2)), kBlue);
    expect_color(background.color(from_zenith(3)), kBlue);  // beyond the last angle
}

TEST(Background, TheGroundOverlaysTheLowerHalfOfTheSky) {
    const Background background{{kRed, kGreen}, {3.0}, {kBlue, kRed}, {M_PI / 2}};
    expect_color(background.color({0, -1, 0}), kBlue);
    expect_color(background.color(from_zenith(M_PI * 3 / 4)), {0.5, 0, 0.5});
    expect_color(background.color({1, 0, 0}), kRed);  // to the horizon
    expect_color(background.color(from_zenith(1.5)), {0.5, 0.5, 0});
}

// 19775-1, 24.2.1: "If the last groundAngle is less than pi/2, the region between the last
// groundAngle and the equator is non-existent."
TEST(Background, TheSkyGoesOnBelowTheHorizonWhereTheGroundEnds) {
    const Background background{{kRed, kGreen}, {3.0}, {kBlue, kRed}, {1}};
    expect_color(background.color(from_zenith(M_PI - 0.5)), {0.5, 0, 0.5});
    expect_color(background.color(from_zenith(M_PI - 0.999)), {0.999, 0, 0.001});
    expect_color(background.color(from_zenith(2)), {1 / 3., 2 / 3., 0});
    const Background plain{{kRed}, {}, {kBlue, kBlue}, {1}};
    EXPECT_EQ(plain.color(from_zenith(M_PI - 0.9)), kBlue);
    EXPECT_EQ(plain.color(from_zenith(M_PI - 1.1)), kRed);
}

TEST(Background, ItsZenithMayLieAnywhere) {
    Background background{{kRed, kGreen, kBlue}, {1, 2}, {}, {}};
    background.zenith = {0, 0, -1};
    expect_color(background.color({0, 0, -1}), kRed);
    expect_color(background.color({0, std::sin(0.25), -std::cos(0.25)}), {0.75, 0.25, 0});
    expect_color(background.color({0, 0, 1}), kBlue);
    Background blend{{kRed}, {}, {kBlue}, {}};
    blend.zenith = {1, 0, 0};
    expect_color(blend.color({0, 1, 0}), {0.5, 0, 0.5});
    expect_color(blend.color({1, 0, 0}), kRed);
}

TEST(Background, OneGroundColorBelowASkyOfBandsFillsTheLowerHalf) {
    const Background background{{kRed, kRed}, {1}, {kBlue}, {}};
    EXPECT_EQ(background.color(from_zenith(1.5)), kRed);
    EXPECT_EQ(background.color(from_zenith(1.7)), kBlue);
}

TEST(Background, BandsOfNoWidthAreEdges) {
    const Background background{{kRed, kGreen, kBlue, kRed}, {0, 1, 1}, {}, {}};
    expect_color(background.color({0, 1, 0}), kGreen);
    expect_color(background.color(from_zenith(0.5)), {0, 0.5, 0.5});
    expect_color(background.color(from_zenith(1.01)), kRed);
}

}  // namespace
}  // namespace nuvo
