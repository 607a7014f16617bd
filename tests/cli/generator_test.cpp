#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Outcome {
    int exit_code = -1;
    std::string text;
};

/// Runs the generator through the shell; `text` is what it wrote to standard output, or where the
/// arguments send the rest.
Outcome generate(const std::string& arguments) {
    Outcome outcome;
    const std::string command = std::string(NUVO_GENERATOR) + " " + arguments;
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 65536> buffer;
    std::size_t count = 0;
    while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
        outcome.text.append(buffer.data(), count);
    }
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string test_file(const std::string& name) {
    return read(fs::path(NUVO_SOURCE_DIR) / "testfiles" / (name + ".x3d"));
}

/// A folder that is empty at first and gone afterwards.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "nuvo_generator_XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr) path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

std::size_t occurrences(std::string_view text, std::string_view word) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + word.size())) {
        ++count;
    }
    return count;
}

/// The numbers of every attribute that starts with `start`, in order.
std::vector<std::vector<double>> number_lists(const std::string& text, const std::string& start) {
    std::vector<std::vector<double>> lists;
    for (auto at = text.find(start); at != text.npos; at = text.find(start, at + 1)) {
        const auto from = at + start.size();
        std::istringstream in(text.substr(from, text.find('\'', from) - from));
        lists.emplace_back(std::istream_iterator<double>(in), std::istream_iterator<double>());
    }
    return lists;
}

/// The scenes of testfiles/: all that need no --count.
std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    std::istringstream lines(generate("--list").text);
    for (std::string line; std::getline(lines, line);) {
        if (occurrences(line, "--count=N") == 0) names.push_back(line.substr(0, line.find(' ')));
    }
    return names;
}

// The listing as the thesis prints it, line numbers and all. They stand in a column of two places,
// so that line 5 starts with "5 " and line 10 with "10", and the text follows.
constexpr std::string_view kPrintedAppendixF =
    "1 <Scene>\n"
    "2   <Viewpoint position='0 0 10' />\n"
    "3   <Background groundColor=\"0.43 0.54 0.72\"\n"
    "4     skyColor=\"0.9 0.74 0.9\" />\n"
    "5   <SpotLight direction='0 0 -1' location='0 0 10' cutOffAngle='0.3' color='1 1\n"
    "6     1' beamWidth='0.1' />\n"
    "7   <Transform translation='0 0 0'>\n"
    "8     <Shape>\n"
    "9       <Sphere radius='4' />\n"
    "10      <Appearance>\n"
    "11        <Material diffuseColor='1.0 0 0' />\n"
    "12      </Appearance>\n"
    "13    </Shape>\n"
    "14  </Transform>\n"
    "15</Scene>\n";

TEST(Generator, ListsTheScenesOfTheThesisAndTheShowcase) {
    const std::vector<std::string> names = scene_names();
    const std::set<std::string> expected{
        "trianglemesh", "both",     "concentric", "clumped",   "teapot",    "figure19",
        "figure20",     "figure22", "appendixE",  "figure25",  "appendixF", "figure27",
        "figure28",     "figure29", "appendixG",  "icosphere", "showcase"};
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), expected);
    EXPECT_EQ(names.size(), expected.size());
}

TEST(Generator, WritesEveryTestFileAgainByteForByte) {
    for (const std::string& name : scene_names()) {
        const Outcome outcome = generate(name);
        EXPECT_EQ(outcome.exit_code, 0) << name;
        EXPECT_TRUE(outcome.text == test_file(name)) << name << " differs from testfiles/";
    }
}

TEST(Generator, AllWritesTheSameFilesIntoAFolderItMakes) {
    const TemporaryFolder folder;
    const fs::path made = folder.path() / "made" / "here";
    ASSERT_EQ(generate("--all --out=" + made.string()).exit_code, 0);
    for (const std::string& name : scene_names()) {
        EXPECT_TRUE(read(made / (name + ".x3d")) == test_file(name)) << name;
    }
    const auto files = fs::directory_iterator(made);
    EXPECT_EQ(std::distance(begin(files), end(files)), 17);
}

TEST(Generator, NeedsNoFileAndNoParticularFolder) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "pot.x3d";
    const std::string command =
        "cd / && " + std::string(NUVO_GENERATOR) + " teapot --out=" + file.string();
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(read(file) == test_file("teapot"));
}

