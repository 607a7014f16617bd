// What is XML and what is refused, with its line.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "scene/loading.h"

namespace nuvo {
namespace {

TEST(LoaderXml, ReadsBothRoots) {
    EXPECT_EQ(load("<Scene><Shape><Sphere/></Shape></Scene>").objects.size(), 1u);
    EXPECT_EQ(load("<X3D><head/><Scene><Shape><Sphere/></Shape></Scene></X3D>").objects.size(), 1u);
}

TEST(LoaderXml, TakesWhatXmlAllowsAroundAndInsideTheRoot) {
    const Scene scene = load(
        "\xef\xbb\xbf<?xml version=\"1.0\" encoding =\"UTF-8\"?>\r\n"
        "<!DOCTYPE X3D PUBLIC \"a>b\" \"c\" [ <!ENTITY e \"]>\"> <!-- > ' --> ]>\r\n"
        "<!-- <Sphere> -->\n<X3D\n version\t=\r\n'3.3' ><?pi <x> ?><Scene >text &amp; more"
        "<![CDATA[ <Shape> ]]><Shape><Sphere radius = \"&#50;\"></Sphere ></Shape></Scene></X3D>\n"
        "<!-- after -->\n");
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 2);
}

/// A file of one triangle whose corners stand behind so many blanks.
std::string behind_blanks(const std::string& blanks, const std::string& more = "") {
    return "<Scene><Shape><IndexedFaceSet coordIndex='" + blanks + "0 1 2'><Coordinate point='" +
           blanks + "1 2 3 4 5 6\t7,8\r\n10" + more +
           "'/></IndexedFaceSet><Appearance><Material diffuseColor='.5 .25 0'/></Appearance>"
           "</Shape></Scene>";
}

TEST(LoaderXml, ValuesOfAnyLengthAreRead) {
    for (const std::size_t length : {0, 1, 900, 1000, 1023, 1024, 1025, 5000, 100'000}) {
        // Where there is a reference the value is not the text of the file.
        for (const char* more : {"", "&#32;", " &#49;&#32;2 3", "&#9;"}) {
            const Scene scene = load(behind_blanks(std::string(length, ' '), more));
            EXPECT_EQ(scene.warnings, std::vector<std::string>{});
            ASSERT_EQ(scene.objects.size(), 1u) << length << more;
            const auto& mesh = std::get<TriangleMesh>(scene.objects[0].shape);
            EXPECT_EQ(mesh.positions, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}))
                << length << more;
            EXPECT_EQ(mesh.triangles, (std::vector<IndexTriple>{{0, 1, 2}}));
            EXPECT_EQ(scene.materials.at(scene.objects[0].material).diffuse_color,
                      (Color{0.5, 0.25, 0}));
        }
    }
}

