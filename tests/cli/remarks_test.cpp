// What is said about cameras that were moved, and about pictures that may puzzle.
#include <gtest/gtest.h>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

class Remarks : public ProgramTest {
  protected:
    /// Standard error of a run of the scene, which must end well.
    std::string said(const std::string& nodes, std::vector<std::string> flags = {}) const {
        put("a.x3d", "<X3D version='3.3'><Scene>" + nodes + "</Scene></X3D>");
        flags.insert(flags.end(), {"--file=a", "--rep=1", "--res=32,18", "--quiet"});
        std::string first;
        for (const char* profile : {"exact", "fast"}) {
            std::vector<std::string> all = flags;
            all.push_back(std::string("--profile=") + profile);
            const Outcome outcome = run(all);
            EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
            if (first.empty()) first = outcome.err;
            EXPECT_EQ(outcome.err, first);
        }
        return first;
    }
    static bool contains(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

std::string sphere(const std::string& place, const std::string& fields = "") {
    return "<Transform translation='" + place + "'><Shape><Appearance><Material/></Appearance>" +
           "<Sphere " + fields + "/></Shape></Transform>";
}

TEST_F(Remarks, AFileWithoutViewpointIsShown) {
    const std::string away = said(sphere("60 0 0", "radius='2'"));
    EXPECT_TRUE(contains(away, "nuvo: note: a.x3d: has no Viewpoint")) << away;
    EXPECT_TRUE(contains(
        away,
        "no ray of the standard's meets anything: the shapes lie between 58 -2 -2 and 62 2 2"))
        << away;
    EXPECT_TRUE(contains(away, "at 60 ")) << away;
    const std::string picture = content("a.bmp");
    // In the middle of the picture, which is 32 x 18 after a header of 54 bytes.
    EXPECT_NE(picture.at(54 + 96 * 9 + 3 * 16), '\0');
    EXPECT_TRUE(contains(said(sphere("0 0 0", "radius='5'")), "cuts the scene off"));
    EXPECT_TRUE(contains(said(sphere("0 0 0", "radius='0.1'")), "shows the scene tiny"));
    EXPECT_EQ(said(sphere("0 0 0", "radius='2'")), "");
}

TEST_F(Remarks, TheUserDecidesWhichCameraItIs) {
    const std::string standard = said(sphere("60 0 0"), {"--viewpoint=standard"});
    EXPECT_TRUE(contains(standard, "no ray met anything")) << standard;
    EXPECT_FALSE(contains(standard, "has no Viewpoint")) << standard;
    const std::string kept = content("a.bmp");
    EXPECT_EQ(said("<Viewpoint/>" + sphere("60 0 0"), {"--viewpoint=fit"}), "");
    const std::string fitted = content("a.bmp");
    EXPECT_NE(fitted, kept);
    said(sphere("60 0 0"));
    EXPECT_EQ(content("a.bmp"), fitted);
    // A Viewpoint of that name comes first, and one that is given is never moved.
    const std::string named =
        said("<Viewpoint/><Viewpoint DEF='fit' position='0 0 10'/>" + sphere("60 0 0"),
             {"--viewpoint=fit"});
    EXPECT_TRUE(contains(named, "no ray met anything")) << named;
    EXPECT_EQ(content("a.bmp"), kept);
}

TEST_F(Remarks, AnEmptyPictureNamesTheBounds) {
    const std::string line = said("<Viewpoint/>" + sphere("60 0 0", "radius='2'"));
    EXPECT_EQ(line,
              "nuvo: note: no ray met anything: the shapes lie between 58 -2 -2 and 62 2 2, the "
              "camera is at 0 0 10 (--viewpoint=fit looks at them)\n");
    EXPECT_TRUE(contains(said("<Viewpoint/>"), "there is no shape to draw"));
    // Black on black is not nothing.
    EXPECT_EQ(said("<Viewpoint/><Shape><Appearance><UnlitMaterial emissiveColor='0 0 0'/>"
                   "</Appearance><Sphere/></Shape>"),
              "");
}

// 19775-1, 11.2.3 and 13.3.6: the back of a solid face is not seen. The triangle turns clockwise
// for the camera.
TEST_F(Remarks, BacksOfSolidsAreNamedWhereTheyAreAllThatFacesTheCamera) {
    const auto triangle = [](const std::string& fields) {
        return "<Shape><Appearance><Material/></Appearance><IndexedFaceSet coordIndex='0 2 1' " +
               fields + "><Coordinate point='0 0 0 2 0 0 0 2 0'/></IndexedFaceSet></Shape>";
    };
    const std::string line =
        "nuvo: note: no ray met anything: of the shapes in sight all that faces the camera are "
        "backs of solid ones, which are invisible (--back-faces=draw draws them, solid='false' in "
        "the file lights them, too)\n";
    EXPECT_EQ(said("<Viewpoint/>" + triangle("")), line);
    EXPECT_EQ(said("<Viewpoint/>" + triangle(""), {"--viewpoint=fit"}), line);
    // Drawn as a front its back is dark.
    EXPECT_EQ(said("<Viewpoint/>" + triangle(""), {"--back-faces=draw"}),
              "nuvo: note: no light adds anything to what is seen, of 1 light\n");
    EXPECT_EQ(said("<Viewpoint/>" + triangle("solid='false'")), "");
    // Out of sight it is not the back that is the cause.
    const std::string away = said("<Viewpoint position='0 90 10'/>" + triangle(""));
    EXPECT_TRUE(contains(away, "(--viewpoint=fit looks at them)")) << away;
}

TEST_F(Remarks, FlagsThatAreGivenAreNotNamed) {
    const std::string named =
        said("<Viewpoint DEF='fit'/>" + sphere("60 0 0"), {"--viewpoint=fit"});
    EXPECT_TRUE(contains(named, "the camera is at 0 0 10\n")) << named;
    const std::string dark = said(
        "<Viewpoint/><Shape><Appearance><Material diffuseColor='0.001 0 0'/></Appearance>"
        "<Sphere/></Shape>",
        {"--headlight=on"});
    EXPECT_TRUE(contains(dark, "of 1 light\n")) << dark;
}

TEST_F(Remarks, LightsThatAddNothingAreNamed) {
    for (const char* light :
         {"<PointLight location='0 0 9' radius='1'/>", "<DirectionalLight direction='0 0 1'/>",
          "<PointLight location='0 0 9' intensity='0'/>", "<NavigationInfo headlight='false'/>"}) {
        const std::string line = said(std::string("<Viewpoint/>") + light + sphere("0 0 0"));
        EXPECT_TRUE(contains(line, "no light adds anything to what is seen")) << light << line;
        EXPECT_TRUE(contains(line, "--headlight=on")) << line;
    }
    EXPECT_EQ(said("<Viewpoint/>" + sphere("0 0 0")), "");
    // Unlit, and what reflects nothing.
    for (const char* material : {"<UnlitMaterial/>", "<Material diffuseColor='0 0 0'/>",
                                 "<Material diffuseColor='0 0 0' emissiveColor='0 1 0'/>"})
        EXPECT_EQ(said(std::string("<Viewpoint/><NavigationInfo headlight='false'/><Shape>"
                                   "<Appearance>") +
                       material + "</Appearance><Sphere/></Shape>"),
                  "")
            << material;
}

TEST_F(Remarks, ACameraWithinASolidIsNamed) {
    const std::string inside = "<Viewpoint position='1 0 0'/>";
    const std::string other = sphere("0 0 -20", "radius='5'");
    for (const char* geometry :
         {"<Box size='4 4 4'/>", "<Sphere radius='2'/>", "<Cylinder radius='2' height='4'/>"}) {
        const std::string shape =
            "<Shape><Appearance><Material/></Appearance>" + std::string(geometry) + "</Shape>";
        const std::string line = said(inside + other + shape);
        EXPECT_TRUE(contains(line, "the camera stands inside Shape 1")) << line;
        EXPECT_FALSE(contains(said(inside + other + shape, {"--back-faces=draw"}), "inside"));
        EXPECT_EQ(said("<Viewpoint/>" + other + shape), "");
    }
}

}  // namespace
}  // namespace nuvo::cli_test
