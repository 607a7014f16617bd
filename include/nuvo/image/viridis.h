#pragma once

#include "nuvo/image/image.h"

namespace nuvo::image {

/// The color map viridis at 0 (dark violet) to 1 (yellow); what lies outside takes the end's color,
/// NaN that of 0. Equal steps look equal, in gray and to the color-blind, too. [Smith and van der
/// Walt 2015, CC0]
Rgb8 viridis(double share);

}  // namespace nuvo::image
