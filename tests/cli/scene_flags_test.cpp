// --viewpoint, --describe and the limits, as the user meets them.
#include <gtest/gtest.h>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

constexpr int kUsage = 2;
constexpr int kRefused = 3;

class SceneFlags : public ProgramTest {
  protected:
    int exit_code(std::vector<std::string> flags) const {
        flags.insert(flags.end(), {"--file=a", "--rep=1", "--res=8,8", "--quiet"});
        const Outcome outcome = run(flags);
        last_error_ = outcome.err;
        return outcome.exit_code;
    }
    /// A limit is kept at limit - 1 and at the limit, and refuses beyond it and far beyond.
    void expect_limit(const std::string& flag, std::size_t needed) const {
        for (const std::size_t allowed : {10 * needed, needed + 1, needed})
            EXPECT_EQ(exit_code({flag + std::to_string(allowed)}), 0) << flag << last_error_;
        for (const std::size_t allowed : {needed - 1, std::size_t{1}}) {
            EXPECT_EQ(exit_code({flag + std::to_string(allowed)}), kRefused) << flag;
            EXPECT_NE(last_error_.find("limit"), std::string::npos) << last_error_;
            EXPECT_NE(last_error_.find(" " + std::to_string(allowed)), std::string::npos)
                << last_error_;
        }
    }
    mutable std::string last_error_;
};

TEST_F(SceneFlags, EveryLimitIsAFlag) {
    // 4 nested levels by USE, 13 elements and 5 shapes when it is expanded.
    const std::string text =
        "<Scene><Group DEF='g'><Shape><Sphere/></Shape></Group>"
        "<Transform translation='2 0 0'><Group USE='g'/></Transform>"
        "<Shape><TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0'/></TriangleSet></Shape></Scene>";
    put("a.x3d", text);
    expect_limit("--max-depth=", 5);       // Scene, Transform, Group, Shape, Sphere
    expect_limit("--max-elements=", 11);   // Scene, 3, Transform and 3, Shape and 2
    expect_limit("--max-attributes=", 4);  // DEF, translation, USE, point
    expect_limit("--max-shapes=", 3);
    expect_limit("--max-vertices=", 3);
    expect_limit("--max-file-size=", text.size());
}

TEST_F(SceneFlags, ThePicturesSidesAreLimited) {
    put("a.x3d", kSmallScene);
    for (const char* size : {"39,1", "40,40", "1,40"})
        EXPECT_EQ(
            run({"--file=a", "--rep=1", std::string("--res=") + size, "--max-side=40"}).exit_code,
            0);
    for (const char* size : {"41,1", "1,41", "4000000000,1", "99999999999999999999,1"})
        expect_refused({"--file=a", std::string("--res=") + size, "--max-side=40"}, kUsage,
                       {"--res=", "limit 40"});
    expect_refused({"--file=a", "--max-side=32769"}, kUsage, {"--max-side=32769", "32768"});
    EXPECT_EQ(run({"--file=a", "--rep=1", "--max-side=20000", "--res=20000,1"}).exit_code, 0);
}

TEST_F(SceneFlags, LimitsOutOfRangeAreUsageErrors) {
    put("a.x3d", kSmallScene);
    for (const char* flag : {"--max-depth", "--max-elements", "--max-attributes", "--max-shapes",
                             "--max-vertices", "--max-file-size", "--max-side"})
        for (const char* value : {"0", "-1", "x", "1e3", "99999999999999999999"})
            expect_refused({"--file=a", std::string(flag) + "=" + value}, kUsage,
                           {std::string(flag) + "=" + value, "whole number 1 to"});
}

TEST_F(SceneFlags, TheViewpointIsChosenByNameOrNumber) {
    const std::string views =
        "<Scene><Viewpoint position='0 0 10'/><Viewpoint DEF='away' position='0 0 10' "
        "orientation='0 1 0 3.14159'/><Shape><Sphere/></Shape></Scene>";
    put("a.x3d", views);
    EXPECT_EQ(exit_code({}), 0);
    const std::string seen = content("a.bmp");
    for (const char* view : {"away", "2"}) {
        EXPECT_EQ(exit_code({std::string("--viewpoint=") + view}), 0);
        EXPECT_NE(content("a.bmp"), seen);
    }
    EXPECT_EQ(exit_code({"--viewpoint=1"}), 0);
    EXPECT_EQ(content("a.bmp"), seen);
    fs::remove(folder_ / "a.bmp");
    expect_refused({"--file=a", "--viewpoint=top"}, kRefused, {"a.x3d: ", "\"top\"", "1 away"});
    expect_refused({"--file=a", "--viewpoint="}, kUsage, {"--viewpoint"});
}

