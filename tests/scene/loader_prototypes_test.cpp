// ProtoDeclare, ProtoInstance, ExternProtoDeclare (ISO/IEC 19775-1 clause 4.4.4, 19776-1 4.3).
#include <filesystem>

#include "scene/loading.h"
#include "scene/temporary_folder.h"

namespace nuvo {
namespace {

using Strings = std::vector<std::string>;
using Radii = std::vector<double>;

std::string declaration(const std::string& name, const std::string& fields,
                        const std::string& body) {
    return "<ProtoDeclare name='" + name + "'><ProtoInterface>" + fields +
           "</ProtoInterface><ProtoBody>" + body + "</ProtoBody></ProtoDeclare>";
}
std::string instance(const std::string& name, const std::string& values = "") {
    return "<ProtoInstance name='" + name + "'>" + values + "</ProtoInstance>";
}
std::string is(const std::string& node_field, const std::string& field) {
    return "<IS><connect nodeField='" + node_field + "' protoField='" + field + "'/></IS>";
}
const std::string kRadius = "<field name='r' type='SFFloat' accessType='inputOutput' value='3'/>";
const std::string kBall =
    declaration("Ball", kRadius, shape("<Sphere radius='7'>" + is("radius", "r") + "</Sphere>"));

Radii radii(const Scene& scene) {
    Radii result;
    for (const Object& object : scene.objects)
        result.push_back(std::get<Sphere>(object.shape).radius);
    return result;
}
Radii radii(const std::string& nodes) { return radii(load(bare(nodes))); }

TEST(LoaderPrototypes, FieldsHaveTheInstancesValueOrElseTheDefault) {
    EXPECT_EQ(
        radii(kBall + instance("Ball", "<fieldValue name='r' value='5'/>") + instance("Ball")),
        (Radii{5, 3}));
    // A field without any value leaves the node's own.
    EXPECT_EQ(radii(declaration("B", "<field name='r' type='SFFloat' accessType='inputOnly'/>",
                                shape("<Sphere radius='7'>" + is("radius", "r") + "</Sphere>")) +
                    instance("B")),
              Radii{7});
    EXPECT_TRUE(load(bare(kBall)).objects.empty());
}

TEST(LoaderPrototypes, FieldsThatThereAreNotAreAskedAfter) {
    const std::string field =
        "<field name='color' type='SFColor' accessType='inputOutput' "
        "value='0 1 0'/>";
    const auto tint = [&](const std::string& node_field) {
        return declaration("Tint", field,
                           "\n<Shape><Appearance><Material diffuseColor='0 0 1'>" +
                               is(node_field, "color") +
                               "</Material></Appearance><Sphere/></Shape>");
    };
    const auto given = [](const std::string& name) {
        return "\n" + instance("Tint", "<fieldValue name='" + name + "' value='1 0 0'/>");
    };
    const Scene scene = load(bare(tint("difuseColor") + given("colour") + given("color") +
                                  given("colour") + given("other")));
    EXPECT_EQ(scene.materials.at(0).diffuse_color, (Color{0, 0, 1}));
    ASSERT_EQ(scene.warnings.size(), 4u);  // the last: the balls have one place
    EXPECT_EQ(
        Strings(scene.warnings.begin(), scene.warnings.end() - 1),
        (Strings{"Material@difuseColor: 1 left out, as there is no such field: did you mean "
                 "diffuseColor? (first at Scene/ProtoDeclare/ProtoBody/Shape/Appearance/Material/"
                 "IS/connect, line 2)",
                 "Tint@colour: 2 left out, as there is no such field: did you mean color? (first "
                 "at Scene/ProtoInstance[1]/fieldValue, line 3)",
                 "Tint@other: 1 left out, as there is no such field (first at "
                 "Scene/ProtoInstance[4]/fieldValue, line 6)"}));
    EXPECT_EQ(load(bare(tint("diffuseColor") + given("colour"))).materials.at(0).diffuse_color,
              (Color{0, 1, 0}));
    EXPECT_EQ(refusal(bare(tint("diffuseColor") + given("colour"))),
              "scene.x3d: Scene/ProtoInstance/fieldValue@colour: there is no such field: did you "
              "mean color? (line 3)");
    EXPECT_NE(refusal(bare(tint("difuseColor"))), "");
}

TEST(LoaderPrototypes, AnInstanceStandsForAnyKindOfNode) {
    const Scene scene = load(
        bare(declaration("Red",
                         "<field name='c' type='SFColor' accessType='inputOutput' value='1 0 0'/>",
                         "<Material>" + is("diffuseColor", "c") + "</Material>") +
             declaration("Look", "", "<Appearance>" + instance("Red") + "</Appearance>") +
             declaration("Round", "", "<Sphere radius='4'/>") +
             declaration("Points", "", "<Coordinate point='0 0 0 1 0 0 0 1 0'/>") + "<Shape>" +
             instance("Look") + instance("Round") + "</Shape><Shape><Appearance>" +
             instance("Red", "<fieldValue name='c' value='0 1 0'/>") +
             "</Appearance><TriangleSet>" + instance("Points") + "</TriangleSet></Shape>"));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 4);
    EXPECT_EQ(scene.materials.at(scene.objects[0].material).diffuse_color, (Color{1, 0, 0}));
    EXPECT_EQ(scene.materials.at(scene.objects[1].material).diffuse_color, (Color{0, 1, 0}));
    EXPECT_EQ(mesh_of(scene, 1).triangles.size(), 1u);
    EXPECT_EQ(scene.warnings, Strings{});
}

TEST(LoaderPrototypes, FieldsMayBeNodes) {
    const std::string frame =
        declaration("Frame",
                    "<field name='content' type='MFNode' accessType='inputOutput'>" +
                        shape("<Sphere/>") + "</field>",
                    "<Transform translation='5 0 0'>" + is("children", "content") + "</Transform>");
    const std::string two = shape("<Sphere DEF='s' radius='2'/>") + shape("<Sphere radius='6'/>");
    const Scene scene =
        load(bare(frame + instance("Frame", "<fieldValue name='content'>" + two + "</fieldValue>") +
                  instance("Frame") + shape("<Sphere USE='s'/>")));
    EXPECT_EQ(radii(scene), (Radii{2, 6, 1, 2}));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).center, (Point3{5, 0, 0}));
    EXPECT_EQ(std::get<Sphere>(scene.objects[3].shape).center, (Point3{0, 0, 0}));
    EXPECT_EQ(scene.shape_count, 4u);
    // A node that is USEd from outside.
    EXPECT_EQ(radii("<Shape DEF='b'><Sphere radius='9'/></Shape>" + frame +
                    instance("Frame", "<fieldValue name='content'><Shape USE='b'/></fieldValue>")),
              (Radii{9, 9}));
}

