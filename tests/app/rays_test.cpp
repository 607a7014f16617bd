#include "nuvo/app/rays.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <limits>
#include <string>

namespace nuvo::app {
namespace {

std::string error_of(const std::string& text) {
    try {
        parse_rays(text, "R");
    } catch (const RaysError& error) {
        return error.what();
    }
    return {};
}

TEST(Rays, NumbersAreReadAsWrittenAndBlankLinesSkipped) {
    const auto rays = parse_rays("0 1 2 3 4 5\n\n  \t\n-0 1e-3 .5\t0 -0.0 -2\r\n", "R");
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_EQ(rays[0].origin, (Point3{0, 1, 2}));
    EXPECT_EQ(rays[0].direction, (Vector3{3, 4, 5}));
    EXPECT_EQ(rays[1].origin, (Point3{0, 0.001, 0.5}));
    EXPECT_EQ(rays[1].direction, (Vector3{0, 0, -2}));
    EXPECT_TRUE(std::signbit(rays[1].origin.x));
    EXPECT_TRUE(std::signbit(rays[1].direction.y));
}

TEST(Rays, ExtremesOfDoubleAreReadToTheBit) {
    const auto rays = parse_rays(
        "1.7976931348623157e308 4.9406564584124654e-324 0.1 2.2250738585072011e-308 1e-400 1", "R");
    ASSERT_EQ(rays.size(), 1u);
    EXPECT_EQ(rays[0].origin, (Point3{DBL_MAX, DBL_TRUE_MIN, 0.1}));
    EXPECT_EQ(rays[0].direction, (Vector3{0x0.fffffffffffffp-1022, 0, 1}));
}

TEST(Rays, AnEmptyFileHasNoRays) {
    EXPECT_TRUE(parse_rays("", "R").empty());
    EXPECT_TRUE(parse_rays("\n\n", "R").empty());
}

TEST(Rays, MalformedLinesAreNamedByNumber) {
    for (const char* bad : {"0 0 0 0 0", "0 0 0 0 0 1 1", "0 0 0 0 0 x", "0 0 0 0 0 nan",
                            "0 0 inf 0 0 1", "0 0 1e400 0 0 1", "0 0 0 0 0 0", "0 0 0 0 -0 0",
                            "0,0,0,0,0,1", "# comment", "0 0 0 0 0 1m", "0x1 0 0 0 0 1"}) {
        EXPECT_EQ(error_of(std::string("0 0 0 0 0 1\n\n") + bad + "\n").rfind("R: line 3: ", 0), 0u)
            << bad;
    }
}

TEST(Rays, AFileThatCannotBeReadIsNamed) {
    EXPECT_THROW(read_rays(testing::TempDir()), RaysError);
    EXPECT_THROW(read_rays(testing::TempDir() + "/nuvo/no/such/file"), RaysError);
}

TEST(Rays, AnswersHaveSeventeenDigits) {
    const RayAnswer answers[] = {
        {true, 3, 7, 0.1},
        {false, -1, -1, std::numeric_limits<double>::infinity()},
        {true, 0, 0, 2},
    };
    EXPECT_EQ(answers_text(answers), "1 3 7 0.10000000000000001\n0 -1 -1 inf\n1 0 0 2\n");
}

}  // namespace
}  // namespace nuvo::app
