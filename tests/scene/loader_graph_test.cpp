// Switch, LOD, visible, proxies and the choice of a Viewpoint.
#include "scene/loading.h"

namespace nuvo {
namespace {

using Strings = std::vector<std::string>;

/// A sphere whose radius tells it from the others.
std::string ball(int radius) { return shape("<Sphere radius='" + std::to_string(radius) + "'/>"); }

/// The radii of the spheres that are drawn.
std::vector<double> drawn(const Scene& scene) {
    std::vector<double> radii;
    for (const Object& object : scene.objects) {
        const auto* sphere = std::get_if<Sphere>(&object.shape);
        radii.push_back(sphere ? sphere->radius : 0);
    }
    return radii;
}
std::vector<double> drawn(const std::string& nodes) { return drawn(load(bare(nodes))); }

std::string switch_of(const std::string& fields) {
    return "<Switch " + fields + "><MetadataString/>" + ball(1) + "<Group>" + ball(2) + ball(3) +
           "</Group>" + ball(4) + "</Switch>";
}

using Radii = std::vector<double>;

TEST(LoaderSwitch, DrawsTheChosenChildOnly) {
    EXPECT_EQ(drawn(switch_of("whichChoice='0'")), Radii{1});
    EXPECT_EQ(drawn(switch_of("whichChoice='1'")), (Radii{2, 3}));
    EXPECT_EQ(drawn(switch_of("whichChoice='2'")), Radii{4});
    EXPECT_EQ(drawn(switch_of("whichChoice='3'")), Radii{});
    EXPECT_EQ(drawn(switch_of("whichChoice='-1'")), Radii{});
    EXPECT_EQ(drawn(switch_of("")), Radii{});
    EXPECT_EQ(refusal(bare(switch_of("whichChoice='one'"))),
              "scene.x3d: Scene/Switch@whichChoice: \"one\" is not an integer (line 1)");
}

// 19775-1, 9.4.3: WorldInfo is an X3DInfoNode, so an X3DChildNode; metadata is no child.
TEST(LoaderSwitch, AWorldInfoIsAChild) {
    const std::string children = "><MetadataString/><WorldInfo/>" + ball(1) + ball(2);
    EXPECT_EQ(drawn("<Switch whichChoice='0'" + children + "</Switch>"), Radii{});
    EXPECT_EQ(drawn("<Switch whichChoice='1'" + children + "</Switch>"), Radii{1});
    EXPECT_EQ(drawn("<LOD range='20'" + children + "</LOD>"), Radii{});
    EXPECT_EQ(drawn("<LOD range='5'" + children + "</LOD>"), Radii{1});
    EXPECT_EQ(drawn("<LOD range='5 6'" + children + "</LOD>"), Radii{2});
    // The layers of a LayerSet are X3DLayerNodes, which it is none of.
    EXPECT_EQ(drawn("<LayerSet order='1'><WorldInfo/><Layer>" + ball(3) + "</Layer></LayerSet>"),
              Radii{3});
}

TEST(LoaderSwitch, ShapesNotChosenKeepTheirNumbers) {
    const Scene scene = load(bare(ball(7) + switch_of("whichChoice='2'") + ball(8)));
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.objects[1].shape_index, 4u);
    EXPECT_EQ(scene.objects[2].shape_index, 5u);
    EXPECT_EQ(scene.shape_count, 6u);
}

TEST(LoaderSwitch, LightsNotChosenDoNotShine) {
    const std::string lamps =
        "<PointLight intensity='0.25'/><PointLight intensity='0.5'/></Switch>" + ball(1);
    EXPECT_EQ(load(bare("<Switch whichChoice='1'>" + lamps)).lights.at(0).intensity, 0.5);
    EXPECT_EQ(load(bare("<Switch whichChoice='1'>" + lamps)).lights.size(), 1u);
    const Scene dark = load(bare("<Switch>" + lamps), x3d::Headlight::kOff);
    EXPECT_TRUE(dark.lights.empty());
}

TEST(LoaderVisible, HidesShapesAndGroupsButCountsThem) {
    for (const char* kind :
         {"Group", "Transform", "StaticGroup", "Switch whichChoice='0'", "LOD"}) {
        const std::string name = kind;
        const Scene scene = load(bare("<" + name + " visible='false'>" + ball(1) + "</" +
                                      name.substr(0, name.find(' ')) + ">" + ball(2)));
        EXPECT_EQ(drawn(scene), Radii{2}) << kind;
        EXPECT_EQ(scene.objects[0].shape_index, 1u) << kind;
    }
    EXPECT_EQ(drawn("<Shape visible='FALSE'><Sphere/></Shape>" + ball(3)), Radii{3});
    EXPECT_EQ(drawn("<Shape visible='true'><Sphere/></Shape>"), Radii{1});
    EXPECT_EQ(drawn("<Group DEF='g' visible='false'>" + ball(1) + "</Group><Group USE='g'/>"),
              Radii{});
}

TEST(LoaderCollision, TheProxyIsCountedButNotDrawn) {
    const Scene scene = load(bare("<Collision><Shape containerField='proxy'><Sphere/></Shape>" +
                                  ball(2) + "</Collision>"));
    EXPECT_EQ(drawn(scene), Radii{2});
    EXPECT_EQ(scene.objects[0].shape_index, 1u);
}

// The viewer stands at (0, 0, 10).
std::string levels(const std::string& fields, const std::string& around = "") {
    return "<Transform " + around + "><LOD " + fields + ">" + ball(1) + ball(2) + ball(3) +
           "</LOD></Transform>";
}

TEST(LoaderLod, TheViewersDistanceChoosesTheLevel) {
    EXPECT_EQ(drawn(levels("range='5 20'")), Radii{2});
    EXPECT_EQ(drawn(levels("range='11 20'")), Radii{1});
    EXPECT_EQ(drawn(levels("range='10 20'")), Radii{2});  // from its range on the next level
    EXPECT_EQ(drawn(levels("range='5 9'")), Radii{3});
    EXPECT_EQ(drawn(levels("range='5 20' center='0 0 6'")), Radii{1});
    EXPECT_EQ(drawn(levels("range='5 20'", "translation='0 0 6'")), Radii{1});
    EXPECT_EQ(drawn(levels("range='1 2 3 4 5'")), Radii{3});  // the last is for all beyond
    EXPECT_EQ(drawn(levels("")), Radii{1});
    EXPECT_EQ(drawn("<LOD/>"), Radii{});
}

TEST(LoaderLod, TheDistanceIsInItsOwnUnits) {
    // 10 in the world is 100 in units of a tenth.
    const std::vector<Object> near =
        load(bare(levels("range='99 101'", "scale='0.1 0.1 0.1'"))).objects;
    EXPECT_EQ(std::get<Sphere>(near.at(0).shape).radius, 2 * 0.1);
    EXPECT_EQ(load(bare(levels("range='99 101'", "scale='1 1 0.1'"))).objects.at(0).shape_index,
              1u);
    // Without a volume there is no distance.
    EXPECT_EQ(load(bare(levels("range='1'", "scale='0 0 0'"))).shape_count, 3u);
}

TEST(LoaderLod, TheCameraCountsWhereverItStandsInTheFile) {
    const std::string far = "<Transform translation='0 0 90'><Viewpoint/></Transform>";
    const std::string lod = levels("range='50'");
    EXPECT_EQ(drawn(lod + far), Radii{2});
    EXPECT_EQ(drawn(far + lod), Radii{2});
    EXPECT_EQ(drawn(lod + "<Viewpoint/>" + far), Radii{1});
    const Scene chosen =
        x3d::read_text(bare(lod + "<Viewpoint/>" + far), "scene.x3d", {.viewpoint = "2"});
    EXPECT_EQ(drawn(chosen), Radii{2});
    EXPECT_EQ(chosen.viewpoints.size(), 2u);
}

TEST(LoaderLod, WarningsAreNotDoubledByLookingForTheCamera) {
    const Scene scene =
        load(bare("<Transform rotation='0 0 0 1'>" + levels("range='50'") + "</Transform>"));
    EXPECT_EQ(scene.warnings,
              Strings{"Transform@rotation: 1 about an axis of length zero taken as no rotation "
                      "(first at Scene/Transform, line 1)"});
    EXPECT_EQ(scene.shape_count, 3u);
}

const std::string kViews =
    "<Viewpoint position='1 0 0'/><Viewpoint DEF='side' position='2 0 0'/>"
    "<Viewpoint description='From above' position='3 0 0'/>";

Point3 camera_at(const std::string& viewpoint) {
    return x3d::read_text(bare(kViews), "scene.x3d", {.viewpoint = viewpoint}).camera.position;
}

TEST(LoaderViewpoint, IsChosenByNameDescriptionOrNumber) {
    EXPECT_EQ(camera_at("").x, 1);
    EXPECT_EQ(camera_at("1").x, 1);
    EXPECT_EQ(camera_at("2").x, 2);
    EXPECT_EQ(camera_at("side").x, 2);
    EXPECT_EQ(camera_at("From above").x, 3);
    EXPECT_EQ(load(bare(kViews)).viewpoints, (Strings{"1", "side", "From above"}));
}

TEST(LoaderViewpoint, OneThatIsNotThereIsRefused) {
    for (const char* name : {"4", "0", "top", "Side"}) {
        try {
            camera_at(name);
            ADD_FAILURE() << name;
        } catch (const x3d::Error& error) {
            EXPECT_EQ(error.what(), "scene.x3d: has no Viewpoint \"" + std::string(name) +
                                        "\" among its 3: 1 side From above");
        }
    }
}

TEST(LoaderGroups, CadNodesAreRead) {
    EXPECT_EQ(drawn("<CADLayer><CADAssembly><CADPart translation='1 0 0'><CADFace>" + ball(2) +
                    "</CADFace></CADPart></CADAssembly></CADLayer>"),
              Radii{2});
}

}  // namespace
}  // namespace nuvo
