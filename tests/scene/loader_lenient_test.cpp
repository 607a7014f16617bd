// What cannot be read is left out and named; the rest of the scene is drawn.
#include "scene/loading.h"

namespace nuvo {
namespace {

using Strings = std::vector<std::string>;

const std::string kBall = shape("<Sphere radius='2'/>");
const std::string kSquare = "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0'/>";

/// The one warning about `nodes`, beside which a ball is drawn; strictly they are refused.
std::string warning_of(const std::string& nodes, std::size_t others_drawn = 0) {
    const Scene scene = load(bare(kBall + nodes));
    EXPECT_EQ(scene.objects.size(), 1 + others_drawn) << nodes;
    EXPECT_EQ(scene.warnings.size(), 1u) << nodes;
    EXPECT_NE(refusal(bare(kBall + nodes)), "") << nodes;
    return scene.warnings.empty() ? "" : scene.warnings[0];
}

TEST(LoaderLenient, AShapeWithABadIndexIsLeftOut) {
    EXPECT_EQ(warning_of(shape("\n<IndexedFaceSet coordIndex='0 1 9 -1'>" + kSquare +
                               "</IndexedFaceSet>")),
              "Shape: 1 left out (first at Scene/Shape[2]/IndexedFaceSet@coordIndex, line 2: "
              "entry 2: index 9 of 4 points)");
    warning_of(shape("<IndexedTriangleSet index='0 1 -1'>" + kSquare + "</IndexedTriangleSet>"));
    warning_of(shape("<IndexedTriangleStripSet index='0 1 2 7 -1'>" + kSquare +
                     "</IndexedTriangleStripSet>"));
    warning_of(shape("<TriangleFanSet fanCount='5'>" + kSquare + "</TriangleFanSet>"));
    warning_of(shape("<IndexedTriangleSet index='0 1 2'><Coordinate/></IndexedTriangleSet>"));
    warning_of(
        shape("<IndexedTriangleSet index='0 1 2'><Coordinate USE=''/></IndexedTriangleSet>"));
    warning_of(shape("<ElevationGrid xDimension='4' zDimension='4'/>"));
    warning_of(shape("<ElevationGrid xDimension='4' zDimension='4' height='0 1 2'/>"));
    warning_of(shape("<Sphere radius='-1'/>"));
    warning_of(shape("<Box size='1 -1 1'/>"));
}

TEST(LoaderLenient, NormalsAndColorsThatDoNotSuitAreLeftOut) {
    const auto face = [](const std::string& fields, const std::string& nodes) {
        return shape("<IndexedFaceSet coordIndex='0 1 2 3 -1' " + fields + ">" + kSquare + nodes +
                     "</IndexedFaceSet>");
    };
    EXPECT_EQ(warning_of(face("", "<Color color='1 0 0'/>"), 1),
              "Color: 1 left out (first at Scene/Shape[2]/IndexedFaceSet@color, line 1: entry 1: "
              "index 1 of 1 colors)");
    warning_of(face("", "<Normal vector='0 0 1'/>"), 1);
    warning_of(face("normalIndex='0 0 0 -1 -1'", "<Normal vector='0 0 1'/>"), 1);
    warning_of(face("colorIndex='0 1 2 3 -1'", "<Color color='1 0 0 0 1 0'/>"), 1);
    warning_of(face("colorPerVertex='false' colorIndex='1'", "<Color color='1 0 0'/>"), 1);
    const Scene scene = load(bare(face("", "<Color color='1 0 0'/><Normal vector='0 0 1'/>")));
    EXPECT_TRUE(mesh_of(scene).colors.empty());
    EXPECT_TRUE(mesh_of(scene).normals.empty());
    warning_of(shape("<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0'/><Color color='1 1 1'/>"
                     "</TriangleSet>"),
               1);
}

TEST(LoaderLenient, AnIndexPerFaceMayHaveMinusOneBetweenItsEntries) {
    const std::string faces = shape(
        "<IndexedFaceSet coordIndex='0 1 2 -1 0 2 3 -1' normalPerVertex='false' "
        "normalIndex='0 -1 1 -1' colorPerVertex='false' colorIndex='1 -1 0 -1'>" +
        kSquare +
        "<Normal vector='0 0 1 0 1 0'/><Color color='1 0 0 0 1 0'/>"
        "</IndexedFaceSet>");
    const Scene scene = load(bare(faces));
    const TriangleMesh& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.normal_triangles.size(), 2u);
    EXPECT_EQ(mesh.normals.at(mesh.normal_triangles[0][0]), (Vector3{0, 0, 1}));
    EXPECT_EQ(mesh.normals.at(mesh.normal_triangles[1][0]), (Vector3{0, 1, 0}));
    EXPECT_EQ(mesh.colors.at(mesh.color_triangles[0][0]), (Color{0, 1, 0}));
    EXPECT_EQ(mesh.colors.at(mesh.color_triangles[1][0]), (Color{1, 0, 0}));
    EXPECT_EQ(scene.warnings.size(), 2u);
    EXPECT_NE(refusal(bare(faces)), "");
}

TEST(LoaderLenient, AFieldThatCannotBeReadHasItsDefault) {
    const Scene scene = load(bare(
        "<Transform scale='' translation='1 2' rotation='x'><Shape><Appearance>"
        "<Material diffuseColor='' shininess='1e400' emissiveColor='0 1 0'/></Appearance>"
        "<Sphere radius='nan' solid='maybe'/></Shape></Transform><Switch whichChoice='0 1'/>"));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 1);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).center, (Point3{0, 0, 0}));
    EXPECT_EQ(scene.materials[0].diffuse_color, Material{}.diffuse_color);
    EXPECT_EQ(scene.materials[0].shininess, 0.2);
    EXPECT_EQ(scene.materials[0].emissive_color, (Color{0, 1, 0}));
    EXPECT_EQ(scene.warnings.size(), 8u);
    for (const std::string& warning : scene.warnings)
        EXPECT_NE(warning.find("@"), std::string::npos) << warning;
    EXPECT_EQ(load(bare("<Viewpoint fieldOfView='7' position='0 0 3'/>")).camera.position.z, 3);
    EXPECT_EQ(load(bare("<Viewpoint fieldOfView='7'/>")).camera.field_of_view_rad,
              Camera{}.field_of_view_rad);
    EXPECT_EQ(load(bare("<PointLight radius='-1'/>" + kBall)).lights.at(0).radius, 100);
}

