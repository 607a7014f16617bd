#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "nuvo/image/image.h"

namespace nuvo::image {

inline std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// The filter "Paeth" of the PNG specification, 9.4.
inline int paeth(int left, int above, int corner) {
    const int p = left + above - corner;
    const int to_left = std::abs(p - left), to_above = std::abs(p - above);
    const int to_corner = std::abs(p - corner);
    if (to_left <= to_above && to_left <= to_corner) return left;
    return to_above <= to_corner ? above : corner;
}

/// Undoes the filters of the specification's chapter 9, 3 bytes a pixel.
inline std::vector<int> unfiltered(const std::vector<unsigned char>& data, std::size_t row_bytes) {
    std::vector<int> out;
    for (std::size_t at = 0; at + row_bytes < data.size() + 1; at += row_bytes + 1) {
        const std::size_t row = out.size();
        for (std::size_t i = 0; i < row_bytes; ++i) {
            const int left = i < 3 ? 0 : out[row + i - 3];
            const int above = row == 0 ? 0 : out[row + i - row_bytes];
            const int corner = i < 3 || row == 0 ? 0 : out[row + i - row_bytes - 3];
            const int predicted[] = {0, left, above, (left + above) / 2,
                                     paeth(left, above, corner)};
            EXPECT_LE(data[at], 4);
            out.push_back((data[at + 1 + i] + predicted[data[at] % 5]) & 255);
        }
    }
    return out;
}

/// Reads a PNG by the specification alone: chunks, their CRCs, zlib's stream, filters.
inline Image decoded(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
    std::string stream, last;
    std::uint32_t width = 0, height = 0;
    for (std::size_t at = 8; at < bytes.size();) {
        const std::uint32_t length = big_endian(bytes, at);
        last = bytes.substr(at + 4, 4);
        const auto* checked = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
        EXPECT_EQ(crc32(0, checked, length + 4), big_endian(bytes, at + 8 + length)) << last;
        if (last == "IHDR") {
            width = big_endian(bytes, at + 8);
            height = big_endian(bytes, at + 12);
            EXPECT_EQ(bytes.substr(at + 16, 5), std::string("\x08\x02\0\0\0", 5));
        }
        if (last == "IDAT") stream += bytes.substr(at + 8, length);
        at += 12 + length;
    }
    EXPECT_EQ(last, "IEND");
    std::vector<unsigned char> data(height * (3 * width + 1));
    uLongf size = data.size();
    EXPECT_EQ(uncompress(data.data(), &size, reinterpret_cast<const Bytef*>(stream.data()),
                         stream.size()),
              Z_OK);
    EXPECT_EQ(size, data.size());
    const std::vector<int> values = unfiltered(data, 3 * width);
    Image image(static_cast<int>(width), static_cast<int>(height));
    std::size_t i = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x, i += 3)
            image.at(x, y) = {static_cast<std::uint8_t>(values[i]),
                              static_cast<std::uint8_t>(values[i + 1]),
                              static_cast<std::uint8_t>(values[i + 2])};
    return image;
}

}  // namespace nuvo::image
