#pragma once

#include <cstdint>
#include <vector>

#include "nuvo/scene/camera.h"

namespace nuvo {

/// A tile by its column and row.
struct TilePlace {
    std::uint16_t column;
    std::uint16_t row;
};

/// The tiles of this many pixels a side of a picture, along a Z-order curve (Morton 1966), so that
/// tiles near in time see the same part of the scene.
std::vector<TilePlace> tiles_in_order(Resolution resolution, int side);

}  // namespace nuvo
