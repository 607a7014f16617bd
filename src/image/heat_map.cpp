#include "nuvo/image/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "glyphs.h"
#include "nuvo/image/viridis.h"

namespace nuvo::image {
namespace {

constexpr Rgb8 kPaper{32, 32, 32};
constexpr Rgb8 kInk{230, 230, 230};

/// Sizes of the strip below the values, in pixels.
struct Strip {
    explicit Strip(int width) : dot(width < 960 ? 1 : 2) {}

    int dot;                                         // of the letters
    int gap() const { return 4 * dot; }              // around everything
    int bar() const { return 8 * dot; }              // height of the colors
    int text() const { return kGlyphHeight * dot; }  // height of a line
    int height() const { return 4 * gap() + bar() + 2 * text(); }
    int least_width() const { return 200 * dot; }
};

std::string number(double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.4g", value);
    return text.data();
}

void fill(Image& image, int left, int right, int top, int bottom, Rgb8 color) {
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) image.at(x, y) = color;
}

/// A text whose middle is at x, moved so that it stays inside of the picture.
void draw_centered(Image& image, const Strip& strip, int x, int y, const std::string& text) {
    const int width = text_width(text, strip.dot);
    const int last = image.width() - strip.gap() - width;
    draw_text(image, std::clamp(x - width / 2, strip.gap(), std::max(strip.gap(), last)), y, text,
              strip.dot, kInk);
}

/// Colors from left to right with the numbers at their quarters.
void draw_numbers(Image& image, const Strip& strip, int top, const HeatScale& scale, bool over) {
    constexpr int kParts = 4;
    const int left = strip.gap();
    const int span = image.width() - 2 * strip.gap();
    for (int x = 0; x < span; ++x)
        fill(image, left + x, left + x + 1, top, top + strip.bar(),
             viridis(static_cast<double>(x) / (span - 1)));
    for (int part = 0; part <= kParts; ++part) {
        const bool is_last = part == kParts;
        draw_centered(image, strip, left + span * part / kParts, top + strip.bar() + strip.gap(),
                      number(scale.max * part / kParts) + (is_last && over ? "+" : ""));
    }
}

/// A field for each of a few values.
void draw_names(Image& image, const Strip& strip, int top, const HeatScale& scale) {
    const int count = static_cast<int>(scale.names.size());
    const int span = image.width() - 2 * strip.gap();
    for (int i = 0; i < count; ++i) {
        const int left = strip.gap() + span * i / count;
        const int right = strip.gap() + span * (i + 1) / count;
        fill(image, left, right, top, top + strip.bar(), viridis(i / scale.max));
        draw_centered(image, strip, (left + right) / 2, top + strip.bar() + strip.gap(),
                      scale.names[static_cast<std::size_t>(i)]);
    }
}

}  // namespace

Image heat_map(std::span<const double> values, int width, const HeatScale& scale) {
    const Strip strip(width);
    const int height = static_cast<int>(values.size() / static_cast<std::size_t>(width));
    Image image(std::max(width, strip.least_width()), height + strip.height());
    fill(image, 0, image.width(), 0, image.height(), kPaper);
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int x = static_cast<int>(i % static_cast<std::size_t>(width));
        const int y = static_cast<int>(i / static_cast<std::size_t>(width));
        image.at(x, y) = viridis(values[i] / scale.max);
        largest = std::max(largest, values[i]);
    }
    const int title = height + strip.gap();
    draw_text(image, strip.gap(), title, scale.title, strip.dot, kInk);
    const int bar = title + strip.text() + strip.gap();
    if (scale.names.empty()) {
        draw_numbers(image, strip, bar, scale, largest > scale.max);
    } else {
        draw_names(image, strip, bar, scale);
    }
    return image;
}

}  // namespace nuvo::image