TEST(LoaderLenient, TruthValuesMayBePythons) {
    EXPECT_FALSE(load(bare(shape("<Sphere solid='False'/>"))).objects.at(0).solid);
    EXPECT_TRUE(load(bare(shape("<Rectangle2D solid='True'/>"))).objects.at(0).solid);
    EXPECT_NE(refusal(bare(shape("<Sphere solid='False'/>"))), "");
}

TEST(LoaderLenient, ListsOfWrongLengthLoseTheirIncompleteEnd) {
    EXPECT_EQ(load(bare(shape("<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0 5'/>"
                              "</TriangleSet>")))
                  .objects.size(),
              1u);
    EXPECT_EQ(load(bare(shape("<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0'/>"
                              "<ColorRGBA color='1 0 0 1 0 1 0 1 0 0 1 1 0.5'/></TriangleSet>")))
                  .warnings.size(),
              1u);
}

TEST(LoaderLenient, UseOfNothingIsLeftOut) {
    EXPECT_EQ(warning_of("<Shape USE='x'/>"),
              "Shape: 1 left out (first at Scene/Shape[2], line 1: USE=\"x\" names no DEF)");
    warning_of("<Transform translation='9 0 0'><Group USE='x'/></Transform>");
    EXPECT_EQ(load(bare("<Shape><Sphere USE='x'/></Shape>")).objects.size(), 0u);
    // Without its Material a Shape is unlit white, not a Material of defaults.
    EXPECT_FALSE(load(bare("<Shape><Appearance><Material USE='x'/></Appearance><Sphere/></Shape>"))
                     .materials.at(0)
                     .lit);
}