TEST(Generator, WritesAppendixFAsPrintedBrokenAttributeIncluded) {
    std::string expected;
    std::istringstream lines{std::string(kPrintedAppendixF)};
    for (std::string line; std::getline(lines, line);) expected += line.substr(2) + "\n";
    EXPECT_EQ(generate("appendixF").text, expected);
}

TEST(Generator, WritesAppendicesEAndGWithThePrintedNumberOfLines) {
    EXPECT_EQ(occurrences(generate("appendixE").text, "\n"), 13U);
    EXPECT_EQ(occurrences(generate("appendixG").text, "\n"), 38U);
}

TEST(Generator, LeavesTheSpotLightOfFigure25ToItsDefaults) {
    const std::string text = generate("figure25").text;
    EXPECT_EQ(occurrences(text, "cutOffAngle"), 0U);
    EXPECT_EQ(occurrences(text, "beamWidth"), 0U);
    EXPECT_EQ(occurrences(text, "<SpotLight direction='0 0 -1' location='0 0 10' color='1 1 1' />"),
              1U);
}

TEST(Generator, LightsFigures27To29WithOnePrimaryEach) {
    const std::map<std::string, std::pair<std::string, std::string>> expected{
        {"figure27", {" color='1 0 0'", "fieldOfView='0.7'"}},
        {"figure28", {" color='0 1 0'", "fieldOfView='0.8'"}},
        {"figure29", {" color='0 0 1'", "fieldOfView='0.9'"}}};
    for (const auto& [name, attributes] : expected) {
        const std::string text = generate(name).text;
        EXPECT_EQ(occurrences(text, attributes.first), 1U) << name;
        EXPECT_EQ(occurrences(text, attributes.second), 1U) << name;
        EXPECT_EQ(occurrences(text, "diffuseColor='0.5 0.5 0.5'"), 1U) << name;
    }
}

TEST(Generator, WritesThePublishedNumberOfShapes) {
    const std::map<std::string, std::size_t> octahedra{
        {"trianglemesh", 728}, {"both", 1000}, {"clumped", 3200}};
    for (const auto& [name, count] : octahedra) {
        const std::string text = test_file(name);
        EXPECT_EQ(occurrences(text, "<Shape>"), count) << name;
        EXPECT_EQ(occurrences(text, "<IndexedTriangleSet "), count) << name;
        for (const auto& index : number_lists(text, " index='")) EXPECT_EQ(index.size(), 8U * 3U);
    }
    EXPECT_EQ(occurrences(test_file("concentric"), "<Shape>"), 5985U);
    EXPECT_EQ(occurrences(test_file("concentric"), "<Sphere radius='10'/>"), 5985U);
    EXPECT_EQ(occurrences(test_file("icosphere"), "<Shape>"), 4U);
}

TEST(Generator, WritesTheTeapotAsOneMeshWithoutDegenerateTriangles) {
    const std::string text = test_file("teapot");
    EXPECT_EQ(occurrences(text, "<Shape>"), 1U);
    const auto index = number_lists(text, " index='");
    const auto points = number_lists(text, " point='");
    ASSERT_EQ(index.size(), 1U);
    ASSERT_EQ(points.size(), 1U);
    ASSERT_EQ(index[0].size(), 25440U * 3U);
    // Six times the signed volume under the triangles: positive when they face outwards.
    double volume = 0;
    std::set<std::array<double, 3>> distinct;
    for (std::size_t i = 0; i < index[0].size(); i += 3) {
        std::array<std::array<double, 3>, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(index[0][i + k]);
            ASSERT_LT(at * 3, points[0].size());
            p[k] = {points[0][3 * at], points[0][3 * at + 1], points[0][3 * at + 2]};
            distinct.insert(p[k]);
        }
        EXPECT_TRUE(p[0] != p[1] && p[1] != p[2] && p[2] != p[0]) << "triangle " << i / 3;
        volume += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                  p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                  p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    EXPECT_GT(volume, 0);
    EXPECT_EQ(distinct.size() * 3, points[0].size()) << "equal points are to be one corner";
}

TEST(Generator, PutsTheSpheresOfTest3OnFiveShellsAnd90OntoOthers) {
    std::map<int, int> shells;
    std::set<std::vector<double>> places;
    for (const auto& center : number_lists(test_file("concentric"), "translation='")) {
        ASSERT_EQ(center.size(), 3U);
        const double distance = std::hypot(center[0], center[1], center[2]);
        // Sines, cosines and products in float.
        const double shell = 250 * std::round(distance / 250);
        EXPECT_NEAR(distance, shell, 1e-6 * shell);
        ++shells[static_cast<int>(shell)];
        places.insert(center);
    }
    EXPECT_EQ(shells, (std::map<int, int>{
                          {500, 1197}, {750, 1197}, {1000, 1197}, {1250, 1197}, {1500, 1197}}));
    EXPECT_EQ(places.size(), 5985U - 90U);
}

