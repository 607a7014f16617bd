#include "nuvo/image/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace nuvo::image {
namespace {

constexpr int kLargestChannel = 255;
constexpr int kFaintest = 64;  // what the smallest difference shows as, nearly

void require_same_size(const Image& a, const Image& b) {
    if (a.width() != b.width() || a.height() != b.height())
        throw std::invalid_argument("pictures of different sizes cannot be compared");
}

struct ChannelDifferences {
    int r, g, b;

    int largest() const { return std::max({r, g, b}); }
    int sum_of_squares() const { return r * r + g * g + b * b; }
};

ChannelDifferences differences(const Rgb8& a, const Rgb8& b) {
    return {std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)};
}

std::uint8_t shown(int difference, int largest) {
    if (difference == 0 || largest == 0) return 0;
    const int span = kLargestChannel - kFaintest;
    return static_cast<std::uint8_t>(kFaintest + (2 * span * difference + largest) / (2 * largest));
}

}  // namespace

Difference compare(const Image& a, const Image& b) {
    require_same_size(a, b);
    Difference result;
    std::uint64_t squares = 0;  // exact: at most 2^28 pixels of 3 * 255^2
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            const ChannelDifferences d = differences(a.at(x, y), b.at(x, y));
            if (d.largest() == 0) continue;
            ++result.differing_pixels;
            squares += static_cast<std::uint64_t>(d.sum_of_squares());
            if (d.largest() <= result.max_difference) continue;
            result.max_difference = d.largest();
            result.x = x;
            result.y = y;
        }
    }
    const std::size_t channels = a.pixels().size() * 3;
    if (channels != 0)
        result.rms = std::sqrt(static_cast<double>(squares) / static_cast<double>(channels));
    result.psnr_db = result.equal() ? std::numeric_limits<double>::infinity()
                                    : 20 * std::log10(kLargestChannel / result.rms);
    return result;
}

Image difference_picture(const Image& a, const Image& b) {
    const int largest = compare(a, b).max_difference;
    Image picture(a.width(), a.height());
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            const ChannelDifferences d = differences(a.at(x, y), b.at(x, y));
            picture.at(x, y) = {shown(d.r, largest), shown(d.g, largest), shown(d.b, largest)};
        }
    }
    return picture;
}

}  // namespace nuvo::image