TEST(LoaderLenient, UseBeforeItsDefinitionNamesTheLaterOne) {
    const std::string nodes =
        "<Transform translation='9 0 0'><Shape USE='s'/></Transform>"
        "<Shape DEF='s'><Appearance><Material/></Appearance><Sphere/></Shape>";
    const Scene scene = load(bare(nodes));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).center, (Point3{9, 0, 0}));
    EXPECT_EQ(scene.warnings,
              Strings{"Shape@USE: 1 coming before its DEF (first at Scene/Transform/Shape, "
                      "line 1)"});
    EXPECT_NE(refusal(bare(nodes)), "");
    // Not round and round.
    for (const char* cycle :
         {"<Group DEF='a'><Group USE='b'/></Group><Group DEF='b'><Group USE='a'/></Group>",
          "<Group DEF='a'><Transform><Group USE='a'/></Transform></Group>"})
        EXPECT_THROW(load(bare(cycle)), x3d::Error) << cycle;
}

TEST(LoaderLenient, UseOfAnotherKindDrawsWhatItNames) {
    const std::string nodes = "<Group DEF='door'>" + kBall +
                              "</Group>"
                              "<Transform translation='9 0 0'><Shape USE='door'/></Transform>";
    const Scene scene = load(bare(nodes));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[1].shape).center, (Point3{9, 0, 0}));
    EXPECT_EQ(scene.shape_count, 2u);
    EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(LoaderLenient, UseMeansTheLatestNodeOfItsKind) {
    const auto material = [](const std::string& name, const std::string& color) {
        return "<Material DEF='" + name + "' diffuseColor='" + color + "'/>";
    };
    const std::string nodes = "<Shape><Appearance DEF='a'>" + material("a", "1 0 0") +
                              "</Appearance><Box/></Shape>"
                              "<Shape><Appearance USE='a'/><Sphere/></Shape>"
                              "<Shape><Appearance><Material USE='a'/></Appearance><Cone/></Shape>"
                              "<Shape><Appearance DEF='a'>" +
                              material("b", "0 1 0") +
                              "</Appearance><Cylinder/></Shape>"
                              "<Shape><Appearance USE='a'/><Disk2D/></Shape>"
                              "<Shape><Appearance><Material USE='a'/></Appearance><Rectangle2D/>"
                              "</Shape>";
    const Scene scene = load(bare(nodes));
    EXPECT_EQ(scene.warnings, Strings{});
    EXPECT_EQ(refusal(bare(nodes)), "");
    ASSERT_EQ(scene.objects.size(), 6u);
    const Color red{1, 0, 0}, green{0, 1, 0};
    const Color expected[] = {red, red, red, green, green, red};
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(scene.materials.at(scene.objects[i].material).diffuse_color, expected[i]) << i;
}

// 19775-1, 12.4.5: a Shape holds one Appearance and one X3DGeometryNode.
TEST(LoaderLenient, WhatIsNoGeometryDoesNotTakeItsPlace) {
    for (const char* stray : {"Material", "ImageTexture", "H3DExtension", "TouchSensor",
                              "PointLight", "Coordinate", "Transform", "Shape", "Sound"}) {
        const Scene scene =
            load(bare("<Shape>\n<" + std::string(stray) +
                      "/><Box/><Appearance><Material diffuseColor='1 0 0'/></Appearance></Shape>"));
        ASSERT_EQ(scene.objects.size(), 1u) << stray;
        EXPECT_EQ(scene.objects[0].shape_index, 0u) << stray;
        EXPECT_EQ(scene.materials.at(scene.objects[0].material).diffuse_color, (Color{1, 0, 0}));
        EXPECT_EQ(scene.warnings, Strings{std::string(stray) + ": 1 not drawn (first at Scene/" +
                                          "Shape/" + stray + ", line 2)"})
            << stray;
    }
    // A USE of another kind is no geometry, either; its own place is told.
    const Scene scene =
        load(bare("<Shape><Appearance><Material DEF='m'/></Appearance><Sphere/>"
                  "</Shape><Shape>\n<Box USE='m'/><Cone/></Shape>"));
    EXPECT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.warnings.at(1), "Material: 1 not drawn (first at Scene/Shape[2]/Box, line 2)");
    // Text is geometry, though it is not drawn.
    EXPECT_EQ(load(bare("<Shape><Text/><Box/></Shape>")).warnings,
              (Strings{"Box: 1 beyond the first of its Shape left out (first at Scene/Shape/Box, "
                       "line 1)",
                       "Text: 1 not drawn (first at Scene/Shape/Text, line 1)"}));
}

