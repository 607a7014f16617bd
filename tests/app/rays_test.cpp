#include "nuvo/app/rays.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

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
    for (const char* bad :
         {"0 0 0 0 0", "0 0 0 0 0 1 1", "0 0 0 0 0 x", "0 0 0 0 0 nan", "0 0 inf 0 0 1",
          "0 0 1e400 0 0 1", "0 0 0 0 0 0", "0 0 0 0 -0 0", "0,,0,0,0,0,1", ",0,0,0,0,0,1",
          "0,0,0,0,0,1,", "0 0 0 0 0 # 1", "0;0 0 0 0 1", "0 0 0 0 0 1m", "0x1 0 0 0 0 1"}) {
        EXPECT_EQ(error_of(std::string("0 0 0 0 0 1\n\n") + bad + "\n").rfind("R: line 3: ", 0), 0u)
            << bad;
    }
}

TEST(Rays, CommasAndCommentsAreTaken) {
    const auto rays = parse_rays(
        "# ox,oy,oz,dx,dy,dz\n0,1,2,3,4,5\n0, 1 ,2\t3 ,4 5 # a remark\n  # 1 2 3\n#", "R");
    ASSERT_EQ(rays.size(), 2u);
    for (const Ray& ray : rays) {
        EXPECT_EQ(ray.origin, (Point3{0, 1, 2}));
        EXPECT_EQ(ray.direction, (Vector3{3, 4, 5}));
    }
}

/// An array of NumPy by hand: version 1, a header of 118 bytes.
std::string array_file(std::string dictionary, const std::vector<double>& values) {
    dictionary.resize(117, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\0v\0", 10) + dictionary + "\n";
    for (const double value : values)
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return bytes;
}

TEST(Rays, AnArrayOfNumPyIsRead) {
    const std::string shape = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 6), }";
    std::vector<double> values{0, 1, 2, 3, 4, 5, 0.1, -0.0, 1e300, 0, 0, -1};
    const auto rays = parse_rays(array_file(shape, values), "R");
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_EQ(rays[0].direction, (Vector3{3, 4, 5}));
    EXPECT_EQ(rays[1].origin, (Point3{0.1, 0, 1e300}));
    values[5] = values[3] = values[4] = 0;
    EXPECT_EQ(error_of(array_file(shape, values)), "R: row 0: the direction is zero");
    values[5] = 1;
    values[7] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error_of(array_file(shape, values)), "R: row 1: a number is not finite");
    EXPECT_EQ(
        error_of(array_file("{'descr': '<f8', 'fortran_order': False, 'shape': (12,), }", values)),
        "R: array: is not of n x 6 numbers, a ray a row");
    EXPECT_EQ(error_of(array_file(shape, {1, 2, 3})).rfind("R: array: holds 24 bytes", 0), 0u);
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

TEST(Rays, AnswersAreRecordsForNumPy) {
    const RayAnswer answers[] = {{true, 3, 7, 0.1},
                                 {false, -1, -1, std::numeric_limits<double>::infinity()}};
    const HitPlace places[] = {{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 1, 0}}};
    std::string dictionary =
        "{'descr': [('hit', '|b1'), ('shape', '<i8'), ('triangle', '<i8'), ('t', '<f8'), "
        "('normal', '<f8', (3,))], 'fortran_order': False, 'shape': (2,), }";
    dictionary.resize(181, ' ');  // 192 bytes with what stands before and behind
    std::string expected = std::string("\x93NUMPY\x01\0\xb6\0", 10) + dictionary + "\n";
    const auto put = [&expected](auto value) {
        expected.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (int i = 0; i < 2; ++i) {
        put(answers[i].hit);
        put(answers[i].shape);
        put(answers[i].triangle);
        put(answers[i].t);
        for (const double x : {places[i].normal.x, places[i].normal.y, places[i].normal.z}) put(x);
    }
    EXPECT_EQ(answers_npy(answers, places, {}, {false, true}), expected);
}

TEST(Rays, NamesAreToldAsColumnsOfTextAndOfBytes) {
    const double none = std::numeric_limits<double>::infinity();
    const RayAnswer answers[] = {
        {true, 0, 7, 2}, {false, -1, -1, none}, {true, 1, 0, 3}, {true, 2, 0, 4}};
    const std::string names[] = {"Roof", "", "old \tbarn"};
    EXPECT_EQ(answers_text(answers, {}, names, {false, false, true}),
              "1 0 7 2 Roof\n0 -1 -1 inf -\n1 1 0 3 -\n1 2 0 4 old__barn\n");
    const std::string array = answers_npy(answers, {}, names, {false, false, true});
    EXPECT_NE(array.find("('t', '<f8'), ('def', '|S9')]"), std::string::npos) << array;
    const std::size_t record = 1 + 3 * 8 + 9;
    const std::string rows = array.substr(array.size() - 4 * record);
    EXPECT_EQ(rows.substr(record - 9, 9), std::string("Roof\0\0\0\0\0", 9));
    EXPECT_EQ(rows.substr(2 * record - 9, 9), std::string(9, '\0'));
    EXPECT_EQ(rows.substr(4 * record - 9, 9), "old \tbarn");
}

TEST(Rays, AnArrayCutsNamesThatAreTooLong) {
    const RayAnswer hit[] = {{true, 0, 0, 1}};
    const std::string names[] = {std::string(100'000, 'x')};
    const std::string array = answers_npy(hit, {}, names, {false, false, true});
    EXPECT_NE(array.find("'|S256'"), std::string::npos);
    EXPECT_LT(array.size(), 1000U);
    EXPECT_GT(answers_text(hit, {}, names, {false, false, true}).size(), 100'000U);
}

}  // namespace
}  // namespace nuvo::app