TEST(LoaderXml, LinesAreCountedThroughLongValues) {
    for (const std::size_t lines : {1, 1500}) {
        const std::string head = "<Scene><Shape DEF='" + std::string(lines, '\n');
        const std::string line = "scene.x3d: line " + std::to_string(lines + 2) + ": ";
        // In a run of elements, and in the tag of an element that is too large for one.
        for (const std::size_t inside : {0, 50'000}) {
            const std::string more = std::string(inside, ' ') + "<Sphere/></Shape></Scene>";
            EXPECT_EQ(refusal(head + "'\n USE='&#x110000;'>" + more),
                      line + "not XML: invalid numeric character entity");
            EXPECT_EQ(refusal(head + "'\n USE='&#50'>" + more), line + "not XML: expected ;");
        }
        EXPECT_EQ(refusal(head + "'>\n<Sphere></Shape></Scene>"),
                  line + "</Shape> closes <Sphere> of line " + std::to_string(lines + 2));
    }
}

TEST(LoaderXml, RefusesWhatIsNotXml) {
    EXPECT_EQ(refusal(""), "scene.x3d: empty file: no root element");
    EXPECT_EQ(refusal(" \n\t\n"), "scene.x3d: empty file: no root element");
    EXPECT_EQ(refusal("<!-- only -->"), "scene.x3d: empty file: no root element");
    EXPECT_EQ(refusal("\nhello"), "scene.x3d: line 2: not XML: text before the root element");
    EXPECT_EQ(refusal("<Scene/>\njunk"), "scene.x3d: line 2: text after the root element");
    EXPECT_EQ(refusal("<Scene>\n<1/></Scene>"),
              "scene.x3d: line 2: not XML: an element's name expected");
    EXPECT_EQ(refusal(std::string("<Scene>\n\0</Scene>", 17)),
              "scene.x3d: line 2: not XML: a byte of value zero");
    EXPECT_EQ(refusal("\xff\xfe<"), "scene.x3d: UTF-16 text is not read: save it as UTF-8");
}

TEST(LoaderXml, RefusesTagsThatDoNotMatch) {
    EXPECT_EQ(refusal("<Scene>\n<Group>\n\n</Shape></Scene>"),
              "scene.x3d: line 4: </Shape> closes <Group> of line 2");
    EXPECT_EQ(refusal("<Scene>\n<Group>"), "scene.x3d: line 2: <Group> is never closed");
    EXPECT_EQ(refusal("<Scene/>\n</Scene>"), "scene.x3d: line 2: </Scene> closes nothing");
    EXPECT_EQ(refusal("<Scene/>\n<Scene/>"), "scene.x3d: line 2: a second root element <Scene>");
    EXPECT_EQ(refusal("<Scene>\n<Group"), "scene.x3d: line 2: the tag <Group has no end");
    EXPECT_EQ(refusal("<Scene>\n</Scene"), "scene.x3d: line 2: the tag </Scene has no end");
}

TEST(LoaderXml, RefusesAttributesThatAreNone) {
    EXPECT_EQ(refusal("<Scene>\n<Shape a='1'\n b='2' a='3'/></Scene>"),
              "scene.x3d: line 2: <Shape> has the attribute a twice");
    EXPECT_EQ(refusal("<Scene a>"), "scene.x3d: line 1: the attribute a has no value");
    EXPECT_EQ(refusal("<Scene a=1>"),
              "scene.x3d: line 1: the value of the attribute a is not in quotes");
    EXPECT_EQ(refusal("<Scene><Shape a='1><Sphere b='2'/></Shape></Scene>"),
              "scene.x3d: line 1: the value of the attribute a has no closing quote");
    EXPECT_EQ(refusal("<Scene a='1'b='2'/>"),
              "scene.x3d: line 1: not XML: a blank expected in the tag <Scene");
}

TEST(LoaderXml, RefusesSectionsWithoutAnEnd) {
    EXPECT_EQ(refusal("<Scene>\n<!-- "), "scene.x3d: line 2: comment without an end");
    EXPECT_EQ(refusal("<Scene>\n<![CDATA[ "), "scene.x3d: line 2: CDATA section without an end");
    EXPECT_EQ(refusal("\n<?xml "), "scene.x3d: line 2: processing instruction without an end");
    EXPECT_EQ(refusal("\n<!DOCTYPE X3D [ > "), "scene.x3d: line 2: DOCTYPE without an end");
}

TEST(LoaderXml, EveryPrefixOfAFileIsRefused) {
    const std::string text =
        "<?xml version='1.0'?><!DOCTYPE X3D [<!-- x -->]><X3D version='3.3'><!-- c --><Scene>"
        "<Shape><![CDATA[d]]><Sphere radius='2'/></Shape></Scene></X3D>";
    ASSERT_EQ(refusal(text), "");
    for (std::size_t size = 0; size < text.size(); ++size)
        EXPECT_NE(refusal(text.substr(0, size)), "") << "prefix of " << size << " bytes";
}

TEST(LoaderXml, RefusesDocumentsWithoutAScene) {
    EXPECT_EQ(refusal("<X3D version='3.3'>\n</X3D>"), "scene.x3d: X3D: has no Scene (line 1)");
    EXPECT_EQ(refusal("\n<svg/>"),
              "scene.x3d: svg: the root element is neither X3D nor Scene (line 2)");
    EXPECT_EQ(refusal("<X3D>\n<Scene/>\n<Scene/></X3D>"),
              "scene.x3d: Scene[2]: a second Scene (line 3)");
}

TEST(LoaderXml, NestingIsLimitedAtTheLimit) {
    for (const std::size_t limit : {std::size_t{5}, x3d::Limits{}.depth}) {
        x3d::Limits limits;
        limits.depth = limit;
        const auto nested = [](std::size_t depth) {
            return bare(repeated("<Transform translation='1 0 0'>", depth - 3) +
                        shape("<Sphere/>") + repeated("</Transform>", depth - 3));
        };
        // shape() nests three levels: Shape, Appearance, Material.
        const Scene below = load(nested(limit - 2), x3d::Headlight::kAuto, limits);
        EXPECT_EQ(std::get<Sphere>(below.objects.at(0).shape).center.x,
                  static_cast<double>(limit) - 5);
        const Scene at = load(nested(limit - 1), x3d::Headlight::kAuto, limits);
        EXPECT_EQ(std::get<Sphere>(at.objects.at(0).shape).center.x,
                  static_cast<double>(limit) - 4);
        EXPECT_EQ(
            refusal(nested(limit), limits),
            "scene.x3d: line 1: elements nested too deeply (limit " + std::to_string(limit) + ")");
    }
}

TEST(LoaderXml, AMillionNestedOrUnclosedElementsAreRefused) {
    const std::string open = repeated("<Group>", 1000000);
    EXPECT_NE(refusal("<Scene>" + open), "");
    EXPECT_NE(refusal("<Scene>" + open + repeated("</Group>", 1000000) + "</Scene>"), "");
}

TEST(LoaderXml, ElementsAreLimitedAtTheLimit) {
    x3d::Limits limits;
    limits.elements = 100;
    EXPECT_EQ(refusal(bare(repeated("<Group/>", 98)), limits), "");
    EXPECT_EQ(refusal(bare(repeated("<Group/>", 99)), limits), "");
    EXPECT_EQ(refusal(bare(repeated("<Group/>", 100)), limits),
              "scene.x3d: line 1: too many elements (limit 100)");
}

// Longer than the runs in which the document is handed to the parser.
TEST(LoaderXml, ALargeDocumentKeepsItsOrderAttributesAndLines) {
    std::string text = "<X3D version='3.3'>\n<Scene><Transform translation='0 5 0'>\n";
    const int count = 20000;
    for (int i = 0; i < count; ++i)
        text += "<Transform translation='" + std::to_string(i) +
                " 0 0'><Shape><Sphere/></Shape></Transform>\n";
    const std::string end = "</Transform></Scene></X3D>";
    const Scene scene = load(text + end);
    ASSERT_EQ(scene.objects.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        ASSERT_EQ(std::get<Sphere>(scene.objects[i].shape).center, (Point3{1.0 * i, 5, 0}));
    EXPECT_EQ(refusal(text + "<Shape><Sphere radius='x'/></Shape>" + end),
              "scene.x3d: Scene/Transform/Shape/Sphere@radius: \"x\" is not a number (line 20003)");
}

TEST(LoaderXml, FilesThatCannotBeReadAreNamed) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "nuvo_loader_xml_test";
    std::filesystem::create_directories(folder);
    const auto message = [](const std::filesystem::path& path) -> std::string {
        try {
            x3d::read_file(path);
        } catch (const x3d::Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(folder), folder.string() + ": is a folder, not a file");
    const std::filesystem::path missing = folder / "missing.x3d";
    EXPECT_EQ(message(missing), missing.string() + ": cannot be opened: No such file or directory");
    const std::filesystem::path good = folder / "good.x3d";
    std::ofstream(good) << "<Scene><Shape><Sphere/></Shape></Scene>";
    EXPECT_EQ(x3d::read_file(good).objects.size(), 1u);
    const std::filesystem::path empty = folder / "empty.x3d";
    std::ofstream{empty};
    EXPECT_EQ(message(empty), empty.string() + ": empty file: no root element");
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace nuvo
