#include "nuvo/image/bmp.h"

#include <cstdint>

#include "nuvo/image/file_writer.h"

namespace nuvo::image {
namespace {

constexpr std::uint32_t kFileHeaderBytes = 14;
constexpr std::uint32_t kInfoHeaderBytes = 40;
constexpr std::uint32_t kHeaderBytes = kFileHeaderBytes + kInfoHeaderBytes;
constexpr std::uint16_t kBitsPerPixel = 24;
constexpr std::uint32_t kPixelsPerMeter = 2835;  // 72 dots an inch, the customary value

void append16(std::string& out, std::uint32_t value) {
    out.push_back(static_cast<char>(value & 0xff));
    out.push_back(static_cast<char>(value >> 8 & 0xff));
}

void append32(std::string& out, std::uint32_t value) {
    append16(out, value);
    append16(out, value >> 16);
}

std::size_t row_bytes(const Image& image) {
    return (static_cast<std::size_t>(image.width()) * 3 + 3) / 4 * 4;
}

std::string header(const Image& image) {
    const auto pixel_bytes =
        static_cast<std::uint32_t>(row_bytes(image) * static_cast<std::size_t>(image.height()));
    std::string out = "BM";
    append32(out, kHeaderBytes + pixel_bytes);
    append32(out, 0);  // reserved
    append32(out, kHeaderBytes);
    append32(out, kInfoHeaderBytes);
    append32(out, static_cast<std::uint32_t>(image.width()));
    append32(out, static_cast<std::uint32_t>(image.height()));  // positive: the bottom row first
    append16(out, 1);                                           // planes
    append16(out, kBitsPerPixel);
    append32(out, 0);  // not compressed
    append32(out, pixel_bytes);
    append32(out, kPixelsPerMeter);
    append32(out, kPixelsPerMeter);
    append32(out, 0);  // no palette
    append32(out, 0);
    return out;
}

void append_row(std::string& out, const Image& image, int y) {
    std::size_t at = out.size();
    out.resize(at + row_bytes(image), '\0');
    for (int x = 0; x < image.width(); ++x, at += 3) {
        const Rgb8& pixel = image.at(x, y);
        out[at] = static_cast<char>(pixel.b);
        out[at + 1] = static_cast<char>(pixel.g);
        out[at + 2] = static_cast<char>(pixel.r);
    }
}

}  // namespace

std::string encode_bmp(const Image& image) {
    std::string out = header(image);
    for (int y = image.height() - 1; y >= 0; --y) append_row(out, image, y);
    return out;
}

void write_bmp(const std::filesystem::path& path, const Image& image) {
    constexpr std::size_t kChunkBytes = 1 << 20;
    FileWriter writer(path);
    std::string chunk = header(image);
    for (int y = image.height() - 1; y >= 0; --y) {
        append_row(chunk, image, y);
        if (chunk.size() < kChunkBytes) continue;
        writer.write(chunk);
        chunk.clear();
    }
    writer.write(chunk);
    writer.commit();
}

}  // namespace nuvo::image