// Against the mathematical library's double precision, rounded: the nearest float.
TEST(Generator, PlacesTheSpheresOfTest3WhereTheFormulaDoes) {
    const auto centers = number_lists(test_file("concentric"), "translation='");
    std::size_t at = 0;
    for (int d = 1500; d >= 500; d -= 250)
        for (float i = 0; i <= 2 * 3.14159265; i = static_cast<float>(i + 0.1))
            for (int j = 1; j < 20; ++j, ++at) {
                const double around = static_cast<double>(i * static_cast<float>(j));
                const auto sine = static_cast<float>(std::sin(around));
                const auto distance = static_cast<float>(d);
                const std::array<float, 3> expected{
                    distance * static_cast<float>(std::cos(static_cast<double>(i))) * sine,
                    distance * static_cast<float>(std::sin(static_cast<double>(i))) * sine,
                    distance * static_cast<float>(std::cos(around))};
                ASSERT_LT(at, centers.size());
                for (std::size_t axis = 0; axis < 3; ++axis)
                    ASSERT_EQ(static_cast<float>(centers[at][axis]), expected[axis]) << at;
            }
    EXPECT_EQ(at, centers.size());
}

// The first and last positions that the author's program printed.
TEST(Generator, DrawsTheAuthorsRandomNumbers) {
    const auto random = number_lists(test_file("both"), "translation='");
    EXPECT_EQ(random.at(0), (std::vector<double>{-117, 386, 277}));
    EXPECT_EQ(random.at(1), (std::vector<double>{293, -165, -114}));
    const auto points = number_lists(test_file("both"), "point='");
    EXPECT_EQ(points.at(0).at(0), 9);
    EXPECT_EQ(points.at(1).at(0), 13);
    const auto clumps = number_lists(test_file("clumped"), "translation='");
    EXPECT_EQ(clumps.at(0), (std::vector<double>{-1286, -1265, -1285}));
    EXPECT_EQ(clumps.at(1), (std::vector<double>{-1244, -1286, -1258}));
    EXPECT_EQ(clumps.back(), (std::vector<double>{1249, 1362, 1467}));
}

TEST(Generator, WalksFiftyStepsInEachClumpOfTest4) {
    const auto centers = number_lists(test_file("clumped"), "translation='");
    ASSERT_EQ(centers.size(), 3200U);
    for (std::size_t i = 1; i < centers.size(); ++i) {
        if (i % 50 == 0) continue;  // another clump
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_LT(std::abs(centers[i][axis] - centers[i - 1][axis]), 50) << i;
    }
}

TEST(Generator, LeavesTheMiddleOfTest1ToTheLight) {
    std::set<std::vector<double>> centers;
    for (const auto& center : number_lists(test_file("trianglemesh"), "translation='")) {
        centers.insert(center);
    }
    EXPECT_EQ(centers.size(), 728U);
    EXPECT_FALSE(centers.contains({0, 0, 0}));
    EXPECT_TRUE(centers.contains({20, 0, 0}));
    EXPECT_TRUE(centers.contains({-80, 80, -80}));
}

TEST(Generator, AnotherSeedChangesTheScenesForMeasuringAndNoOthers) {
    for (const std::string name :
         {"spheres --count=20", "octahedra --count=20", "aisles --count=20", "drift --count=20",
          "stadium --count=20", "sticks --count=20", "sizes --count=20"}) {
        const std::string text = generate(name).text;
        EXPECT_TRUE(generate(name + " --seed=2").text == text) << name;
        const std::string other = generate(name + " --seed=1").text;
        EXPECT_FALSE(other == text) << name;
        EXPECT_EQ(occurrences(other, "<Shape>"), occurrences(text, "<Shape>"));
        EXPECT_TRUE(generate(name + " --seed=1").text == other) << name;
    }
    for (const std::string name : {"appendixE", "both", "clumped", "teapot"}) {
        EXPECT_TRUE(generate(name + " --seed=1").text == test_file(name)) << name;
    }
    EXPECT_EQ(generate("both --seed=18446744073709551615").exit_code, 0);
}

