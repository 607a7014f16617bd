// Lights, their defaults by version, their scopes, and the headlight.
#include <cmath>
#include <numbers>

#include "scene/loading.h"

namespace nuvo {
namespace {

using x3d::Headlight;

Light light_from(const std::string& document) { return load(document).lights.at(0); }

const LightScope kEverything{};
const std::string kSphere = shape("<Sphere/>");

TEST(LoaderLight, HasTheDefaultsOfTheStandard) {
    const Light sun = light_from(bare("<DirectionalLight/>"));
    EXPECT_EQ(sun.kind, Light::Kind::kDirectional);
    EXPECT_EQ(sun.color, (Color{1, 1, 1}));
    EXPECT_EQ(sun.intensity, 1);
    EXPECT_EQ(sun.ambient_intensity, 0);
    EXPECT_EQ(sun.direction, (Vector3{0, 0, -1}));
    EXPECT_TRUE(sun.casts_shadow);
    const Light point = light_from(bare("<PointLight/>"));
    EXPECT_EQ(point.kind, Light::Kind::kPoint);
    EXPECT_EQ(point.location, (Point3{0, 0, 0}));
    EXPECT_EQ(point.attenuation, (Vector3{1, 0, 0}));
    EXPECT_EQ(point.radius, 100);
    EXPECT_EQ(point.units_per_world, 1);
}

TEST(LoaderLight, SpotLightDefaultsFollowTheVersion) {
    for (const std::string& old : {bare("<SpotLight/>"), versioned("3.0", "<SpotLight/>"),
                                   versioned("3.3", "<SpotLight/>")}) {
        EXPECT_EQ(light_from(old).beam_width, 0.785398);
        EXPECT_EQ(light_from(old).cut_off_angle, 1.570796);
    }
    EXPECT_EQ(light_from(versioned("4.0", "<SpotLight/>")).beam_width, 0.589049);
    EXPECT_EQ(light_from(versioned("4.0", "<SpotLight/>")).cut_off_angle, 1.570796);
}

TEST(LoaderLight, ReadsEveryField) {
    const Light spot = light_from(versioned(
        "3.3",
        "<SpotLight color='0.1 0.2 0.3' intensity='0.5' ambientIntensity='0.25' "
        "direction='0 3 4' location='1 2 3' attenuation='0.5 2 3' radius='7' beamWidth='0.1' "
        "cutOffAngle='0.2' global='true' on='true'/>"));
    EXPECT_EQ(spot.kind, Light::Kind::kSpot);
    EXPECT_EQ(spot.color, (Color{0.1, 0.2, 0.3}));
    EXPECT_EQ(spot.intensity, 0.5);
    EXPECT_EQ(spot.ambient_intensity, 0.25);
    expect_near(spot.direction, {0, 0.6, 0.8});
    EXPECT_EQ(spot.location, (Point3{1, 2, 3}));
    EXPECT_EQ(spot.attenuation, (Vector3{0.5, 2, 3}));
    EXPECT_EQ(spot.radius, 7);
    EXPECT_EQ(spot.beam_width, 0.1);
    EXPECT_EQ(spot.cut_off_angle, 0.2);
}

TEST(LoaderLight, ClampsWithAWarning) {
    const Scene scene = load(
        versioned("3.3", kSphere + "<SpotLight intensity='3' color='2 0 0' ambientIntensity='-1' "
                                   "attenuation='-1 0 0' beamWidth='-1' cutOffAngle='40'/>"));
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.intensity, 1);
    EXPECT_EQ(light.color, (Color{1, 0, 0}));
    EXPECT_EQ(light.ambient_intensity, 0);
    EXPECT_EQ(light.attenuation, (Vector3{0, 0, 0}));
    EXPECT_EQ(light.beam_width, 0);
    EXPECT_EQ(light.cut_off_angle, std::numbers::pi / 2);
    EXPECT_EQ(scene.warnings.size(), 6u);
    EXPECT_EQ(light_from(versioned("4.0", "<PointLight intensity='3'/>")).intensity, 3);
    EXPECT_EQ(light_from(versioned("4.0", "<PointLight intensity='-3'/>")).intensity, 0);
    EXPECT_EQ(refusal(bare("<PointLight radius='-1'/>")),
              "scene.x3d: Scene/PointLight@radius: is negative (line 1)");
}

TEST(LoaderLight, OneThatIsOffIsLeftOut) {
    const Scene scene = load(bare("<PointLight on='false'/><PointLight intensity='0.5'/>"));
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].intensity, 0.5);
}

