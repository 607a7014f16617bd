#include "nuvo/image/picture_file.h"

#include <string>

#include "nuvo/image/bmp.h"
#include "nuvo/image/file_writer.h"
#include "nuvo/image/png.h"

namespace nuvo::image {

std::optional<PictureFormat> picture_format(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (ending.empty() || ending == ".bmp") return PictureFormat::kBmp;
    if (ending == ".png") return PictureFormat::kPng;
    return std::nullopt;
}

void write_picture(const std::filesystem::path& path, const Image& image) {
    const std::optional<PictureFormat> format = picture_format(path);
    if (!format) throw WriteError(path.string() + ": cannot write: pictures are .bmp or .png");
    if (*format == PictureFormat::kPng) return write_png(path, image);
    write_bmp(path, image);
}

}  // namespace nuvo::image
