// The grouping nodes of X3D 4.0, and the UNIT statements of a file.
#include <numbers>

#include "scene/loading.h"
#include "scene/temporary_folder.h"

namespace nuvo {
namespace {

const std::string kBall = shape("<Sphere/>");

Point3 center(const Scene& scene, std::size_t object = 0) {
    return std::get<Sphere>(scene.objects.at(object).shape).center;
}

TEST(LoaderGroups, EveryGroupingNodeShowsItsChildren) {
    for (const char* name :
         {"Anchor",         "Billboard",   "CADAssembly",    "CADFace",     "CADLayer",
          "CADPart",        "Collision",   "EspduTransform", "GeoLocation", "GeoLOD",
          "GeoTransform",   "Group",       "HAnimHumanoid",  "HAnimJoint",  "HAnimSegment",
          "HAnimSite",      "Layer",       "LayoutGroup",    "LayoutLayer", "LOD",
          "PickableGroup",  "ScreenGroup", "StaticGroup",    "ToggleGroup", "Transform",
          "ViewpointGroup", "Viewport"}) {
        const std::string node = name;
        const Scene scene = load(bare("<" + node + ">" + kBall + "</" + node + ">"));
        EXPECT_EQ(scene.objects.size(), 1u) << name;
        EXPECT_EQ(
            load(bare("<" + node + " visible='false'>" + kBall + "</" + node + ">")).objects.size(),
            0u)
            << name;
        const Scene inside =
            load(bare("<" + node + "><Viewpoint position='1 2 3'/></" + node + ">"));
        EXPECT_EQ(inside.camera.position, (Point3{1, 2, 3})) << name;
    }
}

TEST(LoaderGroups, NodesWithATransformsFieldsMoveTheirChildren) {
    for (const char* name : {"CADPart", "EspduTransform", "HAnimHumanoid", "HAnimJoint",
                             "HAnimSite", "GeoTransform", "Transform"}) {
        const std::string node = name;
        // By hand: scaled by 2 about (1, 0, 0), turned to -x, moved by (0, 0, 5).
        const Scene scene =
            load(bare("<" + node +
                      " translation='0 0 5' rotation='0 1 0 3.14159265358979323846' "
                      "scale='2 2 2' center='1 0 0'><Transform translation='3 0 0'>" +
                      kBall + "</Transform></" + node + ">"));
        expect_near(center(scene), {-3, 0, 5});
        EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 2) << name;
    }
}

TEST(LoaderGroups, WhatIsNotReadOfAGroupIsWarnedOf) {
    for (const char* name : {"GeoLocation", "GeoLOD", "GeoTransform", "LayoutGroup", "LayoutLayer",
                             "ScreenGroup", "Viewport"}) {
        const std::string node = name;
        EXPECT_EQ(load(bare("<" + node + ">" + kBall + "</" + node + ">")).warnings.size(), 1u)
            << name;
    }
}

TEST(LoaderGroups, AHumanoidListsItsPartsButTheyAreDrawnOnce) {
    const Scene scene = load(versioned(
        "4.0",
        "<HAnimHumanoid translation='0 0 1'><HAnimJoint DEF='root' containerField='skeleton' "
        "translation='1 0 0'><HAnimSegment DEF='s'>" +
            kBall +
            "</HAnimSegment><HAnimJoint DEF='arm' translation='1 0 0'><HAnimSegment "
            "DEF='a'>" +
            shape("<Sphere radius='2'/>") +
            "</HAnimSegment></HAnimJoint></HAnimJoint><HAnimJoint USE='root' "
            "containerField='joints'/><HAnimJoint USE='arm' containerField='joints'/>"
            "<HAnimSegment USE='s' containerField='segments'/><HAnimSegment USE='a' "
            "containerField='segments'/><Coordinate containerField='skinCoord' point='0 0 0'/>" +
            shape("<Sphere radius='3'/>") + "</HAnimHumanoid>"));
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.shape_count, 3u);
    EXPECT_EQ(center(scene, 0), (Point3{1, 0, 1}));
    EXPECT_EQ(center(scene, 1), (Point3{2, 0, 1}));
    EXPECT_EQ(center(scene, 2), (Point3{0, 0, 1}));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(LoaderGroups, LayersAreDrawnWhereTheOrderNamesThem) {
    const auto layers = [](const std::string& fields) {
        std::string text = "<LayerSet " + fields + "><MetadataString/>";
        for (int i = 1; i <= 3; ++i)
            text += "<Layer>" + shape("<Sphere radius='" + std::to_string(i) + "'/>") + "</Layer>";
        return load(bare(text + "</LayerSet>" + kBall));
    };
    EXPECT_EQ(layers("order='0 1 2 3'").objects.size(), 3u);  // the last is where the first is
    EXPECT_EQ(layers("order='2 0'").objects.size(), 2u);
    EXPECT_EQ(layers("order='2 0'").shape_count, 4u);
    EXPECT_EQ(layers("").objects.size(), 1u);  // the layers' default order is 0 alone
    EXPECT_EQ(layers("").warnings.size(), 1u);
    EXPECT_EQ(load(bare("<LayerSet order='1'><LayoutLayer>" + kBall + "</LayoutLayer></LayerSet>"))
                  .objects.size(),
              1u);
}

std::string with_units(const std::string& units, const std::string& nodes) {
    return "<X3D version='3.3'><head>" + units + "</head><Scene>" + nodes + "</Scene></X3D>";
}
std::string unit(const std::string& category, const std::string& factor) {
    return "<unit category='" + category + "' name='u' conversionFactor='" + factor + "'/>";
}
const std::string kDegrees = unit("angle", "0.017453292519943295");

TEST(LoaderUnits, AnglesAreConvertedWhereverTheyStand) {
    const Scene scene = load(with_units(
        kDegrees,
        "<Viewpoint fieldOfView='60' orientation='0 1 0 90'/>"
        "<Background skyColor='0 0 0 1 1 1' skyAngle='45' groundColor='0 0 0 1 1 1' "
        "groundAngle='30'/><SpotLight beamWidth='10' cutOffAngle='20'/>"
        "<Transform rotation='0 0 1 90'><Transform translation='3 0 0'>" +
            kBall +
            "</Transform></Transform>"
            "<Transform rotation='0 0 1 0.5' scaleOrientation='0 0 1 45' scale='1 2 1'/>" +
            shape("<IndexedFaceSet creaseAngle='60' coordIndex='0 1 2 -1 1 0 3 -1'><Coordinate "
                  "point='0 0 0 1 0 0 0 1 0 0 -1 0.5'/></IndexedFaceSet>")));
    const double degree = std::numbers::pi / 180;
    EXPECT_NEAR(scene.camera.field_of_view_rad, 60 * degree, 1e-14);
    expect_near(scene.camera.forward, {-1, 0, 0});
    EXPECT_NEAR(scene.background.sky_angle.at(0), 45 * degree, 1e-14);
    EXPECT_NEAR(scene.background.ground_angle.at(0), 30 * degree, 1e-14);
    EXPECT_NEAR(scene.lights.at(0).beam_width, 10 * degree, 1e-14);
    EXPECT_NEAR(scene.lights.at(0).cut_off_angle, 20 * degree, 1e-14);
    expect_near(center(scene), {0, 3, 0}, 1e-13);
    EXPECT_FALSE(mesh_of(scene, 1).normals.empty());  // 26.6 degrees between the faces
    EXPECT_TRUE(scene.warnings.empty());
    // Defaults are radians in every file.
    EXPECT_EQ(load(with_units(kDegrees, "<Viewpoint/>")).camera, Camera{});
}

TEST(LoaderUnits, ValuesThatPrototypesPassOnAreConvertedOnce) {
    const Scene scene = load(with_units(
        kDegrees,
        "<ProtoDeclare name='T'><ProtoInterface><field name='r' type='SFRotation' "
        "accessType='inputOutput' value='0 0 1 30'/></ProtoInterface><ProtoBody>"
        "<Transform rotation='0 0 1 10'><IS><connect nodeField='rotation' protoField='r'/></IS>"
        "<Transform translation='3 0 0'>" +
            kBall +
            "</Transform></Transform></ProtoBody></ProtoDeclare><ProtoInstance name='T'>"
            "<fieldValue name='r' value='0 0 1 90'/></ProtoInstance>"
            "<ProtoInstance name='T'/>"));
    expect_near(center(scene, 0), {0, 3, 0}, 1e-13);
    expect_near(center(scene, 1), {3 * std::numbers::sqrt3 / 2, 1.5, 0}, 1e-13);
}

TEST(LoaderUnits, AnInlinedFilesLengthsAreScaledToTheScenes) {
    const TemporaryFolder folder;
    folder.put("inches.x3d", with_units(unit("length", "0.0254") + kDegrees,
                                        "<Transform rotation='0 0 1 90' translation='10 0 0'>" +
                                            kBall + "</Transform>"));
    const std::string nodes = "<Inline url='inches.x3d'/>" + kBall;
    const Scene meters = x3d::read_file(folder.put("m.x3d", with_units("", nodes)));
    EXPECT_DOUBLE_EQ(center(meters).x, 0.254);
    EXPECT_DOUBLE_EQ(std::get<Sphere>(meters.objects.at(0).shape).radius, 0.0254);
    EXPECT_EQ(std::get<Sphere>(meters.objects.at(1).shape).radius, 1);
    const Scene feet =
        x3d::read_file(folder.put("ft.x3d", with_units(unit("length", "0.3048"), nodes)));
    EXPECT_DOUBLE_EQ(center(feet).x, 10.0 / 12);
    EXPECT_EQ(std::get<Sphere>(feet.objects.at(1).shape).radius, 1);  // its own unit
}

TEST(LoaderUnits, FactorsThatAreNoPositiveNumberAreRefused) {
    for (const char* factor : {"0", "-1", "nan", "NaN", "1e400", "", "one", "1 2", "inf"}) {
        for (const char* category : {"angle", "length"})
            EXPECT_EQ(refusal(with_units(unit(category, factor), kBall)),
                      "scene.x3d: head/unit@conversionFactor: \"" + std::string(factor) +
                          "\" is no positive number (line 1)");
        EXPECT_EQ(refusal(with_units(unit("mass", factor), kBall)), "");
        EXPECT_THROW(load(with_units(unit("length", factor), kBall)), x3d::Error);
    }
    // Factors whose ratio is beyond double lose the Inline, not the scene.
    const TemporaryFolder folder;
    folder.put("big.x3d", with_units(unit("length", "1e300"), kBall));
    const Scene scene = x3d::read_file(folder.put(
        "main.x3d", with_units(unit("length", "1e-300"), "<Inline url='big.x3d'/>" + kBall)));
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace nuvo