TEST(LoaderPrototypes, InstancesInsideBodiesPassFieldsOn) {
    const std::string pair = declaration(
        "Pair", "<field name='size' type='SFFloat' accessType='inputOutput' value='8'/>",
        "<Group><ProtoInstance name='Ball'>" + is("r", "size") +
            "</ProtoInstance><Transform translation='9 0 0'>" +
            instance("Ball", "<fieldValue name='r' value='4'/>") + "</Transform></Group>");
    EXPECT_EQ(radii(kBall + pair + instance("Pair") +
                    instance("Pair", "<fieldValue name='size' value='6'/>")),
              (Radii{8, 4, 6}));  // the last ball is where an earlier one is
    // Declared inside the body, after a metadata node; the body's other nodes are not drawn.
    EXPECT_EQ(radii(declaration("Outer", "",
                                kBall + "<MetadataString/><Group>" + instance("Ball") + "</Group>" +
                                    shape("<Sphere radius='99'/>")) +
                    instance("Outer")),
              Radii{3});
}

TEST(LoaderPrototypes, NamesInsideABodyAreItsOwn) {
    const std::string twice =
        declaration("Twice", kRadius,
                    "<Group>" + shape("<Sphere DEF='s'>" + is("radius", "r") + "</Sphere>") +
                        "<Transform translation='9 0 0'>" + shape("<Sphere USE='s'/>") +
                        "</Transform></Group>");
    const Scene scene = load(
        bare(twice + shape("<Sphere DEF='s' radius='20'/>") + instance("Twice") +
             instance("Twice", "<fieldValue name='r' value='4'/>") +
             "<Transform translation='50 0 0'>" + shape("<Sphere USE='s'/>") + "</Transform>"));
    EXPECT_EQ(radii(scene), (Radii{20, 3, 3, 4, 4, 20}));
}