TEST(LoaderLenient, ScriptsAndSensorsMayReferToAnything) {
    for (const char* field : {"<Group USE='nothing'/>", "<Transform USE='t'/>", "<Script USE='s'/>",
                              "<Shape USE='late'/>", "<Material USE='t'/>"}) {
        const std::string script =
            "<Script DEF='s'><field name='f' type='SFNode' accessType='inputOutput'>" +
            std::string(field) + "</field></Script>";
        const Scene scene = load(bare("<Transform DEF='t'>" + kBall + script +
                                      "</Transform>"
                                      "<Transform translation='9 0 0'><Shape DEF='late'><Sphere/>"
                                      "<Appearance><Material/></Appearance>"
                                      "</Shape></Transform>"));
        EXPECT_EQ(scene.objects.size(), 2u) << field;
        EXPECT_EQ(scene.warnings,
                  Strings{"Script: 1 not drawn (first at Scene/Transform[1]/Script, line 1)"})
            << field;
    }
    EXPECT_EQ(load(bare("<Group DEF='g'>" + kBall +
                        "<TransformSensor><Group USE='g' containerField='targetObject'/>"
                        "</TransformSensor></Group>"))
                  .objects.size(),
              1u);
    // What a Script defines can be used elsewhere.
    EXPECT_EQ(load(bare("<Script><field name='f' type='SFNode' accessType='inputOutput'>"
                        "<Shape DEF='b'><Sphere/></Shape></field></Script><Shape USE='b'/>"))
                  .objects.size(),
              1u);
}

TEST(LoaderLenient, NamesInTheWrongCaseAreReadAsWhatTheyMean) {
    const Scene scene = load(
        "<x3d Version='3.3'><scene>\n<transform Translation='1 2 3' def='t'><SHAPE><appearance>"
        "<material diffusecolor='1 0 0'/></appearance><sphere Radius='4'/></SHAPE></transform>"
        "<group><transform use='t'/><Transform translation='9 9 9'><Transform USE='t'/>"
        "</Transform></group></scene></x3d>");
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 4);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).center, (Point3{1, 2, 3}));
    EXPECT_EQ(scene.materials[0].diffuse_color, (Color{1, 0, 0}));
    EXPECT_EQ(scene.warnings.at(0), "x3d: 1 read as X3D (first at X3D, line 1)");
    EXPECT_EQ(scene.warnings.at(3),
              "transform: 2 read as Transform (first at Scene/Transform, line 2)");
    EXPECT_EQ(scene.warnings.at(4),
              "Transform@Translation: 1 read as translation (first at Scene/Transform, line 2)");
    EXPECT_EQ(refusal("<x3d><Scene/></x3d>"),
              "scene.x3d: x3d: no node of X3D, which spells it X3D (line 1)");
    EXPECT_NE(refusal(bare("<Shape><sphere/></Shape>")), "");
}

