#pragma once

#include <filesystem>
#include <optional>

#include "nuvo/image/image.h"

namespace nuvo::image {

enum class PictureFormat { kBmp, kPng };

/// The format that a file's name asks for by its ending, in any letter case: .bmp, .png, or BMP
/// where it has no ending; none for any other ending.
std::optional<PictureFormat> picture_format(const std::filesystem::path& path);

/// Writes the picture in that format, whole or not at all. Throws WriteError, also for an ending
/// that is no picture's.
void write_picture(const std::filesystem::path& path, const Image& image);

}  // namespace nuvo::image
