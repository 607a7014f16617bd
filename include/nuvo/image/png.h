#pragma once

#include <filesystem>
#include <string>

#include "nuvo/image/image.h"

namespace nuvo::image {

/// The picture as PNG: 8 bits a channel, red green blue, no palette, not interlaced, the same bytes
/// each time. Sides of at least 1 pixel.
std::string encode_png(const Image& image);

/// Writes that file whole or not at all, without a second copy of the picture. Throws WriteError.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace nuvo::image
