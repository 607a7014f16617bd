// Inline: files of the scene's own folder, and nothing else.
#include "scene/loading.h"
#include "scene/temporary_folder.h"

namespace nuvo {
namespace {

using Strings = std::vector<std::string>;

class LoaderInline : public testing::Test {
  protected:
    void put(const std::string& name, const std::string& text) const { folder_.put(name, text); }
    Scene load_main(const std::string& nodes, const x3d::Limits& limits = {}) const {
        return x3d::read_file(folder_.put("main.x3d", nodes), {limits, x3d::Headlight::kOff});
    }
    /// The message without the folder's name.
    std::string refusal_of(const std::string& text, const x3d::Limits& limits = {}) const {
        try {
            x3d::read_file(folder_.put("main.x3d", text), {.limits = limits, .strict = true});
        } catch (const x3d::Error& error) {
            std::string message = error.what();
            const std::string name = folder_.path().string() + "/";
            for (std::size_t at; (at = message.find(name)) != std::string::npos;)
                message.erase(at, name.size());
            return message;
        }
        return "";
    }
    Strings warnings_of(const std::string& nodes) const { return load_main(bare(nodes)).warnings; }

    TemporaryFolder folder_;
};

const std::string kBall = shape("<Sphere radius='2'/>");
std::string left_out(const std::string& url, const std::string& what) {
    return "Inline@url: 1 left out: \"" + url + "\" " + what + " (first at Scene/Inline, line 1)";
}
const std::string kOut = "leads out of the scene's folder";
const std::string kMissing = "names no X3D file that can be read";

TEST_F(LoaderInline, StandsWhereItIsPlaced) {
    put("parts/ball.x3d", bare("<Transform scale='3 3 3'>" + kBall + "</Transform>"));
    const Scene scene =
        load_main(bare("<Transform translation='1 2 3'><Inline url='\"parts/ball.x3d\"'/>"
                       "</Transform><Inline url='parts/ball.x3d'/>"));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).center, (Point3{1, 2, 3}));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 6);
    EXPECT_EQ(scene.objects[1].shape_index, 1u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoaderInline, TakesTheFirstUrlThatCanBeLoaded) {
    put("two.x3d", bare(kBall + shape("<Sphere radius='3'/>")));
    put("one.x3d", bare(kBall));
    const Scene scene = load_main(
        bare("<Inline url='\"missing.x3d\" \"http://example.org/one.x3d\" \"two.x3d#View\", "
             "\"one.x3d\"'/>"));
    EXPECT_EQ(scene.objects.size(), 2u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoaderInline, NamesAreRelativeToTheFileTheyStandIn) {
    put("a/b.x3d", bare("<Inline url='c.x3d'/>"));
    put("a/c.x3d", bare(kBall));
    EXPECT_EQ(load_main(bare("<Inline url='a/b.x3d'/>")).objects.size(), 1u);
}

TEST_F(LoaderInline, WhatCannotBeLoadedIsLeftOutWithAWarning) {
    put("pictures.png", "");
    std::filesystem::create_directory(folder_.path() / "folder.x3d");
    for (const char* url : {"missing.x3d", "pictures.png", "folder.x3d"}) {
        const std::string nodes = "<Inline url='" + std::string(url) + "'/>";
        EXPECT_EQ(warnings_of(nodes), Strings{left_out(url, kMissing)}) << url;
        EXPECT_EQ(refusal_of(bare(nodes)), "main.x3d: Scene/Inline@url: \"" + std::string(url) +
                                               "\" " + kMissing + " (line 1)");
    }
    EXPECT_EQ(warnings_of("<Inline/>"),
              Strings{"Inline@url: 1 left out (first at Scene/Inline, line 1: names nothing)"});
    EXPECT_EQ(refusal_of(bare("<Inline/>")), "main.x3d: Scene/Inline@url: names nothing (line 1)");
    EXPECT_TRUE(warnings_of("<Inline load='false' url='missing.x3d'/>").empty());
    // Each url has a line of its own; of several in one node the first is told.
    EXPECT_EQ(warnings_of("<Inline url='a.x3d'/><Inline url='\"b.x3d\" \"../c.x3d\"'/>"
                          "<Inline url='a.x3d'/>"),
              (Strings{"Inline@url: 2 left out: \"a.x3d\" names no X3D file that can be read "
                       "(first at Scene/Inline[1], line 1)",
                       "Inline@url: 1 left out: \"b.x3d\" names no X3D file that can be read "
                       "(first at Scene/Inline[2], line 1)"}));
}

// RFC 3986, 2.1; what is decoded leads no further than what is written.
TEST_F(LoaderInline, PercentSignsAndTwoDigitsAreBytes) {
    put("part one.x3d", bare(kBall));
    put("sub/100%.x3d", bare(kBall));
    for (const char* url : {"part%20one.x3d", "%70art%20one%2ex3d#%20", "sub/100%25.x3d",
                            "sub/100%.x3d", "sub%2F100%.x3d"})
        EXPECT_EQ(load_main(bare("<Inline url='\"" + std::string(url) + "\"'/>")).objects.size(),
                  1u)
            << url;
    const TemporaryFolder elsewhere;
    const std::string outside = elsewhere.put("ball.x3d", bare(kBall)).string();
    put("sub/inner.x3d", bare("<Inline url='%2e%2e/part%20one.x3d'/>"));
    const std::string name = elsewhere.path().filename().string();
    for (const std::string& url :
         {"%2e%2e/" + name + "/ball.x3d", "%2E./" + name + "/ball.x3d",
          "..%2f" + name + "%2Fball.x3d", "%2f" + outside.substr(1), "file%3a//" + outside,
          std::string("sub/inner.x3d%00"), std::string("%2e%2e%2fx.x3d")})
        EXPECT_EQ(warnings_of("<Inline url='" + url + "'/>"), Strings{left_out(url, kOut)}) << url;
    EXPECT_EQ(warnings_of("<Inline url='sub/inner.x3d'/>").size(), 1u);
    // Decoded once only.
    EXPECT_EQ(warnings_of("<Inline url='%252e%252e/ball.x3d'/>"),
              Strings{left_out("%252e%252e/ball.x3d", kMissing)});
}

TEST_F(LoaderInline, NothingOutsideTheFolderIsLoaded) {
    const TemporaryFolder elsewhere;
    const std::string outside = elsewhere.put("ball.x3d", bare(kBall)).string();
    put("sub/inner.x3d", bare("<Inline url='../ball.x3d'/>"));
    put("ball.x3d", bare(kBall));
    std::filesystem::create_symlink(outside, folder_.path() / "link.x3d");
    std::filesystem::create_symlink(elsewhere.path(), folder_.path() / "link");
    for (const std::string& url :
         {outside, "file://" + outside, std::string("http://example.org/ball.x3d"),
          "../" + folder_.path().filename().string() + "/ball.x3d", std::string("link.x3d"),
          std::string("link/ball.x3d")}) {
        const Scene scene = load_main(bare("<Inline url='" + url + "'/>"));
        EXPECT_EQ(scene.warnings, Strings{left_out(url, kOut)}) << url;
        EXPECT_TRUE(scene.objects.empty()) << url;
    }
    EXPECT_EQ(load_main(bare("<Inline url='sub/inner.x3d'/>")).warnings,
              Strings{"Inline@url: 1 left out: \"../ball.x3d\" " + kOut + " (first in " +
                      (folder_.path() / "sub/inner.x3d").string() + " at Scene/Inline, line 1)"});
    EXPECT_EQ(
        load(bare("<Inline url='ball.x3d'/>")).warnings,
        Strings{left_out("ball.x3d", "is not looked for: only a scene in a file has a folder")});
}

TEST_F(LoaderInline, CyclesAreRefused) {
    put("a.x3d", bare("<Inline url='b.x3d'/>"));
    put("b.x3d", bare("<Inline url='main.x3d'/><Inline url='sub/../a.x3d'/>"));
    EXPECT_EQ(refusal_of(bare("<Inline url='main.x3d'/>")),
              "main.x3d: Scene/Inline@url: main.x3d is the file itself or one that Inlines it "
              "(line 1)");
    EXPECT_EQ(refusal_of(bare("<Inline url='a.x3d'/>")),
              "b.x3d: Scene/Inline[1]@url: main.x3d is the file itself or one that Inlines it "
              "(line 1)");
}

TEST_F(LoaderInline, NestsSixteenDeep) {
    const auto name = [](int i) { return "n" + std::to_string(i) + ".x3d"; };
    for (int i = 1; i < 17; ++i) put(name(i), bare("<Inline url='" + name(i + 1) + "'/>"));
    put(name(16), bare(kBall));
    EXPECT_EQ(load_main(bare("<Inline url='n1.x3d'/>")).objects.size(), 1u);
    put(name(16), bare("<Inline url='n17.x3d'/>"));
    put(name(17), bare(kBall));
    EXPECT_EQ(refusal_of(bare("<Inline url='n1.x3d'/>")),
              "n16.x3d: Scene/Inline@url: Inlines nested too deeply (limit 16) (line 1)");
}

TEST_F(LoaderInline, NamesOfNodesAreEachFilesOwn) {
    put("part.x3d", bare("<Group DEF='inner'>" + kBall + "</Group>"));
    EXPECT_EQ(refusal_of(bare("<Inline url='part.x3d'/><Group USE='inner'/>")),
              "main.x3d: Scene/Group: USE=\"inner\" names no DEF (line 1)");
}

TEST_F(LoaderInline, ViewsAndHeadlightAreThoseOfTheSceneItself) {
    put("part.x3d", bare("<Viewpoint position='9 9 9'/><Background skyColor='1 1 1'/>"
                         "<NavigationInfo headlight='true'/>" +
                         kBall));
    const Scene scene = load_main(bare("<Inline url='part.x3d'/>"));
    EXPECT_EQ(scene.camera, Camera{});
    EXPECT_EQ(scene.background, Background{});
    EXPECT_TRUE(scene.viewpoints.empty());
}

TEST_F(LoaderInline, DefaultsFollowTheVersionOfTheFileItself) {
    put("old.x3d", versioned("3.0", "<SpotLight/>" + kBall));
    const Scene scene = load_main(versioned("4.0", "<Inline url='old.x3d'/><SpotLight/>" + kBall));
    EXPECT_EQ(scene.lights.at(0).beam_width, 0.785398);
    EXPECT_EQ(scene.lights.at(1).beam_width, 0.589049);
}

TEST_F(LoaderInline, ErrorsNameTheFileTheyAreIn) {
    put("part.x3d", bare("\n<Shape><Sphere radius='x'/></Shape>"));
    EXPECT_EQ(refusal_of(bare("<Inline url='part.x3d'/>")),
              "part.x3d: Scene/Shape/Sphere@radius: \"x\" is not a number (line 2)");
    put("part.x3d", "<Scene>");
    EXPECT_EQ(refusal_of(bare("<Inline url='part.x3d'/>")),
              "part.x3d: line 1: <Scene> is never closed");
}

TEST_F(LoaderInline, ShapesElementsDepthAndBytesAreCountedBeforeAnyIsMade) {
    // 10^8 shapes: eight files that each Inline the next ten times.
    const auto name = [](int i) { return "n" + std::to_string(i) + ".x3d"; };
    for (int i = 1; i < 8; ++i)
        put(name(i), bare(repeated("<Inline url='" + name(i + 1) + "'/>", 10)));
    put(name(8), bare(repeated(kBall, 10)));
    EXPECT_NE(refusal_of(bare("<Inline url='n1.x3d'/>")).find("the limit of"), std::string::npos);
    x3d::Limits limits;
    limits.shapes = 100;
    EXPECT_EQ(refusal_of(bare("<Inline url='n7.x3d'/>"), limits), "");
    limits.shapes = 99;
    EXPECT_EQ(refusal_of(bare("<Inline url='n7.x3d'/>"), limits),
              "n7.x3d: Scene/Inline[10]: Inline makes the scene exceed the limit of 99 shapes "
              "(line 1)");
    const std::string nodes = bare("<Inline url='n8.x3d'/>");
    const std::size_t bytes = nodes.size() + bare(repeated(kBall, 10)).size();
    limits = {};
    limits.file_bytes = bytes;
    EXPECT_EQ(refusal_of(nodes, limits), "");
    limits.file_bytes = bytes - 1;
    EXPECT_EQ(refusal_of(nodes, limits),
              "n8.x3d: with the files before it is too large: " + std::to_string(bytes) +
                  " bytes (limit " + std::to_string(bytes - 1) + ")");
}

}  // namespace
}  // namespace nuvo