TEST(LoaderPrototypes, InstancesCanBeNamedAndUsed) {
    EXPECT_EQ(radii(kBall + "<ProtoInstance name='Ball' DEF='i'><fieldValue name='r' value='2'/>"
                            "</ProtoInstance><Transform translation='9 0 0'>"
                            "<ProtoInstance USE='i'/></Transform><Transform translation='18 0 0'>"
                            "<Shape USE='i'/></Transform>"),
              (Radii{2, 2, 2}));
}

TEST(LoaderPrototypes, WhatIsNotDeclaredIsLeftOutWithAWarning) {
    const Scene scene = load(bare(instance("Nothing") + declaration("Empty", "", "") +
                                  instance("Empty") + shape("<Sphere/>")));
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.warnings,
              Strings{"ProtoInstance: 2 left out (first at Scene/ProtoInstance[1], line 1: no "
                      "prototype of the name \"Nothing\" can be read)"});
}

TEST(LoaderPrototypes, OneInsideItselfIsRefused) {
    EXPECT_EQ(refusal(bare(declaration("P", "", "<Group>\n" + instance("P") + "</Group>") +
                           instance("P"))),
              "scene.x3d: Scene/ProtoInstance/Group/ProtoInstance: the prototype \"P\" is inside "
              "its own declaration (line 2)");
    const std::string both = declaration("A", "", "<Group>" + instance("B") + "</Group>") +
                             declaration("B", "", "<Group>" + instance("A") + "</Group>");
    EXPECT_NE(refusal(bare(both + instance("A"))).find("inside its own declaration"),
              std::string::npos);
    EXPECT_EQ(refusal(bare(both)), "");  // never made
    // By way of a field: the group that holds the instance.
    EXPECT_NE(
        refusal(bare(declaration("F", "<field name='c' type='MFNode' accessType='inputOutput'/>",
                                 "<Group>" + is("children", "c") + "</Group>") +
                     "<Group DEF='g'>" +
                     instance("F", "<fieldValue name='c'><Group USE='g'/></fieldValue>") +
                     "</Group>"))
            .find("is inside itself, by way of a prototype's field"),
        std::string::npos);
}

TEST(LoaderPrototypes, ExponentialExpansionIsCountedByTheLimits) {
    std::string nodes = declaration("P0", "", shape("<Sphere/>"));
    for (int i = 1; i <= 40; ++i) {
        const std::string inner = instance("P" + std::to_string(i - 1));
        nodes += declaration("P" + std::to_string(i), "", "<Group>" + inner + inner + "</Group>");
    }
    x3d::Limits limits;
    limits.elements = 20'000;
    EXPECT_NE(refusal(bare(nodes + instance("P40")), limits)
                  .find("prototypes make the scene exceed the limit of 20000 elements (line 1)"),
              std::string::npos);
    EXPECT_EQ(load(bare(nodes + instance("P6"))).shape_count, 64u);
    // A thousand attributes each time.
    std::string many = "<Group";
    for (int i = 0; i < 1000; ++i) many += " a" + std::to_string(i) + "='1'";
    many += ">" + is("visible", "v") + "</Group>";
    limits = {};
    limits.attributes = 100'000;
    const std::string wide = declaration(
        "W", "<field name='v' type='SFBool' accessType='inputOutput' value='true'/>", many);
    EXPECT_NE(refusal(bare(wide + repeated(instance("W"), 200)), limits).find("attributes"),
              std::string::npos);
}

