#pragma once

#include <span>
#include <string>
#include <vector>

#include "nuvo/image/image.h"

namespace nuvo::image {

/// How the values of a heat map become colors, and what its scale bar says.
struct HeatScale {
    std::string title;               ///< what the values are, in small letters
    double max = 1;                  ///< > 0: viridis from 0 to here; larger values look like it
    std::vector<std::string> names;  ///< of the values 0, 1, ... max; empty: they are numbers
};

/// `values`, by rows of `width` from the top, one pixel each in the picture's upper left; below
/// them a scale bar with numbers, for which narrow pictures are widened.
Image heat_map(std::span<const double> values, int width, const HeatScale& scale);

}  // namespace nuvo::image
