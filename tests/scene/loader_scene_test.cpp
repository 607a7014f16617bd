// The scene graph: shapes and materials, DEF and USE, view and background, what is not drawn.
#include <cmath>

#include "scene/loading.h"

namespace nuvo {
namespace {

using Strings = std::vector<std::string>;

std::string material_shape(const std::string& appearance) {
    return "<Shape><Sphere/>" + appearance + "</Shape>";
}

TEST(LoaderShape, MaterialDefaultsAreTheStandards) {
    const Scene scene = load(bare(shape("<Sphere/>")));
    EXPECT_EQ(scene.materials, std::vector<Material>{Material{}});
    EXPECT_TRUE(scene.materials[0].lit);
    EXPECT_EQ(scene.materials[0].diffuse_color, (Color{0.8, 0.8, 0.8}));
    EXPECT_EQ(scene.materials[0].specular_color, (Color{0, 0, 0}));
}

TEST(LoaderShape, WithoutAppearanceOrMaterialIsUnlitWhite) {
    const Scene scene = load(bare(material_shape("") + "<Transform translation='1 0 0'>" +
                                  material_shape("<Appearance/>") + "</Transform>"));
    ASSERT_EQ(scene.objects.size(), 2u);
    for (const Object& object : scene.objects) {
        EXPECT_FALSE(scene.materials.at(object.material).lit);
        EXPECT_EQ(scene.materials.at(object.material).emissive_color, (Color{1, 1, 1}));
    }
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(LoaderShape, ReadsEveryMaterialField) {
    const Scene scene = load(bare(material_shape(
        "<Appearance><Material diffuseColor='0.1 0.2 0.3' ambientIntensity='0.4' "
        "specularColor='0.5 0.6 0.7' shininess='0.8' emissiveColor='0.9 1 0'/></Appearance>")));
    const Material expected{{0.1, 0.2, 0.3}, 0.4, {0.5, 0.6, 0.7}, 0.8, {0.9, 1, 0}, true};
    EXPECT_EQ(scene.materials.at(0), expected);
}

TEST(LoaderShape, TransparencyIsOpaqueUnlessItIsOne) {
    const Scene scene = load(bare(
        material_shape("<Appearance><Material transparency='0.5'/></Appearance>") +
        material_shape("<Appearance><Material transparency='1'/></Appearance>") +
        "<Transform translation='1 0 0'>" +
        material_shape("<Appearance><Material transparency='0'/></Appearance>") + "</Transform>"));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[1].shape_index, 2u);
    EXPECT_EQ(scene.shape_count, 3u);
    EXPECT_EQ(scene.warnings,
              (Strings{"Material@transparency: 1 between 0 and 1: drawn opaque (first at "
                       "Scene/Shape[1]/Appearance/Material, line 1)",
                       "Material@transparency: 1 of 1: not drawn (first at "
                       "Scene/Shape[2]/Appearance/Material, line 1)"}));
}

TEST(LoaderShape, AppearanceAndGeometryStandInAnyOrder) {
    const std::string red = "<Appearance><Material diffuseColor='1 0 0'/></Appearance>";
    const Scene scene =
        load(bare("<Shape>" + red + "<Sphere/></Shape><Shape><Sphere/>" + red + "</Shape>"));
    for (const Object& object : scene.objects)
        EXPECT_EQ(scene.materials.at(object.material).diffuse_color, (Color{1, 0, 0}));
}

TEST(LoaderUse, SharesMaterialsAppearancesCoordinatesAndWholeGroups) {
    const Scene scene = load(bare(
        "<Shape><Appearance DEF='a'><Material DEF='m' diffuseColor='1 0 0'/></Appearance>"
        "<TriangleSet><Coordinate DEF='c' point='0 0 0 1 0 0 0 1 0'/></TriangleSet></Shape>"
        "<Shape DEF='s'><Appearance><Material USE='m'/></Appearance>"
        "<IndexedTriangleSet solid='false' index='1 2 0'><Coordinate USE='c'/></IndexedTriangleSet>"
        "</Shape>"
        "<Group DEF='g'><Shape><Appearance USE='a'/><Sphere DEF='b' radius='3'/></Shape></Group>"
        "<Transform translation='1 0 0'><Group USE='g'/><Shape USE='s'/></Transform>"
        "<Transform translation='2 0 0'><Shape><Sphere USE='b'/></Shape></Transform>"));
    ASSERT_EQ(scene.objects.size(), 6u);
    EXPECT_EQ(scene.shape_count, 6u);
    EXPECT_EQ(scene.materials.size(), 2u);  // red, and the unlit white of the last
    for (std::uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(scene.objects[i].material, 0u);
        EXPECT_EQ(scene.objects[i].shape_index, i);
    }
    EXPECT_EQ(std::get<Sphere>(scene.objects[3].shape).center, (Point3{1, 0, 0}));
    EXPECT_EQ(mesh_of(scene, 4).positions.at(0), (Point3{1, 0, 0}));
    EXPECT_FALSE(scene.objects[4].solid);
    EXPECT_EQ(std::get<Sphere>(scene.objects[5].shape).radius, 3);
}

TEST(LoaderUse, MeansTheLatestEarlierDefinition) {
    const Scene scene =
        load(bare("<Shape><Sphere DEF='x' radius='1'/></Shape><Transform translation='1 0 0'>"
                  "<Shape><Sphere USE='x'/></Shape></Transform>"
                  "<Shape><Sphere DEF='x' radius='2'/></Shape><Transform translation='1 0 0'>"
                  "<Shape><Sphere USE='x'/></Shape></Transform>"));
    const double expected[] = {1, 1, 2, 2};
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(std::get<Sphere>(scene.objects.at(i).shape).radius, expected[i]);
}

TEST(LoaderUse, OfNothingOfLaterOrOfItselfIsRefused) {
    EXPECT_EQ(refusal(bare("<Group/>\n<Group USE='x'/>")),
              "scene.x3d: Scene/Group[2]: USE=\"x\" names no DEF (line 2)");
    EXPECT_EQ(refusal(bare("<Group USE='x'/><Group DEF='x'/>")),
              "scene.x3d: Scene/Group[1]: USE=\"x\" comes before its DEF (line 1)");
    EXPECT_EQ(refusal(bare("<Group DEF='x'><Transform><Group USE='x'/></Transform></Group>")),
              "scene.x3d: Scene/Group/Transform/Group: USE=\"x\" is inside its own DEF (line 1)");
    EXPECT_EQ(refusal(bare("<Shape><Appearance><Material DEF='x'/></Appearance></Shape>"
                           "<Shape USE='x'/>")),
              "scene.x3d: Scene/Shape[2]: USE=\"x\" is a Material, not a Shape (line 1)");
}

TEST(LoaderUse, NamesInsidePrototypesAreTheirOwn) {
    EXPECT_EQ(refusal(bare("<ProtoDeclare name='p'><ProtoBody><Group DEF='x'/></ProtoBody>"
                           "</ProtoDeclare><Group USE='x'/>")),
              "scene.x3d: Scene/Group: USE=\"x\" comes before its DEF (line 1)");
}

/// 2 * 3^levels shapes by way of USE.
std::string tripling(int levels) {
    std::string nodes = "<Group DEF='l0'><Shape><Sphere/></Shape><Shape><Sphere/></Shape></Group>";
    std::string all = nodes;
    for (int i = 1; i <= levels; ++i) {
        const std::string use = "<Group USE='l" + std::to_string(i - 1) + "'/>";
        all += "<Group DEF='l" + std::to_string(i) + "'>" + use + use + use + "</Group>";
    }
    return all;
}

TEST(LoaderUse, ShapesAreLimitedAfterExpansionAtTheLimit) {
    // 2 + 6 + 18 shapes.
    x3d::Limits limits;
    limits.shapes = 27;
    EXPECT_EQ(load(bare(tripling(2)), x3d::Headlight::kAuto, limits).shape_count, 26u);
    limits.shapes = 26;
    EXPECT_EQ(load(bare(tripling(2)), x3d::Headlight::kAuto, limits).shape_count, 26u);
    limits.shapes = 25;
    EXPECT_EQ(refusal(bare(tripling(2)), limits),
              "scene.x3d: Scene/Group[3]: this makes the scene exceed the limit of 25 shapes "
              "(line 1)");
}

TEST(LoaderUse, BombsAreRefusedBeforeTheyAreExpanded) {
    EXPECT_NE(refusal(bare(tripling(40))).find("exceed the limit of 2000000 shapes"),
              std::string::npos);
    // The same with nothing to draw, and with depth.
    std::string empty = "<Group DEF='l0'/>";
    std::string deep =
        "<Group DEF='l0'>" + repeated("<Group>", 2000) + repeated("</Group>", 2000) + "</Group>";
    for (int i = 1; i < 40; ++i) {
        const std::string use = "<Group USE='l" + std::to_string(i - 1) + "'/>";
        const std::string def = "<Group DEF='l" + std::to_string(i) + "'>";
        empty += def + use + use + "</Group>";
        deep += def + repeated("<Group>", 2000) + use + repeated("</Group>", 2000) + "</Group>";
    }
    EXPECT_NE(refusal(bare(empty)).find("exceed the limit of 10000000 elements"),
              std::string::npos);
    EXPECT_NE(refusal(bare(deep)).find("exceed the limit of 4096 nested levels"),
              std::string::npos);
}

TEST(LoaderView, TheDefaultCameraIsTheStandards) {
    EXPECT_EQ(load("<Scene/>").camera, Camera{});
    EXPECT_EQ(load(bare("<Viewpoint/>")).camera, Camera{});
}

TEST(LoaderView, TheFirstViewpointInTheDocumentCounts) {
    const Camera camera = load(bare("<Group><Viewpoint position='1 2 3' fieldOfView='1'/></Group>"
                                    "<Viewpoint position='4 5 6'/>"))
                              .camera;
    EXPECT_EQ(camera.position, (Point3{1, 2, 3}));
    EXPECT_EQ(camera.field_of_view_rad, 1);
    EXPECT_EQ(camera.forward, (Vector3{0, 0, -1}));
}

TEST(LoaderView, OrientationTurnsAndAncestorsTransform) {
    // Turned about y by a quarter, the view along -z looks along -x and its right is -z.
    const Camera turned =
        load(bare("<Viewpoint orientation='0 2 0 1.5707963267948966' position='1 0 0'/>")).camera;
    expect_near(turned.forward, {-1, 0, 0});
    expect_near(turned.right, {0, 0, -1});
    expect_near(turned.up, {0, 1, 0});
    // Its parent turns that about z by a quarter: -x to -y, y to -x; scales only move it.
    const Camera moved =
        load(bare("<Transform translation='0 0 5' scale='2 3 1' "
                  "rotation='0 0 1 1.5707963267948966'><Viewpoint position='1 0 0' "
                  "orientation='0 1 0 1.5707963267948966'/></Transform>"))
            .camera;
    expect_near(moved.position, {0, 2, 5});
    expect_near(moved.forward, {0, -1, 0});
    expect_near(moved.right, {0, 0, -1});
    expect_near(moved.up, {-1, 0, 0});
}

TEST(LoaderView, FieldOfViewOutsideZeroToPiIsRefused) {
    for (const char* angle : {"0", "-1", "3.15", "40"})
        EXPECT_EQ(refusal(bare("<Viewpoint fieldOfView='" + std::string(angle) + "'/>")),
                  "scene.x3d: Scene/Viewpoint@fieldOfView: is not between 0 and pi (line 1)");
    EXPECT_EQ(refusal(bare("<Viewpoint fieldOfView='3.14'/>")), "");
}

TEST(LoaderView, ReadsTheFirstBackground) {
    EXPECT_EQ(load("<Scene/>").background, Background{});
    const Background background =
        load(bare("<Background skyColor='1 0 0, 0 1 0, 0 0 1' skyAngle='1, 2' "
                  "groundColor='0.1 0.2 0.3 0.4 0.5 0.6' groundAngle='1.5'/>"
                  "<Background skyColor='1 1 1'/>"))
            .background;
    EXPECT_EQ(background.sky_color, (std::vector<Color>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(background.sky_angle, (std::vector<double>{1, 2}));
    EXPECT_EQ(background.ground_color, (std::vector<Color>{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}}));
    EXPECT_EQ(background.ground_angle, std::vector<double>{1.5});
}

TEST(LoaderView, ATextureBackgroundHasItsColors) {
    const Scene scene =
        load(bare("<TextureBackground skyColor='0 0 1 1 1 1' skyAngle='1' groundColor='0 1 0'>"
                  "<ImageTexture containerField='frontTexture' url='a.png'/></TextureBackground>"
                  "<Background skyColor='1 0 0'/>"));
    EXPECT_EQ(scene.background.sky_color, (std::vector<Color>{{0, 0, 1}, {1, 1, 1}}));
    EXPECT_EQ(scene.background.sky_angle, std::vector<double>{1});
    EXPECT_EQ(scene.background.ground_color, (std::vector<Color>{{0, 1, 0}}));
    EXPECT_EQ(scene.warnings, Strings{"ImageTexture: 1 not drawn (first at Scene/TextureBackground/"
                                      "ImageTexture, line 1)"});
}

// 19775-1, 24.4.1: translations and scales of its ancestors have no effect, rotations have.
TEST(LoaderView, BackgroundsAreTurnedByTheirAncestors) {
    const auto zenith = [](const std::string& outer, const std::string& inner) {
        const Scene scene = load(bare("<Transform " + outer + "><Transform " + inner +
                                      "><Background/></Transform></Transform>"));
        EXPECT_TRUE(scene.warnings.empty());
        return scene.background.zenith;
    };
    const std::string quarter = " 1.5707963267948966'";
    EXPECT_EQ(zenith("translation='1 2 3'", "scale='1 -2 0' center='1 1 1'"), (Vector3{0, 1, 0}));
    expect_near(zenith("scale='1 5 1'", "rotation='1 0 0" + quarter), {0, 0, 1});
    // The inner one first: about z to -1 0 0, and from there about y.
    expect_near(zenith("rotation='0 1 0" + quarter, "rotation='0 0 1" + quarter), {0, 0, 1});
}

TEST(LoaderView, BackgroundAnglesAreMadeToFitTheirColors) {
    const Scene scene =
        load(bare("<Background skyColor='1 0 0 0 1 0 0 0 1' skyAngle='2 1 3 9' "
                  "groundColor='1 1 1 0 0 0' frontUrl='a.png'/>"));
    EXPECT_EQ(scene.background.sky_angle, (std::vector<double>{2, 2}));
    EXPECT_EQ(scene.background.ground_color, (std::vector<Color>{{1, 1, 1}}));
    EXPECT_EQ(scene.warnings.size(), 5u);  // clamped, too many, decreasing; too few; picture
}

// SFFloat is single precision: the floats nearest to pi and pi / 2 are above them.
TEST(LoaderView, AnglesOfALimitRoundedAreTheLimit) {
    for (const double digits : {1e4, 1e6, 1e7, 0.0}) {
        const auto rounded = [digits](double angle) {
            return digits > 0 ? std::ceil(angle * digits) / digits
                              : static_cast<double>(static_cast<float>(angle));
        };
        char nodes[400];
        std::snprintf(
            nodes, sizeof nodes,
            "<Background skyColor='0 0 0 1 1 1' skyAngle='%.17g' groundColor='0 0 0 1 1 1' "
            "groundAngle='%.17g'/><SpotLight cutOffAngle='%.17g'/>",
            rounded(M_PI), rounded(M_PI / 2), rounded(M_PI / 2));
        const Scene scene = load(bare(nodes + shape("<Sphere/>")));
        EXPECT_TRUE(scene.warnings.empty()) << digits << scene.warnings[0];
        EXPECT_EQ(scene.background.sky_angle.at(0), M_PI);
        EXPECT_EQ(scene.background.ground_angle.at(0), M_PI / 2);
        EXPECT_EQ(scene.lights.at(0).cut_off_angle, M_PI / 2);
    }
    EXPECT_EQ(load(bare("<SpotLight cutOffAngle='1.571'/>" + shape("<Sphere/>"))).warnings.size(),
              1u);
}

TEST(LoaderWarnings, NameEachKindOnceWithItsCountAndFirstPlace) {
    const Scene scene = load(
        bare("<Group/><Group><Shape><Text/></Shape></Group><Shape><Text/></Shape><TimeSensor/>"
             "<Shape><Appearance><ImageTexture/><Material/></Appearance><Text/></Shape><ROUTE/>" +
             shape("<IndexedFaceSet coordIndex='0 1 2'><Coordinate point='0 0 0 1 0 0 0 1 0'/>"
                   "<Fog/></IndexedFaceSet>")));
    EXPECT_EQ(
        scene.warnings,
        (Strings{
            "Text: 3 not drawn (first at Scene/Group[2]/Shape/Text, line 1)",
            "TimeSensor: 1 not drawn (first at Scene/TimeSensor, line 1)",
            "ImageTexture: 1 not drawn (first at Scene/Shape[2]/Appearance/ImageTexture, line 1)",
            "ROUTE: 1 not drawn (first at Scene/ROUTE, line 1)",
            "Fog: 1 not drawn (first at Scene/Shape[3]/IndexedFaceSet/Fog, line 1)"}));
    EXPECT_EQ(scene.shape_count, 4u);
    EXPECT_EQ(scene.objects.at(0).shape_index, 3u);
}

TEST(LoaderWarnings, MisspeltNodesAreRefusedWithTheRightSpelling) {
    EXPECT_EQ(refusal(bare("<shape/>")),
              "scene.x3d: Scene/shape: no node of X3D, which spells it Shape (line 1)");
    EXPECT_EQ(refusal(bare("<Shape><SPHERE/></Shape>")),
              "scene.x3d: Scene/Shape/SPHERE: no node of X3D, which spells it Sphere (line 1)");
    EXPECT_EQ(refusal(bare(shape("<IndexedFaceset/>"))),
              "scene.x3d: Scene/Shape/IndexedFaceset: no node of X3D, which spells it "
              "IndexedFaceSet (line 1)");
    EXPECT_EQ(refusal(bare("<Shape><Appearance><material/></Appearance><Sphere/></Shape>")),
              "scene.x3d: Scene/Shape/Appearance/material: no node of X3D, which spells it "
              "Material (line 1)");
    EXPECT_EQ(refusal("<X3D><scene/></X3D>"),
              "scene.x3d: scene: no node of X3D, which spells it Scene (line 1)");
    EXPECT_EQ(refusal("<x3d/>"), "scene.x3d: x3d: no node of X3D, which spells it X3D (line 1)");
}

TEST(LoaderWarnings, AreSilentAboutWhatHasNothingToDraw) {
    EXPECT_TRUE(
        load(
            "<X3D version='3.3' profile='Immersive' unknown='1'><head><meta name='a'/><component/>"
            "</head><Scene><WorldInfo title='t'/><MetadataString/><ProtoDeclare><ProtoBody><Shape/>"
            "</ProtoBody></ProtoDeclare><Shape><MetadataSet/><Appearance><Material/></"
            "Appearance><IndexedFaceSet coordIndex='0 1 2' "
            "texCoordIndex='0 1 2'><Coordinate point='0 0 0 1 0 0 0 1 0'/><TextureCoordinate "
            "point='x'/></IndexedFaceSet></Shape></Scene></X3D>")
            .warnings.empty());
}

TEST(LoaderWarnings, AnUnreadableVersionCountsAsNone) {
    const Scene scene = load(versioned("three", "<SpotLight/>"));
    EXPECT_EQ(scene.lights.at(0).beam_width, 0.785398);
    EXPECT_EQ(scene.warnings,
              Strings{"X3D@version: 1 left out (first at X3D, line 1: \"three\" is no version)"});
}

TEST(LoaderWarnings, ManyKindsAreCutOff) {
    std::string nodes;
    for (int i = 0; i < 5000; ++i) nodes += "<n" + std::to_string(i) + "/>";
    const Strings warnings = load(bare(nodes)).warnings;
    ASSERT_EQ(warnings.size(), 101u);
    EXPECT_EQ(warnings.back(), "4900 more kinds of warnings");
}

TEST(LoaderGroups, GroupingNodesDrawTheirChildren) {
    for (const char* kind : {"Group", "StaticGroup", "Anchor", "Billboard", "Collision"}) {
        const std::string name = kind;
        EXPECT_EQ(
            load(bare("<" + name + "><Shape><Sphere/></Shape></" + name + ">")).objects.size(), 1u)
            << name;
    }
}

// Thesis appendix F as printed, with its colour broken over two lines.
TEST(LoaderThesis, AppendixFLoads) {
    const Scene scene = load(
        "<Scene>\n"
        "  <Viewpoint position='0 0 10' />\n"
        "  <Background groundColor=\"0.43 0.54 0.72\"\n"
        "    skyColor=\"0.9 0.74 0.9\" />\n"
        "  <SpotLight direction='0 0 -1' location='0 0 10' cutOffAngle='0.3' color='1 1\n"
        "    1' beamWidth='0.1' />\n"
        "  <Transform translation='0 0 0'>\n"
        "    <Shape>\n"
        "      <Sphere radius='4' />\n"
        "      <Appearance>\n"
        "        <Material diffuseColor='1.0 0 0' />\n"
        "      </Appearance>\n"
        "    </Shape>\n"
        "  </Transform>\n"
        "</Scene>\n");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.camera.position, (Point3{0, 0, 10}));
    EXPECT_EQ(scene.background.sky_color, (std::vector<Color>{{0.9, 0.74, 0.9}}));
    EXPECT_EQ(scene.background.ground_color, (std::vector<Color>{{0.43, 0.54, 0.72}}));
    ASSERT_EQ(scene.lights.size(), 1u);  // no headlight
    EXPECT_EQ(scene.lights[0].color, (Color{1, 1, 1}));
    EXPECT_EQ(scene.lights[0].cut_off_angle, 0.3);
    EXPECT_EQ(scene.lights[0].beam_width, 0.1);
    EXPECT_EQ(scene.lights[0].location, (Point3{0, 0, 10}));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 4);
    EXPECT_EQ(scene.materials.at(0).diffuse_color, (Color{1, 0, 0}));
}

}  // namespace
}  // namespace nuvo
