#pragma once

#include <cstddef>
#include <cstdint>

#include "nuvo/math/big_vector.h"

namespace nuvo {

/// One pixel, 8 bits a channel.
struct Rgb8 {
    std::uint8_t r;
    std::uint8_t g;
    std::uint8_t b;

    friend constexpr bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// A picture by rows, the top row first.
class Image {
  public:
    Image() = default;
    /// A black one.
    Image(int width, int height)
        : width_(width), height_(height), pixels_(size(width, height), Rgb8{}) {}
    /// One whose pixels are unset: for those who set them all.
    static Image unset(int width, int height) {
        Image image;
        image.width_ = width;
        image.height_ = height;
        image.pixels_.resize(size(width, height));
        return image;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    Rgb8& at(int x, int y) { return pixels_[index(x, y)]; }
    const Rgb8& at(int x, int y) const { return pixels_[index(x, y)]; }
    const BigVector<Rgb8>& pixels() const { return pixels_; }

    friend bool operator==(const Image&, const Image&) = default;

  private:
    static std::size_t size(int width, int height) {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    BigVector<Rgb8> pixels_;
};

}  // namespace nuvo
