#pragma once

#include "nuvo/image/image.h"

namespace nuvo::image {

/// The picture of the means of the squares of `side` x `side` pixels, each channel rounded to the
/// nearest, halves upwards. Both sides of `samples` must be multiples of `side`, which is >= 1.
Image averaged(const Image& samples, int side);

}  // namespace nuvo::image