// Seeds 0 to 4 step from a hall 16 times as wide as the cluster to one 4,096 times as wide.
TEST(Generator, WidensTheStudysStadiumFromSeedToSeed) {
    const auto widest_cluster = [](const std::string& seed) {
        const auto centers =
            number_lists(generate("stadium --count=100 --seed=" + seed).text, "translation='");
        EXPECT_EQ(centers.size(), 100U);
        double widest = 0;
        for (std::size_t i = 1; i < centers.size(); i += 2)
            for (std::size_t axis = 0; axis < 3; ++axis)
                widest = std::max(widest, std::abs(centers.at(i)[axis] - centers.at(1)[axis]));
        return widest;
    };
    EXPECT_GT(widest_cluster("0"), 1000 / 16 / 2);
    EXPECT_LE(widest_cluster("0"), 1000 / 16 + 1);
    EXPECT_GT(widest_cluster("4"), 1000. / 4096 / 2);
    EXPECT_LE(widest_cluster("4"), 1000. / 4096);
}

/// The camera's distance from the scene's front and half the scene's height, from what the file
/// says: `reach` is how far a shape goes from its centre.
std::array<double, 2> distance_and_half_height(const std::string& text, double reach) {
    const double z = number_lists(text, "Viewpoint position='").at(0).at(2);
    double front = 0;
    double half_height = 0;
    for (const auto& center : number_lists(text, "translation='")) {
        front = std::max(front, center[2] + reach);
        half_height = std::max(half_height, std::abs(center[1]) + reach);
    }
    return {z - front, half_height};
}

TEST(Generator, FarFitsThePicturesHeightAndNearStandsAtThreeTenthsOfThat) {
    // The sizes of test 2 differ: its camera is not checked to the last unit.
    const std::map<std::string, double> reach{
        {"trianglemesh", 2}, {"concentric", 10}, {"clumped", 15}};
    for (const auto& [name, radius] : reach) {
        const auto far = distance_and_half_height(generate(name + " --camera=far").text, radius);
        const auto near = distance_and_half_height(generate(name + " --camera=near").text, radius);
        // The front just fits, 45 degrees high with a twentieth to spare.
        const double seen = far[0] * std::tan(std::acos(-1.0) / 8);
        EXPECT_NEAR(seen, 1.05 * far[1], 0.5) << name;  // whole units
        EXPECT_NEAR(near[0], 0.3 * far[0], 1) << name;
    }
}

TEST(Generator, TheTeapotFitsFromFarAndKeepsItsMesh) {
    const std::string own = test_file("teapot");
    const std::string far = generate("teapot --camera=far").text;
    const double z = number_lists(far, "Viewpoint position='").at(0).at(2);
    double front = 0;
    double top = 0;
    const std::vector<double> points = number_lists(far, " point='").at(0);
    for (std::size_t i = 0; i < points.size(); i += 3) {
        top = std::max(top, points[i + 1]);
        front = std::max(front, points[i + 2]);
    }
    // The pot stands on y = 0.
    EXPECT_NEAR((z - front) * std::tan(std::acos(-1.0) / 8), 1.05 * top / 2, 1e-5);
    const auto mesh = own.find("<Shape>");
    EXPECT_TRUE(far.substr(far.find("<Shape>")) == own.substr(mesh));
}

TEST(Generator, WritesAsManySpheresOrOctahedraAsAsked) {
    const std::string spheres = generate("spheres --count=1000").text;
    const auto centers = number_lists(spheres, "translation='");
    EXPECT_EQ(centers.size(), 1000U);
    EXPECT_EQ(occurrences(spheres, "<Sphere radius='1'/>"), 1000U);
    for (const auto& center : centers)
        for (const double x : center) EXPECT_LE(std::abs(x), 50);  // 10 radii each
    const std::string octahedra = generate("octahedra --count=125 --seed=5").text;
    EXPECT_EQ(occurrences(octahedra, "<Shape>"), 1U);
    const auto index = number_lists(octahedra, " index='").at(0);
    const auto points = number_lists(octahedra, " point='").at(0);
    EXPECT_EQ(index.size(), 125U * 8 * 3);
    EXPECT_EQ(points.size(), 125U * 6 * 3);
    for (const double corner : index) EXPECT_LT(corner, 125 * 6);
    for (const double x : points) EXPECT_LE(std::abs(x), 250 + 7.5);  // 5 * 100 wide
    EXPECT_FALSE(octahedra == generate("octahedra --count=125").text);
}

