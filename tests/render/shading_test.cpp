#include "nuvo/render/shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nuvo {
namespace {

Light point_light(const Point3& location) {
    Light light;
    light.kind = Light::Kind::kPoint;
    light.location = location;
    return light;
}

TEST(SampleLight, DirectionalLightComesFromOppositeItsDirectionUnattenuated) {
    Light sun;
    sun.direction = {0, -1, 0};
    sun.attenuation = {5, 5, 5};  // has no meaning for it
    const auto sample = sample_light(sun, {1, 2, 3});
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->to_light, (Vector3{0, 1, 0}));
    EXPECT_EQ(sample->strength, 1);
}

// Equations 38 and 39 at distance 5: 1 / max(1, c1 + 5 c2 + 25 c3).
TEST(SampleLight, AttenuatesWithTheDistanceFromTheLight) {
    Light lamp = point_light({0, 3, 4});
    EXPECT_EQ(sample_light(lamp, {0, 0, 0})->strength, 1);
    lamp.attenuation = {0.5, 0.1, 0.04};
    EXPECT_DOUBLE_EQ(sample_light(lamp, {0, 0, 0})->strength, 1 / (0.5 + 0.5 + 1.0));
    lamp.attenuation = {0.1, 0, 0};
    EXPECT_EQ(sample_light(lamp, {0, 0, 0})->strength, 1);  // never brighter than unattenuated
    lamp.attenuation = {0, 0, 0};
    EXPECT_EQ(sample_light(lamp, {0, 0, 0})->strength, 1);  // stands for 1 0 0
    lamp.attenuation = {0, 1, 0};
    lamp.units_per_world = 2;  // a light under a scale of one half
    EXPECT_DOUBLE_EQ(sample_light(lamp, {0, 0, 0})->strength, 0.1);
}

TEST(SampleLight, GivesNothingBeyondItsRadiusNorAtItsOwnPlace) {
    Light lamp = point_light({0, 3, 4});
    lamp.radius = 5;
    EXPECT_TRUE(sample_light(lamp, {0, 0, 0}));
    lamp.radius = 4.99;
    EXPECT_FALSE(sample_light(lamp, {0, 0, 0}));
    EXPECT_FALSE(sample_light(lamp, {0, 3, 4}));
    Light blind;
    blind.direction = {0, 0, 0};
    EXPECT_FALSE(sample_light(blind, {0, 0, 0}));
}

// Equations 40 and 41 at 30 degrees off the axis.
TEST(SampleLight, SpotFallsOffLinearlyInTheAngle) {
    Light spot = point_light({0, 0, 0});
    spot.kind = Light::Kind::kSpot;
    spot.direction = {0, 0, -1};
    const Point3 point{std::sin(M_PI / 6), 0, -std::cos(M_PI / 6)};
    spot.beam_width = 0.3;
    spot.cut_off_angle = 0.7;
    EXPECT_NEAR(sample_light(spot, point)->strength, (M_PI / 6 - 0.7) / (0.3 - 0.7), 1e-14);
    spot.cut_off_angle = 0.5;
    EXPECT_FALSE(sample_light(spot, point));
    spot.cut_off_angle = 0.7;
    spot.beam_width = 0.6;
    EXPECT_EQ(sample_light(spot, point)->strength, 1);
    spot.beam_width = 0.7;  // equal angles: the thesis' 0 / 0
    EXPECT_EQ(sample_light(spot, point)->strength, 1);
    spot.beam_width = 1.2;  // wider than the cut-off: full to the edge
    EXPECT_EQ(sample_light(spot, point)->strength, 1);
    EXPECT_FALSE(sample_light(spot, {0, 0, 1}));  // behind it
}

// A spot from 1e7 away that lights half a unit: at 0.25 across, the angle is 2.5e-8 to the last
// digits (the arc of x is x - x^3 / 3), half of the cone; the cosine's nearest doubles are 1.5e-8
// apart there.
TEST(SampleLight, NarrowSpotsFallOffSmoothly) {
    Light spot = point_light({0, 0, 1e7});
    spot.kind = Light::Kind::kSpot;
    spot.direction = {0, 0, -1};
    spot.radius = std::numeric_limits<double>::infinity();
    spot.beam_width = 0;
    spot.cut_off_angle = 5e-8;
    for (const double x : {0.0, 0.01, 0.1, 0.25, 0.333, 0.49})
        EXPECT_NEAR(sample_light(spot, {x, 0, 0})->strength, 1 - 2 * x, 1e-8) << x;
    EXPECT_FALSE(sample_light(spot, {0, 0.51, 0}));
    // Skew: (3, 4, 12) / 13 is a unit vector, and (4, -3, 0) / 5 is perpendicular to it.
    spot.location = {-3e7, -4e7, -12e7};
    spot.direction = {3.0 / 13, 4.0 / 13, 12.0 / 13};
    spot.cut_off_angle = 2.0 / 13e7;
    for (const double x : {0.0, 0.125, 0.5, 1.0, 1.75})
        EXPECT_NEAR(sample_light(spot, {0.8 * x, -0.6 * x, 0})->strength, 1 - x / 2, 1e-7) << x;
}

// Light at 60 degrees from the normal, viewer on the normal; halfway vector at 30 degrees.
TEST(LightContribution, SumsAmbientDiffuseAndSpecular) {
    Light light;
    light.color = {1, 0.5, 0.25};
    light.intensity = 0.8;
    light.ambient_intensity = 0.5;
    Material material;
    material.diffuse_color = {0.6, 0.4, 0.2};
    material.ambient_intensity = 0.3;
    material.specular_color = {0.1, 0.2, 0.3};
    material.shininess = 0.0625;  // exponent 8
    const LightSample sample{{std::sin(M_PI / 3), 0, std::cos(M_PI / 3)}, 0.5};
    const Color color = light_contribution(light, sample, material, {0, 0, 1}, {0, 0, 1});
    const double lobe = std::pow(std::cos(M_PI / 6), 8);
    const double expected[3] = {
        0.5 * 1.00 * (0.6 * (0.5 * 0.3) + 0.6 * 0.8 * 0.5 + 0.1 * 0.8 * lobe),
        0.5 * 0.50 * (0.4 * (0.5 * 0.3) + 0.4 * 0.8 * 0.5 + 0.2 * 0.8 * lobe),
        0.5 * 0.25 * (0.2 * (0.5 * 0.3) + 0.2 * 0.8 * 0.5 + 0.3 * 0.8 * lobe)};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], 1e-15);
}

TEST(LightContribution, AFaceTurnedAwayKeepsItsAmbientPartOnly) {
    Light light;
    light.ambient_intensity = 1;
    const LightSample sample{{0, 0, -1}, 1};
    const Color color = light_contribution(light, sample, Material{}, {0, 0, 1}, {0, 0, 1});
    EXPECT_DOUBLE_EQ(color.x, 0.8 * 0.2);
}

TEST(Quantized, RoundsToNearestTiesUpAndClamps) {
    EXPECT_EQ(quantized(Color{0.5, 0, 1}), (Rgb8{128, 0, 255}));  // 127.5 goes up
    EXPECT_EQ(quantized(Color{2, -1, 127.4 / 255}), (Rgb8{255, 0, 127}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(quantized(Color{nan, 1e300, -0.0}), (Rgb8{0, 255, 0}));
}

}  // namespace
}  // namespace nuvo