TEST(LoaderLenient, NearlyRightFieldsAreAskedAfter) {
    const Scene scene = load(bare(shape("<Sphere raduis='3'/>") +
                                  "<Transform tranlsation='1 0 0' foo='1' "
                                  "data-x='y' onclick='z'/><Material difuseColor='1 0 0'/>"));
    EXPECT_EQ(scene.warnings,
              (Strings{"Sphere@raduis: 1 left out, as there is no such field: did you mean radius? "
                       "(first at Scene/Shape/Sphere, line 1)",
                       "Transform@tranlsation: 1 left out, as there is no such field: did you mean "
                       "translation? (first at Scene/Transform, line 1)",
                       "Material@difuseColor: 1 left out, as there is no such field: did you mean "
                       "diffuseColor? (first at Scene/Material, line 1)",
                       "Material: 1 not drawn (first at Scene/Material, line 1)"}));
    EXPECT_EQ(refusal(bare(shape("<Sphere raduis='3'/>"))),
              "scene.x3d: Scene/Shape/Sphere@raduis: there is no such field: did you mean radius? "
              "(line 1)");
    EXPECT_EQ(refusal(bare(shape("<Sphere Radius='3'/>"))),
              "scene.x3d: Scene/Shape/Sphere@Radius: there is no such field: did you mean radius? "
              "(line 1)");
}

TEST(LoaderLenient, StrictReadingRefusesWhateverIsLeftOut) {
    EXPECT_EQ(
        refusal(bare("<ProtoInstance name='no'/>")),
        "scene.x3d: Scene/ProtoInstance: no prototype of the name \"no\" can be read (line 1)");
    EXPECT_EQ(refusal(bare("<ProtoDeclare name='e'><ProtoBody/></ProtoDeclare>"
                           "<ProtoInstance name='e'/>")),
              "scene.x3d: Scene/ProtoInstance: the prototype \"e\" has no node (line 1)");
    EXPECT_EQ(refusal("<X3D version='new'><Scene/></X3D>"),
              "scene.x3d: X3D@version: \"new\" is no version (line 1)");
    EXPECT_EQ(refusal(bare("<Inline url='a.x3d'/>")),
              "scene.x3d: Scene/Inline@url: \"a.x3d\" is not looked for: only a scene in a file "
              "has a folder (line 1)");
    EXPECT_EQ(refusal(bare("<Shape><Box/><Sphere/></Shape>")),
              "scene.x3d: Scene/Shape/Sphere: is beyond the first of its Shape (line 1)");
}

TEST(LoaderLenient, FilesOfOtherFormatsAreNamed) {
    EXPECT_EQ(refusal("#VRML V2.0 utf8\nShape {}"),
              "scene.x3d: is VRML 97, not X3D in XML: convert it by tovrmlx3d --encoding xml");
    EXPECT_NE(refusal("#VRML V1.0 ascii\n").find("VRML 1.0"), std::string::npos);
    EXPECT_NE(refusal("#X3D V3.0 utf8\n").find("classic"), std::string::npos);
    EXPECT_NE(refusal("\xef\xbb\xbf \n{ \"X3D\": {} }").find("JSON"), std::string::npos);
    EXPECT_NE(refusal("<!DOCTYPE html><html/>").find("html page"), std::string::npos);
    EXPECT_EQ(refusal("solid cube\nfacet normal 0 0 1\n"),
              "scene.x3d: is STL, not X3D in XML: save it as X3D");
    EXPECT_NE(refusal("ply\nformat ascii 1.0\n").find("is PLY"), std::string::npos);
    EXPECT_NE(refusal("# a cube\n\n#\nmtllib a.mtl\nv 0 0 0\n").find("is OBJ"), std::string::npos);
    EXPECT_NE(refusal("v 0 0 0\nv 1 0 0\n").find("is OBJ"), std::string::npos);
    EXPECT_NE(refusal("\x89PNG\r\n").find("is a PNG picture"), std::string::npos);
    const std::string header(80, ' ');
    EXPECT_NE(
        refusal(header + std::string("\2\0\0\0", 4) + std::string(100, '\0')).find("is binary STL"),
        std::string::npos);
    EXPECT_NE(refusal("# nothing else").find("text before the root"), std::string::npos);
}

}  // namespace
}  // namespace nuvo
