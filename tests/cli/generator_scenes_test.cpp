// The scenes of the thesis: its listings, its figures, its tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/generator_runner.h"

namespace nuvo::generator_test {
namespace {

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

}  // namespace
}  // namespace nuvo::generator_test
