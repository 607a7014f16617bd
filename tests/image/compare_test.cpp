#include "nuvo/image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace nuvo::image {
namespace {

TEST(Compare, EqualPicturesHaveNoErrorAndInfinitePsnr) {
    const Difference d = compare(Image(4, 3), Image(4, 3));
    EXPECT_TRUE(d.equal());
    EXPECT_EQ(d.max_difference, 0);
    EXPECT_EQ(d.x, -1);
    EXPECT_EQ(d.y, -1);
    EXPECT_EQ(d.rms, 0);
    EXPECT_TRUE(std::isinf(d.psnr_db));
}

TEST(Compare, FindsTheFirstLargestDifferenceWhicheverPictureIsBrighter) {
    Image a(4, 3), b(4, 3);
    a.at(3, 0) = {0, 7, 0};
    b.at(1, 2) = {0, 0, 90};
    b.at(2, 2) = {90, 0, 0};
    const Difference d = compare(a, b);
    EXPECT_EQ(d.differing_pixels, 3u);
    EXPECT_EQ(d.max_difference, 90);
    EXPECT_EQ(d.x, 1);
    EXPECT_EQ(d.y, 2);
}

TEST(Compare, RmsAndPsnrMatchTheHandCalculation) {
    // 2 x 1 pixels, 6 channels, squares 9 + 16 + 144 = 169: rms = sqrt(169 / 6).
    Image a(2, 1), b(2, 1);
    a.at(0, 0) = {3, 0, 10};
    b.at(0, 0) = {0, 4, 10};
    b.at(1, 0) = {0, 0, 12};
    const Difference d = compare(a, b);
    EXPECT_DOUBLE_EQ(d.rms, 13 / std::sqrt(6.0));
    EXPECT_NEAR(d.psnr_db, 33.63345, 1e-5);  // 10 log10(65025 * 6 / 169)
}

TEST(Compare, OppositePicturesReachTheEndsOfTheScale) {
    Image black(3, 3), white(3, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) white.at(x, y) = {255, 255, 255};
    const Difference d = compare(black, white);
    EXPECT_EQ(d.max_difference, 255);
    EXPECT_EQ(d.rms, 255);
    EXPECT_EQ(d.psnr_db, 0);
    EXPECT_EQ(d.differing_pixels, 9u);
}

TEST(Compare, PicturesOfDifferentSizesAreRefused) {
    EXPECT_THROW(compare(Image(2, 3), Image(3, 2)), std::invalid_argument);
    EXPECT_THROW(difference_picture(Image(2, 3), Image(3, 2)), std::invalid_argument);
}

TEST(DifferencePicture, IsBlackWhereEqualAndVisibleWhereNot) {
    Image a(3, 1), b(3, 1);
    b.at(1, 0) = {1, 0, 0};
    a.at(2, 0) = {0, 100, 50};
    const Image picture = difference_picture(a, b);
    EXPECT_EQ(picture.at(0, 0), (Rgb8{0, 0, 0}));
    EXPECT_EQ(picture.at(1, 0), (Rgb8{66, 0, 0}));     // 64 + 1.91
    EXPECT_EQ(picture.at(2, 0), (Rgb8{0, 255, 160}));  // 64 + 95.5, up
}

TEST(DifferencePicture, OfEqualPicturesIsBlack) {
    Image a(2, 2);
    a.at(1, 1) = {9, 9, 9};
    EXPECT_EQ(difference_picture(a, a), Image(2, 2));
}

}  // namespace
}  // namespace nuvo::image
