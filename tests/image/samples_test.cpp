#include "nuvo/image/samples.h"

#include <gtest/gtest.h>

namespace nuvo::image {
namespace {

TEST(Samples, MeansAreRoundedToTheNearestHalvesUpwards) {
    Image samples(4, 2);
    // Left square: red sums to 2, a half of a quarter; green to 1; blue to 1020.
    samples.at(0, 0) = {1, 0, 255};
    samples.at(1, 0) = {0, 0, 255};
    samples.at(0, 1) = {0, 1, 255};
    samples.at(1, 1) = {1, 0, 255};
    samples.at(2, 0) = {255, 3, 0};
    samples.at(3, 1) = {254, 0, 0};  // 509 / 4 = 127.25; 3 / 4
    const Image mean = averaged(samples, 2);
    EXPECT_EQ(mean.width(), 2);
    EXPECT_EQ(mean.height(), 1);
    EXPECT_EQ(mean.at(0, 0), (Rgb8{1, 0, 255}));
    EXPECT_EQ(mean.at(1, 0), (Rgb8{127, 1, 0}));
}

TEST(Samples, OneSampleIsThePictureItself) {
    Image samples(3, 1);
    samples.at(1, 0) = {7, 8, 9};
    EXPECT_EQ(averaged(samples, 1), samples);
}

}  // namespace
}  // namespace nuvo::image
