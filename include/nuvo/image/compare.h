#pragma once

#include <cstddef>

#include "nuvo/image/image.h"

namespace nuvo::image {

/// How far two pictures are apart, over all channels of all pixels.
struct Difference {
    int max_difference = 0;  ///< largest difference of a channel, 0..255
    int x = -1;              ///< the first pixel (by rows from the top) that has it; -1: none
    int y = -1;
    double rms = 0;      ///< root of the mean squared difference of a channel, 0..255
    double psnr_db = 0;  ///< 20 log10(255 / rms), infinity where the pictures are equal
    std::size_t differing_pixels = 0;

    bool equal() const { return differing_pixels == 0; }
};

/// Compares pictures of one size. Throws std::invalid_argument where the sizes differ.
Difference compare(const Image& a, const Image& b);

/// Where the pictures differ, made visible: channel by channel, equal is 0 and a difference d
/// becomes 64 + 191 d / D, rounded, with D the largest difference in the picture; so the faintest
/// difference shows and the largest is 255. Throws as compare() does.
Image difference_picture(const Image& a, const Image& b);

}  // namespace nuvo::image
