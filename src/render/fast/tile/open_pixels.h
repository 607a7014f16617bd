#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fast/tile/exact_fallback.h"
#include "nuvo/image/image.h"

namespace nuvo {

/// Pixels whose bytes floats leave open, until there are many: the fallback then decides them one
/// after the other, while what tells their primitives is fetched for all at once. For one thread.
class OpenPixels {
  public:
    /// `lights`: how many the scene has.
    explicit OpenPixels(std::size_t lights) : lights_(lights), lit_(kMost * lights) {}

    /// Pixel (x, y), which shows `slot` (kNoSlot: the background) in those lights of which
    /// is_lit(i) says so. May decide what it holds, in `image`.
    template <typename IsLit>
    void add(int x, int y, Slot slot, IsLit&& is_lit, const ExactFallback& fallback, Image& image) {
        if (count_ == kMost) decide(fallback, image);
        for (std::size_t i = 0; i < lights_; ++i) lit_[count_ * lights_ + i] = is_lit(i) ? 1 : 0;
        pixels_[count_++] = {x, y, slot};
    }
    /// Writes the bytes of those that are left.
    void decide(const ExactFallback& fallback, Image& image);

  private:
    static constexpr std::size_t kMost = 64;
    struct Pixel {
        int x;
        int y;
        Slot slot;
    };

    std::size_t lights_;
    std::size_t count_ = 0;
    std::array<Pixel, kMost> pixels_;
    std::vector<char> lit_;  // by pixel and light
};

}  // namespace nuvo