TEST(Generator, WritesScenesLikeThosePeopleRenderInTheSizeAsked) {
    const auto triangles = [](const std::string& arguments) {
        const std::string text = generate(arguments).text;
        EXPECT_EQ(occurrences(text, "<Shape>"), 1U) << arguments;
        return number_lists(text, " index='").at(0).size() / 3;
    };
    EXPECT_EQ(triangles("terrain --count=1250"), 2U * 25 * 25);
    // Houses and the ground, boxes of 12 triangles.
    EXPECT_EQ(triangles("city --count=10"), 12U * (10 + 1));
    EXPECT_EQ(triangles("city --count=10 --camera=near"), 12U * (10 + 1));
    // A room: floor, ceiling, four walls, four legs, a table; balls after 4 and 3 subdivisions.
    EXPECT_EQ(triangles("interior --count=2"), 2U * (12 * 11 + 2 * 20 * 256 + 3 * 20 * 64));
    // A car: two boxes, four wheels, a hundred bolts after one subdivision.
    EXPECT_EQ(triangles("assembly --count=2"), 2U * (2 * 12 + 4 * 20 * 256 + 100 * 20 * 4));
    EXPECT_EQ(triangles("floor --count=1000"), 20U * 4096 + 12);
    EXPECT_EQ(occurrences(generate("molecule --count=50").text, "<Sphere "), 50U);
    EXPECT_EQ(occurrences(generate("molecule --count=50 --seed=9").text, "<Sphere "), 50U);
}

TEST(Generator, RefusesMisuseWithTwoAndOneLineThatSaysWhy) {
    const TemporaryFolder folder;
    const std::string out = " --out=" + (folder.path() / "never").string();
    const std::map<std::string, std::string> wrong{
        {"", "the name of one scene"},
        {"nosuch" + out, "no scene is called nosuch"},
        {"Both" + out, "no scene is called Both"},
        {"trianglemesh both" + out, "two scenes: trianglemesh and both"},
        {"--all", "--all needs --out"},
        {"--all trianglemesh" + out, "the name of one scene"},
        {"--list" + out, "--list takes no --out"},
        {"trianglemesh --out=", "--out= needs a name"},
        {"both --seed=" + out, "--seed=: not a whole number"},
        {"both --seed=-1" + out, "--seed=-1: not a whole number"},
        {"both --seed=1.5" + out, "--seed=1.5: not a whole number"},
        {"both --seed=18446744073709551616" + out, "not a whole number"},
        {"both --sed=1" + out, "unknown option --sed=1"},
        {"both --camera=middle" + out, "--camera=middle: neither far nor near"},
        {"both --count=2" + out, "both takes no --count"},
        {"appendixE --camera=far" + out, "appendixE takes no --camera"},
        {"spheres" + out, "spheres needs --count=N"},
        {"octahedra --count=1e6" + out, "--count=1e6: not a whole number"},
        {"--all --camera=far" + out, "--all takes no --camera"}};
    for (const auto& [arguments, message] : wrong) {
        const Outcome outcome = generate(arguments + " 2>&1 >/dev/null");
        EXPECT_EQ(outcome.exit_code, 2) << arguments;
        const std::string first_line = outcome.text.substr(0, outcome.text.find('\n'));
        EXPECT_EQ(occurrences(first_line, message), 1U) << arguments << ": " << first_line;
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Generator, SaysWhichFileItCannotWrite) {
    const TemporaryFolder folder;
    const std::string missing = (folder.path() / "no" / "such.x3d").string();
    const Outcome no_folder = generate("trianglemesh --out=" + missing + " 2>&1");
    EXPECT_EQ(no_folder.exit_code, 4);
    EXPECT_EQ(occurrences(no_folder.text, missing), 1U) << no_folder.text;
    if (fs::exists("/dev/full")) {
        EXPECT_EQ(generate("trianglemesh --out=/dev/full 2>/dev/null").exit_code, 4);
        EXPECT_EQ(generate("trianglemesh 2>/dev/null >/dev/full").exit_code, 4);
        EXPECT_EQ(generate("--all --out=/dev/full 2>/dev/null").exit_code, 4);
    }
}

TEST(Generator, ExplainsItselfOnRequest) {
    const Outcome outcome = generate("-h");
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* option : {"--list", "--all", "--seed=N", "--out=", "--camera=", "--count=N"}) {
        EXPECT_GE(occurrences(outcome.text, option), 1U) << option;
    }
}

}  // namespace
