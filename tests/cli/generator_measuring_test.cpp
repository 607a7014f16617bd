// Scenes for measuring: of any size, any seed, from far and near.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/generator_runner.h"

namespace nuvo::generator_test {
namespace {

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

}  // namespace
}  // namespace nuvo::generator_test
