#include "fast/scene/slot_order.h"

#include <array>
#include <cstdint>

namespace nuvo {
namespace {

// Fewer primitives have tables of a few megabytes.
constexpr std::size_t kManyPrimitives = std::size_t{1} << 15;
constexpr unsigned kBitsPerAxis = 10;

struct Place {
    std::uint32_t code;
    PrimitiveId id;
};

// Two 0 bits after each bit of ten.
std::uint32_t spread(std::uint32_t v) {
    v = (v | v << 16) & 0x030000ff;
    v = (v | v << 8) & 0x0300f00f;
    v = (v | v << 4) & 0x030c30c3;
    return (v | v << 2) & 0x09249249;
}

// The place along a Z-order curve of a point that is so far from the box's lowest corner, with
// `scale` cells a unit. Any cell will do; what is not a number goes to the first.
std::uint32_t z_order(const Vector3& from_low, double scale) {
    constexpr double kLast = (1 << kBitsPerAxis) - 1;
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = from_low[axis] * scale;
        code |= spread(at > 0 ? static_cast<std::uint32_t>(at < kLast ? at : kLast) : 0) << axis;
    }
    return code;
}

// By code, stable: least digits first (Knuth 1998, algorithm 5.2.5R).
void sort_by_code(std::vector<Place>& places) {
    constexpr unsigned kDigitBits = 10;
    constexpr std::uint32_t kDigits = 1U << kDigitBits;
    std::vector<Place> sorted(places.size());
    for (unsigned shift = 0; shift < 3 * kBitsPerAxis; shift += kDigitBits) {
        std::array<std::uint32_t, kDigits + 1> start{};
        for (const Place& p : places) ++start[(p.code >> shift) % kDigits + 1];
        for (std::size_t i = 0; i < kDigits; ++i) start[i + 1] += start[i];
        for (const Place& p : places) sorted[start[(p.code >> shift) % kDigits]++] = p;
        places.swap(sorted);
    }
}

}  // namespace

void sort_in_space(const Primitives& primitives, const Bounds3& box,
                   std::vector<PrimitiveId>& ids) {
    if (ids.size() < kManyPrimitives) return;
    constexpr double kCells = 1 << kBitsPerAxis;
    const double widest = max_norm(box.max - box.min);
    const double scale = widest > 0 ? kCells / widest : 0;
    std::vector<Place> places;
    places.reserve(ids.size());
    for (const PrimitiveId id : ids)
        places.push_back({z_order(primitives.item_boxes[id].center() - box.min, scale), id});
    sort_by_code(places);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = places[i].id;
}

}  // namespace nuvo