TEST(LoaderLight, MovesWithItsAncestors) {
    const Scene scene = load(
        bare("<Transform translation='1 2 3' rotation='0 0 1 1.5707963267948966' scale='2 2 2'>"
             "<SpotLight location='1 0 0' direction='1 0 0' radius='10'/></Transform>"));
    const Light& light = scene.lights.at(0);
    expect_near(light.location, {1, 4, 3});
    expect_near(light.direction, {0, 1, 0});
    EXPECT_EQ(light.radius, 20);
    EXPECT_EQ(light.units_per_world, 0.5);
}

TEST(LoaderLight, UnequalScalesMeasureDistanceByTheCubeRootOfTheDeterminant) {
    const Light light = light_from(bare(
        "<Transform scale='8 -1 1'><PointLight radius='10' attenuation='0 1 0'/></Transform>"));
    EXPECT_NEAR(light.radius, 20, 1e-14);
    EXPECT_NEAR(light.units_per_world, 0.5, 1e-15);
    EXPECT_EQ(light.attenuation, (Vector3{0, 1, 0}));
}

TEST(LoaderLight, DegenerateOnesAreWarnedOf) {
    const Scene scene =
        load(bare("<DirectionalLight direction='0 0 0'/>"
                  "<Transform scale='0 0 0'><PointLight/></Transform>"));
    EXPECT_EQ(scene.lights.at(0).direction, (Vector3{0, 0, 0}));
    EXPECT_EQ(scene.lights.at(1).radius, 0);
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{
                  "DirectionalLight@direction: 1 of length zero lighting nothing (first at "
                  "Scene/DirectionalLight, line 1)",
                  "PointLight@radius: 1 shrunk to zero by a singular transform (first at "
                  "Scene/Transform/PointLight, line 1)"}));
}

// The objects: 0 before, 1 and 2 in the light's group, 3 after it.
std::string around(const std::string& light) {
    return kSphere + "<Group>" + shape("<Sphere radius='2'/>") + light + "<Transform>" +
           shape("<Sphere radius='3'/>") + "</Transform></Group>" + shape("<Sphere radius='4'/>");
}

TEST(LoaderLight, BeforeVersion31EveryLightLightsEverything) {
    for (const char* light :
         {"<DirectionalLight/>", "<PointLight global='false'/>", "<SpotLight/>"}) {
        EXPECT_EQ(light_from(bare(around(light))).scope, kEverything);
        EXPECT_EQ(light_from(versioned("3.0", around(light))).scope, kEverything);
        EXPECT_EQ(light_from("<X3D><Scene>" + around(light) + "</Scene></X3D>").scope, kEverything);
    }
}

TEST(LoaderLight, FromVersion31OnGlobalDecides) {
    const LightScope group{1, 3};
    for (const char* version : {"3.1", "3.3", "4.0"}) {
        const auto scope = [&](const std::string& light) {
            return light_from(versioned(version, around(light))).scope;
        };
        EXPECT_EQ(scope("<DirectionalLight/>"), group);
        EXPECT_EQ(scope("<DirectionalLight global='true'/>"), kEverything);
        EXPECT_EQ(scope("<PointLight/>"), kEverything);
        EXPECT_EQ(scope("<PointLight global='false'/>"), group);
        EXPECT_EQ(scope("<SpotLight/>"), kEverything);
        EXPECT_EQ(scope("<SpotLight global='false'/>"), group);
    }
}