class LoaderExternPrototypes : public testing::Test {
  protected:
    Scene load_main(const std::string& nodes) const {
        return x3d::read_file(folder_.put("main.x3d", bare(nodes)));
    }
    static std::string extern_of(const std::string& url) {
        return "<ExternProtoDeclare name='Ball' url='" + url + "'>" + kRadius +
               "</ExternProtoDeclare>" + instance("Ball", "<fieldValue name='r' value='2'/>");
    }
    TemporaryFolder folder_;
};

TEST_F(LoaderExternPrototypes, AreReadFromTheScenesFolder) {
    folder_.put("lib/parts.x3d", bare(declaration("Other", "", shape("<Sphere radius='50'/>")) +
                                      kBall + shape("<Sphere radius='99'/>")));
    EXPECT_EQ(radii(load_main(extern_of("\"http://example.org/x.x3d#Ball\" "
                                        "\"lib/parts.x3d#Ball\""))),
              Radii{2});
    EXPECT_EQ(radii(load_main(extern_of("lib/parts.x3d"))), Radii{50});  // without a name the first
    EXPECT_EQ(radii(load_main(extern_of("lib%2Fparts.x3d#%4fther"))), Radii{50});
    const Scene nothing = load_main(extern_of("lib/parts.x3d#Nothing"));
    EXPECT_EQ(nothing.objects.size(), 0u);
    EXPECT_EQ(nothing.warnings.at(0),
              "ExternProtoDeclare@url: 1 left out: \"lib/parts.x3d#Nothing\" names no prototype of "
              "its file (first at Scene/ExternProtoDeclare, line 1)");
    EXPECT_THROW(
        x3d::read_file(folder_.put("strict.x3d", bare(extern_of("no.x3d"))), {.strict = true}),
        x3d::Error);
    const Scene outside = load_main(extern_of("../parts.x3d#Ball"));
    EXPECT_EQ(outside.objects.size(), 0u);
    EXPECT_EQ(outside.warnings.at(0),
              "ExternProtoDeclare@url: 1 left out: \"../parts.x3d#Ball\" leads out of the scene's "
              "folder (first at Scene/ExternProtoDeclare, line 1)");
    EXPECT_EQ(outside.warnings.size(), 2u);
}

TEST_F(LoaderExternPrototypes, MayLeadFromFileToFileButNotRoundAndRound) {
    folder_.put("a.x3d", bare("<ExternProtoDeclare name='Ball' url='b.x3d#Ball'/>"));
    folder_.put("b.x3d", bare(kBall));
    EXPECT_EQ(radii(load_main(extern_of("a.x3d#Ball"))), Radii{2});
    folder_.put("b.x3d", bare("<ExternProtoDeclare name='Ball' url='a.x3d#Ball'/>"));
    EXPECT_THROW(load_main(extern_of("a.x3d#Ball")), x3d::Error);
    // A body with an Inline is relative to its own file; one with an instance of itself ends.
    folder_.put("lib/c.x3d", bare(declaration("Ball", kRadius, "<Inline url='ball.x3d'/>")));
    folder_.put("lib/ball.x3d", bare(shape("<Sphere radius='12'/>")));
    EXPECT_EQ(radii(load_main(extern_of("lib/c.x3d#Ball"))), Radii{12});
    folder_.put("d.x3d",
                bare(declaration("Ball", "", "<Group>" + extern_of("d.x3d#Ball") + "</Group>")));
    EXPECT_THROW(load_main(extern_of("d.x3d#Ball")), x3d::Error);
}

}  // namespace
}  // namespace nuvo
