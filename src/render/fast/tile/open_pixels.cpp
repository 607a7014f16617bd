#include "fast/tile/open_pixels.h"

#include <utility>

#include "nuvo/render/shading.h"

namespace nuvo {
void OpenPixels::decide(const ExactFallback& fallback, Image& image) {
    const std::size_t count = std::exchange(count_, std::size_t{0});
    std::array<Slot, kMost> slots;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (pixels_[i].slot != kNoSlot) slots[hits++] = pixels_[i].slot;
    fallback.scene().prefetch(std::span(slots).first(hits));
    for (std::size_t i = 0; i < count; ++i) {
        const Pixel& pixel = pixels_[i];
        image.at(pixel.x, pixel.y) =
            quantized(fallback.color(pixel.x, pixel.y, pixel.slot, [&](std::size_t light) {
                return lit_[i * lights_ + light] != 0;
            }));
    }
}

}  // namespace nuvo
