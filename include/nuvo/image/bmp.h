#pragma once

#include <filesystem>
#include <string>

#include "nuvo/image/image.h"

namespace nuvo::image {

/// The picture as a 24-bit Windows bitmap: a 14-byte file header, a 40-byte BITMAPINFOHEADER, then
/// rows from the bottom up, blue green red, each row padded with zeros to a multiple of 4 bytes.
/// [thesis 4.5] Sides of at least 1 pixel; 4 GiB is the format's limit.
std::string encode_bmp(const Image& image);

/// Writes that file whole or not at all, row by row, so that no second copy of the picture is held.
/// Throws WriteError.
void write_bmp(const std::filesystem::path& path, const Image& image);

}  // namespace nuvo::image
