#pragma once

#include <string_view>

#include "nuvo/image/image.h"

namespace nuvo::image {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;

/// Width in pixels of a text whose dots are `dot` pixels wide.
int text_width(std::string_view text, int dot);

/// Draws digits, small letters and . + - ; anything else is a blank. What lies outside of the
/// picture is left out.
void draw_text(Image& image, int x, int y, std::string_view text, int dot, Rgb8 color);

}  // namespace nuvo::image
