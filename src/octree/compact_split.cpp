#include "compact_split.h"

#include <algorithm>
#include <cmath>

#include "box_lanes.h"

// One cut: the octants that an item's box touches follow from comparisons with the planes; of items
// in more than one octant only those are tested any further, all of a voxel together, that may miss
// one.

namespace nuvo {
namespace {

// Many items may go on being cut at a loss up to this factor. Triangles as large as the scene, at
// random, touch more than half of the octants: 1.1.
constexpr double kHope = 1.3;

// Octants in the lower and in the upper half of each axis.
constexpr std::uint8_t kLower[3] = {0x55, 0x33, 0x0f};
constexpr std::uint8_t kUpper[3] = {0xaa, 0xcc, 0xf0};

// Octants by SidesOfPlanes, and kSure where an item surely touches them all: it crosses one plane
// only, and on the other two axes it lies within the voxel, so that it crosses that plane in there.
constexpr std::uint16_t kSure = 0x100;
constexpr std::array<std::uint16_t, 512> octants_of_sides() {
    std::array<std::uint16_t, 512> table{};
    for (unsigned sides = 0; sides < 512; ++sides) {
        unsigned mask = 0xff;
        for (unsigned axis = 0; axis < 3; ++axis)
            mask &= ((sides >> axis & 1U) != 0 ? kLower[axis] : 0U) |
                    ((sides >> (axis + 3) & 1U) != 0 ? kUpper[axis] : 0U);
        const unsigned crossed = sides & sides >> 3 & 7;
        const unsigned outside = sides >> 6;
        const bool sure = std::has_single_bit(crossed) && (outside & ~crossed) == 0;
        table[sides] = static_cast<std::uint16_t>(mask | (sure ? kSure : 0U));
    }
    return table;
}
constexpr std::array<std::uint16_t, 512> kOctantsOfSides = octants_of_sides();

// Bit o of the index becomes byte o: eight counters in a word.
constexpr std::array<std::uint64_t, 256> spread_bits() {
    std::array<std::uint64_t, 256> table{};
    for (unsigned mask = 0; mask < 256; ++mask)
        for (unsigned o = 0; o < 8; ++o)
            table[mask] |= static_cast<std::uint64_t>(mask >> o & 1U) << (8 * o);
    return table;
}
constexpr std::array<std::uint64_t, 256> kSpread = spread_bits();

// Octants that exist: the upper half of an axis that is not cut does not.
unsigned existing_octants(const CutVoxel& voxel) {
    unsigned mask = 0xff;
    for (int axis = 0; axis < 3; ++axis)
        if (!(voxel.cut[axis] < voxel.bounds.max[axis])) mask &= kLower[axis];
    return mask;
}

}  // namespace

std::array<std::size_t, 8> count_octants(const std::uint8_t* masks, std::size_t count) {
    constexpr std::size_t kByteRange = 255;
    std::array<std::size_t, 8> counts{};
    for (std::size_t begin = 0; begin < count; begin += kByteRange) {
        const std::size_t end = std::min(begin + kByteRange, count);
        std::uint64_t bytes = 0;
        for (std::size_t i = begin; i < end; ++i) bytes += kSpread[masks[i]];
        for (unsigned o = 0; o < 8; ++o) counts[o] += bytes >> (8 * o) & 0xff;
    }
    return counts;
}

// Items on surfaces stand the root's width / sqrt(count) apart if they fill it evenly. Up to
// kEven times as close they count as even: an octant's items are never quite their share.
double Prices::beam(const Bounds3T<float>& voxel, std::size_t count) const {
    constexpr double kEven = 4;
    const double spacing = static_cast<double>(max_norm(voxel.widths())) *
                           std::sqrt(root_count_ / static_cast<double>(count));
    return costs_.beam * std::min(root_width_, kEven * spacing);
}

double Prices::after(const Split& split, std::size_t count) const {
    const Bounds3T<float>& voxel = split.voxel.bounds;
    const double width = beam(voxel, count);
    double cost = interior();
    for (unsigned o = 0; o < 8; ++o)
        if (split.counts[o] != 0)
            cost += share(octant_box(split.voxel, o), voxel, width) * leaf(split.counts[o]);
    return cost;
}

bool Prices::worth_trying(const Split& split, std::size_t count) const {
    const double as_leaf = leaf(count);
    const double cost = after(split, count);
    if (cost < as_leaf) return true;
    const bool parted =
        std::find(split.counts.begin(), split.counts.end(), count) == split.counts.end();
    return count >= kManyItems && parted && cost < kHope * as_leaf;
}

std::array<std::size_t, 8> OctantMarker::mark(const CutVoxel& voxel, ItemSpan items,
                                              std::uint8_t* masks) {
    const std::size_t doubtful = mark_by_boxes(voxel, items, masks);
    if (overlaps_ && doubtful > 0) refine(voxel, doubtful, masks);
    return count_octants(masks, items.size());
}

std::size_t OctantMarker::mark_by_boxes(const CutVoxel& voxel, ItemSpan items,
                                        std::uint8_t* masks) {
    const unsigned existing = existing_octants(voxel);
    const SidesOfPlanes sides(voxel.cut, voxel.bounds);
    if (doubtful_.size() < items.size()) {
        doubtful_.resize(items.size());
        places_.resize(items.size());
        candidates_.resize(items.size());
    }
    // Writing bytes may change anything as far as the compiler knows, but not these.
    const Bounds3T<float>* const boxes = boxes_.data();
    std::uint32_t* const doubtful_items = doubtful_.data();
    std::uint32_t* const places = places_.data();
    std::uint8_t* const candidates = candidates_.data();
    std::size_t doubtful = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        __builtin_prefetch(boxes + items[std::min(i + kPrefetchAhead, items.size() - 1)]);
        const std::uint32_t item = items[i];
        const unsigned octants = kOctantsOfSides[sides.of(boxes[item])];
        const unsigned mask = octants & existing;
        masks[i] = static_cast<std::uint8_t>(mask);
        // Written always, kept where the count moves on: no branch to be guessed wrong.
        doubtful_items[doubtful] = item;
        places[doubtful] = static_cast<std::uint32_t>(i);
        candidates[doubtful] = static_cast<std::uint8_t>(mask);
        doubtful += (mask & (mask - 1)) != 0 && octants < kSure ? 1 : 0;
    }
    return doubtful;
}

void OctantMarker::refine(const CutVoxel& voxel, std::size_t doubtful, std::uint8_t* masks) {
    overlaps_(voxel, ItemSpan(doubtful_).first(doubtful), std::span(candidates_).first(doubtful));
    for (std::size_t i = 0; i < doubtful; ++i) masks[places_[i]] = candidates_[i];
}

void distribute(ItemSpan items, const std::uint8_t* masks, const std::array<std::size_t, 8>& first,
                std::uint32_t* out) {
    std::array<std::uint32_t*, 8> next;
    for (unsigned o = 0; o < 8; ++o) next[o] = out + first[o];
    for (std::size_t i = 0; i < items.size(); ++i) {
        const unsigned mask = masks[i];
        const std::uint32_t item = items[i];
        for (unsigned o = 0; o < 8; ++o) {
            *next[o] = item;
            next[o] += mask >> o & 1U;
        }
    }
}

}  // namespace nuvo
