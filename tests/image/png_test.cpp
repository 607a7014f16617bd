#include "nuvo/image/png.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "nuvo/image/file_writer.h"
#include "nuvo/image/picture_file.h"
#include "png_decoder.h"

namespace nuvo::image {
namespace {

Image example(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                              static_cast<std::uint8_t>(x * x * y)};
    return image;
}

TEST(Png, ADecoderOfTheSpecificationReadsEveryPixel) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{3, 2}, std::pair{1, 300},
                                        std::pair{257, 1}, std::pair{311, 240}}) {
        const Image image = example(width, height);
        EXPECT_TRUE(decoded(encode_png(image)) == image) << width << " x " << height;
    }
}

TEST(Png, TheFileHoldsTheEncodedBytesAlsoBeyondOneChunk) {
    Image image(1500, 900);  // noise: nothing to compress
    std::uint32_t noise = 1;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            noise = noise * 1664525 + 1013904223;
            image.at(x, y) = {static_cast<std::uint8_t>(noise >> 8),
                              static_cast<std::uint8_t>(noise >> 16),
                              static_cast<std::uint8_t>(noise >> 24)};
        }
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "nuvo_png_test_chunks.png";
    write_png(path, image);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::filesystem::remove(path);
    EXPECT_GT(bytes.size(), std::size_t{1} << 20);
    EXPECT_TRUE(bytes == encode_png(image));
}

TEST(Png, AFullDeviceIsAnErrorOfWriting) {
    EXPECT_THROW(write_png("/dev/full", example(9, 9)), WriteError);
}

TEST(PictureFile, TheEndingChoosesTheFormat) {
    EXPECT_EQ(picture_format("a"), PictureFormat::kBmp);
    EXPECT_EQ(picture_format("a.b/c"), PictureFormat::kBmp);
    EXPECT_EQ(picture_format("a.BMP"), PictureFormat::kBmp);
    EXPECT_EQ(picture_format("a.b.png"), PictureFormat::kPng);
    EXPECT_EQ(picture_format("a.Png"), PictureFormat::kPng);
    for (const char* other : {"a.jpg", "a.x3d", "a.bmp.gz", "a.", "a.pngx"})
        EXPECT_EQ(picture_format(other), std::nullopt) << other;
    EXPECT_THROW(write_picture("/nowhere/a.jpg", example(1, 1)), WriteError);
}

}  // namespace
}  // namespace nuvo::image