TEST_F(SceneFlags, ScenesAreFoundByTheirEndings) {
    put("z.x3dz", "<Scene/>");
    put("U.X3D", "<Scene/>");
    for (const char* name : {"z", "z.x3dz", "U.X3D"})
        EXPECT_EQ(run({name, "--rep=1", "--res=8,8", "--quiet"}).exit_code, 0) << name;
    EXPECT_EQ(files(), (std::set<std::string>{"U.X3D", "U.bmp", "z.bmp", "z.x3dz"}));
    expect_refused({"none", "--res=8,8"}, kRefused, {"not found, with or without .x3d or .x3dz"});
    expect_refused({"z", "--rays=none.txt"}, kRefused,
                   {"none.txt: cannot read: No such file or directory"});
}

// A DirectionalLight lights its own group (19775-1, 17.2.1): for one of the Scene that is
// everything.
TEST_F(SceneFlags, DescribeTellsScopesThatAreLessThanTheScene) {
    const std::string ball = "<Shape><Appearance><Material/></Appearance><Sphere/></Shape>";
    const std::string moved = "<Transform translation='3 0 0'>" + ball;
    const auto described = [&](const std::string& nodes) {
        put("a.x3d", "<X3D version='3.3'><Scene>" + nodes + "</Scene></X3D>");
        return run({"--file=a", "--describe"}).out;
    };
    const std::string own = ", for its own group only\n";
    EXPECT_EQ(described("<DirectionalLight/>" + ball).find(own), std::string::npos);
    EXPECT_NE(described(ball + moved + "<DirectionalLight/></Transform>").find(own),
              std::string::npos);
    EXPECT_NE(described(moved + "<DirectionalLight/></Transform>" + ball).find(own),
              std::string::npos);
    EXPECT_NE(described("<Transform rotation='1 0 0 3.141592653589793'><Background/></Transform>")
                  .find("background sky (0 0 0), zenith 0 -1 1.2246468e-16\n"),
              std::string::npos);
}

TEST_F(SceneFlags, DescribeSaysWhatWasReadAndDrawsNothing) {
    put("a.x3d",
        "<Scene><Viewpoint DEF='front'/><Viewpoint description='back'/><PointLight radius='7'/>"
        "<Shape><Appearance><Material/></Appearance><Sphere radius='2'/></Shape>"
        "<Transform scale='1 2 3'><Shape><Sphere/></Shape></Transform>"
        "<Shape><IndexedFaceSet coordIndex='0 1 2 3 -1 0 0 1'>"
        "<Coordinate point='0 0 0 9 0 0 9 9 0 0 9 0'/><Color color='1 0 0 1 0 0 1 0 0 1 0 0'/>"
        "</IndexedFaceSet></Shape><Shape><Text/></Shape></Scene>");
    const std::set<std::string> before = files();
    const Outcome outcome = run({"--file=a", "--describe"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(files(), before);
    for (const char* part :
         {"shapes     4, 3 drawn, 2 of them unlit\n", "spheres    1, and 1 ellipsoids\n",
          "meshes     1, 0 with normals and 1 with colors of their own\n",
          "triangles  3, 1 of them without area, which are never hit\n", "lights     1\n",
          "point, at 0 0 0, color 1 1 1, intensity 1, radius 7\n",
          "camera     at 0 0 10, along 0 0 -1, up 0 1 0, field of view 45 degrees\n",
          "viewpoints 2: front, back\n", "background sky (0 0 0)\n",
          "bounds     -2 -2 -3 to 9 9 3\n", "warnings   2\n"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "not in\n" << outcome.out;
    EXPECT_EQ(outcome.err,
              "nuvo: warning: a.x3d: Shape: 2 without a Material drawn unlit, white or in colors "
              "of its own (first at Scene/Transform/Shape, line 1)\n"
              "nuvo: warning: a.x3d: Text: 1 not drawn (first at Scene/Shape[3]/Text, line 1)\n");
    for (const char* other : {"-compare", "--out=b.bmp", "--json=b.json", "-showoctree"})
        expect_refused({"--file=a", "--describe", other}, kUsage, {"--describe"});
}

TEST_F(SceneFlags, SyntaxVariantsGiveTheSameBytes) {
    put("a.x3d", kSmallScene);
    EXPECT_EQ(exit_code({}), 0);
    const std::string plain = content("a.bmp");
    const auto replaced = [](std::string text, const std::string& what, const std::string& with) {
        for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
            text.replace(at, what.size(), with);
        return text;
    };
    const std::string scene = kSmallScene;
    for (const std::string& variant :
         {replaced(scene, "\n", "\r\n"), "\xef\xbb\xbf" + scene, replaced(scene, "\"", "'"),
          replaced(scene, "0 1 2 3 -1", "0,1,2,3"), replaced(scene, ",", " "),
          replaced(scene, "<Shape>", "<!-- c --><?p?><Shape DEF=\"d\"><![CDATA[ x ]]>")}) {
        ASSERT_NE(variant, scene);
        put("a.x3d", variant);
        EXPECT_EQ(exit_code({}), 0) << last_error_;
        EXPECT_EQ(content("a.bmp"), plain);
    }
}

}  // namespace
}  // namespace nuvo::cli_test
