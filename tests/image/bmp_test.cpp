#include "nuvo/image/bmp.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace nuvo::image {
namespace {

std::uint32_t little_endian(const std::string& bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = count - 1; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

// 3 x 2: red green blue above white grey black.
Image example() {
    Image image(3, 2);
    image.at(0, 0) = {255, 0, 0};
    image.at(1, 0) = {0, 255, 0};
    image.at(2, 0) = {0, 0, 255};
    image.at(0, 1) = {255, 255, 255};
    image.at(1, 1) = {1, 2, 3};
    return image;
}

TEST(Bmp, HeaderHasTheFieldsOfTheFormat) {
    const std::string bytes = encode_bmp(example());
    ASSERT_EQ(bytes.size(), 14u + 40u + 2u * 12u);
    EXPECT_EQ(bytes.substr(0, 2), "BM");
    EXPECT_EQ(little_endian(bytes, 2, 4), bytes.size());
    EXPECT_EQ(little_endian(bytes, 6, 4), 0u);
    EXPECT_EQ(little_endian(bytes, 10, 4), 54u);
    EXPECT_EQ(little_endian(bytes, 14, 4), 40u);
    EXPECT_EQ(little_endian(bytes, 18, 4), 3u);
    EXPECT_EQ(little_endian(bytes, 22, 4), 2u);
    EXPECT_EQ(little_endian(bytes, 26, 2), 1u);
    EXPECT_EQ(little_endian(bytes, 28, 2), 24u);
    EXPECT_EQ(little_endian(bytes, 30, 4), 0u);
    EXPECT_EQ(little_endian(bytes, 34, 4), 24u);
}

TEST(Bmp, RowsStandBottomUpBlueFirstPaddedToFourBytes) {
    const std::string pixels = encode_bmp(example()).substr(54);
    const unsigned char expected[] = {255, 255, 255, 3, 2,   1, 0,   0, 0, 0, 0, 0,
                                      0,   0,   255, 0, 255, 0, 255, 0, 0, 0, 0, 0};
    EXPECT_EQ(pixels, std::string(std::begin(expected), std::end(expected)));
}

TEST(Bmp, EveryWidthPadsToAMultipleOfFour) {
    for (int width = 1; width <= 9; ++width) {
        const std::size_t row = encode_bmp(Image(width, 1)).size() - 54;
        EXPECT_EQ(row % 4, 0u) << width;
        EXPECT_GE(row, 3u * static_cast<std::size_t>(width));
        EXPECT_LT(row, 3u * static_cast<std::size_t>(width) + 4);
    }
}

TEST(Bmp, TheFileHoldsTheEncodedBytesAlsoBeyondOneChunk) {
    Image image(700, 900);  // 1.9 MB: more than one write
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                              static_cast<std::uint8_t>(x * y)};
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "nuvo_bmp_test_chunks.bmp";
    write_bmp(path, image);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::filesystem::remove(path);
    EXPECT_TRUE(bytes == encode_bmp(image));
}

}  // namespace
}  // namespace nuvo::image