TEST(LoaderLight, EachUseOfAGroupLightsItsOwnShapes) {
    const Scene scene =
        load(versioned("3.3", "<Group DEF='g'><DirectionalLight/>" + kSphere + "</Group>" +
                                  shape("<Sphere radius='2'/>") +
                                  "<Transform translation='1 0 0'><Group USE='g'/></Transform>"));
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].scope, (LightScope{0, 1}));
    EXPECT_EQ(scene.lights[1].scope, (LightScope{2, 3}));
}

TEST(LoaderLight, ThatReachesNoShapeIsWarnedOf) {
    const std::string nodes = kSphere + "<Transform><DirectionalLight/></Transform>";
    EXPECT_EQ(load(versioned("3.3", nodes)).warnings,
              std::vector<std::string>{"DirectionalLight: 1 reaching no shape (first at "
                                       "Scene/Transform/DirectionalLight, line 1)"});
    EXPECT_TRUE(load(versioned("3.0", nodes)).warnings.empty());
}

// 19775-1, 17.4.2: a PointLight lights what lies within its radius, 100 by default.
TEST(LoaderLight, WhoseRadiusReachesNoShapeIsWarnedOf) {
    const auto warnings = [](const std::string& light) {
        return load(versioned("3.3", "<Transform translation='50 0 0'>" + kSphere + "</Transform>" +
                                         light))
            .warnings;
    };
    EXPECT_EQ(warnings("<PointLight location='0 200 0'/>"),
              std::vector<std::string>{
                  "PointLight: 1 reaching no shape (first at Scene/PointLight, line 1)"});
    EXPECT_EQ(warnings("<SpotLight location='50 0 9' radius='7.99'/>").size(), 1u);
    EXPECT_EQ(warnings("<SpotLight location='50 0 9' radius='8'/>").size(), 0u);
    EXPECT_EQ(warnings("<PointLight location='50 0 0' radius='0'/>").size(), 0u);
    EXPECT_EQ(
        warnings("<Transform scale='3 3 3'><PointLight location='0 60 0'/></Transform>").size(),
        0u);
}

TEST(LoaderHeadlight, LightsOnlyAFileWithoutLightsOrThatAsksForIt) {
    const auto lights = [](const std::string& nodes, Headlight headlight) {
        return load(bare(nodes), headlight).lights.size();
    };
    const std::string on = "<NavigationInfo/>";
    const std::string off = "<NavigationInfo headlight='false'/>";
    const std::string sun = "<DirectionalLight/>";
    EXPECT_EQ(lights("", Headlight::kAuto), 1u);
    EXPECT_EQ(lights(sun, Headlight::kAuto), 1u);
    EXPECT_EQ(lights(on + sun, Headlight::kAuto), 2u);
    EXPECT_EQ(lights(off, Headlight::kAuto), 0u);
    EXPECT_EQ(lights(on + off + sun, Headlight::kAuto), 2u);
    EXPECT_EQ(lights(off + on + sun, Headlight::kAuto), 1u);
    EXPECT_EQ(lights(off + sun, Headlight::kOn), 2u);
    EXPECT_EQ(lights(on, Headlight::kOff), 0u);
}

TEST(LoaderHeadlight, ShinesAlongTheViewLastAndWithoutShadows) {
    const Scene scene =
        load(bare("<DirectionalLight/><Viewpoint orientation='0 1 0 1.5707963267948966'/>"
                  "<NavigationInfo headlight='TRUE'/>"));
    ASSERT_EQ(scene.lights.size(), 2u);
    const Light& headlight = scene.lights[1];
    EXPECT_EQ(headlight.kind, Light::Kind::kDirectional);
    EXPECT_EQ(headlight.direction, scene.camera.forward);
    expect_near(headlight.direction, {-1, 0, 0});
    EXPECT_EQ(headlight.color, (Color{1, 1, 1}));
    EXPECT_EQ(headlight.intensity, 1);
    EXPECT_EQ(headlight.ambient_intensity, 0);
    EXPECT_FALSE(headlight.casts_shadow);
    EXPECT_TRUE(scene.lights[0].casts_shadow);
    EXPECT_EQ(headlight.scope, kEverything);
}

}  // namespace
}  // namespace nuvo
