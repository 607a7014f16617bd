#pragma once

#include <cstddef>
#include <cstdint>

#include "nuvo/math/big_vector.h"

namespace nuvo {

/// One pixel, 8 bits a channel.
struct Rgb8 {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend constexpr bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// A picture by rows, the top row first.
class Image {
  public:
    Image() = default;
    Image(int width, int height)
        : width_(width),
          height_(height),
          pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    Rgb8& at(int x, int y) { return pixels_[index(x, y)]; }
    const Rgb8& at(int x, int y) const { return pixels_[index(x, y)]; }
    const BigVector<Rgb8>& pixels() const { return pixels_; }

    friend bool operator==(const Image&, const Image&) = default;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    BigVector<Rgb8> pixels_;
};

}  // namespace nuvo
