#include "fast/tile/tile_order.h"

namespace nuvo {
namespace {

// Every other bit, put together.
std::uint32_t even_bits(std::uint32_t code) {
    std::uint32_t out = 0;
    for (unsigned bit = 0; bit < 16; ++bit) out |= (code >> (2 * bit) & 1) << bit;
    return out;
}

}  // namespace

std::vector<TilePlace> tiles_in_order(Resolution resolution, int side) {
    const auto columns = static_cast<std::uint32_t>((resolution.width + side - 1) / side);
    const auto rows = static_cast<std::uint32_t>((resolution.height + side - 1) / side);
    // Squares of this side along the curve, and these row by row: no square is mostly empty.
    constexpr std::uint32_t kSquare = 4;
    std::vector<TilePlace> places;
    places.reserve(columns * rows);
    for (std::uint32_t y = 0; y < rows; y += kSquare)
        for (std::uint32_t x = 0; x < columns; x += kSquare)
            for (std::uint32_t code = 0; code < kSquare * kSquare; ++code) {
                const std::uint32_t column = x + even_bits(code);
                const std::uint32_t row = y + even_bits(code >> 1);
                if (column < columns && row < rows)
                    places.push_back(
                        {static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(row)});
            }
    return places;
}

}  // namespace nuvo
