#include "nuvo/image/heat_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "nuvo/image/viridis.h"

namespace nuvo::image {
namespace {

TEST(Viridis, IsThePublishedTable) {
    // matplotlib: viridis(0), (0.5), (1), and the gray values rise.
    EXPECT_EQ(viridis(0), (Rgb8{0x44, 0x01, 0x54}));
    EXPECT_EQ(viridis(0.5), (Rgb8{0x21, 0x91, 0x8c}));
    EXPECT_EQ(viridis(1), (Rgb8{0xfd, 0xe7, 0x25}));
    const auto gray = [](Rgb8 c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; };
    for (int i = 8; i <= 255; ++i)  // a step is less than bytes can tell
        EXPECT_GT(gray(viridis(i / 255.0)), gray(viridis((i - 8) / 255.0))) << i;
}

TEST(Viridis, EndsHoldForAllOutside) {
    EXPECT_EQ(viridis(-3), viridis(0));
    EXPECT_EQ(viridis(std::numeric_limits<double>::quiet_NaN()), viridis(0));
    EXPECT_EQ(viridis(std::numeric_limits<double>::infinity()), viridis(1));
}

// The rows of the strip below the values that are not all of one color.
bool has_ink(const Image& image, int first_row, int left, int right) {
    for (int y = first_row; y < image.height(); ++y)
        for (int x = left; x < right; ++x)
            if (image.at(x, y) == Rgb8{230, 230, 230}) return true;
    return false;
}

TEST(HeatMap, PaintsEachValueByItsShareOfTheScale) {
    const std::vector<double> values{0, 1, 2, 3, 4, 9};
    const Image image = heat_map(values, 3, {"tests", 4, {}});
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
            EXPECT_EQ(image.at(x, y), viridis(values[static_cast<std::size_t>(3 * y + x)] / 4));
    EXPECT_EQ(image.at(2, 1), viridis(1));  // 9 is beyond the scale
}

TEST(HeatMap, OneScaleMeansTheSameColorsAndTheSameBar) {
    const std::vector<double> low(200 * 50, 3.0);
    const std::vector<double> high(200 * 50, 12.0);
    const Image a = heat_map(low, 200, {"tests", 12, {}});
    const Image b = heat_map(high, 200, {"tests", 12, {}});
    EXPECT_EQ(a.at(0, 0), viridis(0.25));
    EXPECT_EQ(b.at(0, 0), viridis(1));
    ASSERT_EQ(a.height(), b.height());
    for (int y = 50; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) EXPECT_EQ(a.at(x, y), b.at(x, y));
}

TEST(HeatMap, TheBarRunsFromTheFirstColorToTheLastAndHasNumbers) {
    const Image image = heat_map(std::vector<double>(300 * 40, 1.0), 300, {"tests", 80, {}});
    int row = 40;
    while (row < image.height() && image.at(4, row) != viridis(0)) ++row;
    ASSERT_LT(row, image.height());
    EXPECT_EQ(image.at(295, row), viridis(1));
    EXPECT_EQ(image.at(150, row), viridis(146.0 / 291));
    EXPECT_TRUE(has_ink(image, row, 0, 20));     // 0
    EXPECT_TRUE(has_ink(image, row, 140, 160));  // 40
    EXPECT_TRUE(has_ink(image, row, 280, 300));  // 80
    EXPECT_FALSE(has_ink(image, row, 100, 130));
}

TEST(HeatMap, OtherScalesShowOtherNumbers) {
    const std::vector<double> values(300 * 4, 1.0);
    EXPECT_FALSE(heat_map(values, 300, {"tests", 80, {}}) ==
                 heat_map(values, 300, {"tests", 81, {}}));
    EXPECT_FALSE(heat_map(values, 300, {"tests", 80, {}}) ==
                 heat_map(values, 300, {"cells", 80, {}}));
}

TEST(HeatMap, NamedValuesHaveAFieldEach) {
    const Image image =
        heat_map(std::vector<double>(300, 2.0), 300, {"stage", 2, {"cheap", "wider", "exact"}});
    int row = 1;
    while (row < image.height() && image.at(4, row) != viridis(0)) ++row;
    ASSERT_LT(row, image.height());
    EXPECT_EQ(image.at(90, row), viridis(0));
    EXPECT_EQ(image.at(150, row), viridis(0.5));
    EXPECT_EQ(image.at(290, row), viridis(1));
}

TEST(HeatMap, AnySizeHasItsScale) {
    for (const int width : {1, 2, 7, 199, 201, 959, 960, 2000}) {
        const Image image = heat_map(std::vector<double>(static_cast<std::size_t>(width), 0.0),
                                     width, {"tests", 123456789, {}});
        EXPECT_GE(image.width(), std::max(width, 200));
        EXPECT_TRUE(has_ink(image, 1, 0, image.width()));
    }
}

}  // namespace
}  // namespace nuvo::image
