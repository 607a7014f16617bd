#include "compact_split.h"

#include <bit>

// One cut: the octants that an item's box touches follow from six comparisons with the planes; only
// items in more than one octant are tested any further, all of a voxel together.

namespace nuvo {
namespace {

// Octants in the lower and in the upper half of each axis.
constexpr std::uint8_t kLower[3] = {0x55, 0x33, 0x0f};
constexpr std::uint8_t kUpper[3] = {0xaa, 0xcc, 0xf0};

// Octants by which sides of the planes a box touches: bits 0-2 the lower sides, 3-5 the upper.
constexpr std::array<std::uint8_t, 64> octants_of_sides() {
    std::array<std::uint8_t, 64> table{};
    for (unsigned sides = 0; sides < 64; ++sides) {
        unsigned mask = 0xff;
        for (unsigned axis = 0; axis < 3; ++axis)
            mask &= ((sides >> axis & 1U) != 0 ? kLower[axis] : 0U) |
                    ((sides >> (axis + 3) & 1U) != 0 ? kUpper[axis] : 0U);
        table[sides] = static_cast<std::uint8_t>(mask);
    }
    return table;
}
constexpr std::array<std::uint8_t, 64> kOctantsOfSides = octants_of_sides();

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
std::uint8_t existing_octants(const CutVoxel& voxel) {
    unsigned mask = 0xff;
    for (int axis = 0; axis < 3; ++axis)
        if (!(voxel.cut[axis] < voxel.bounds.max[axis])) mask &= kLower[axis];
    return static_cast<std::uint8_t>(mask);
}

unsigned sides(const Bounds3T<float>& box, const Vec3<float>& cut) {
    const auto bit = [](bool on, unsigned place) { return static_cast<unsigned>(on) << place; };
    return bit(box.min.x <= cut.x, 0) | bit(box.min.y <= cut.y, 1) | bit(box.min.z <= cut.z, 2) |
           bit(box.max.x >= cut.x, 3) | bit(box.max.y >= cut.y, 4) | bit(box.max.z >= cut.z, 5);
}

}  // namespace

std::optional<Split> Splitter::try_split(const Bounds3T<float>& voxel, ItemSpan items) {
    // A cut costs a step; what it saves is at most the test of each item.
    if (static_cast<double>(items.size()) <= options_.costs.interior) return std::nullopt;
    const std::optional<CutVoxel> cut = choose_cut(options_.rule, voxel, items, boxes_);
    if (!cut) return std::nullopt;
    classify(*cut, items);
    if (options_.overlaps) refine(*cut);

    Split split{*cut, {}, 0};
    constexpr std::size_t kByteRange = 255;
    for (std::size_t begin = 0; begin < items.size(); begin += kByteRange) {
        const std::size_t end = std::min(begin + kByteRange, items.size());
        std::uint64_t bytes = 0;
        for (std::size_t i = begin; i < end; ++i) bytes += kSpread[masks_[i]];
        for (unsigned o = 0; o < 8; ++o) split.counts[o] += bytes >> (8 * o) & 0xff;
    }
    for (const std::size_t count : split.counts) split.references += count;
    if (!pays(split, items.size())) return std::nullopt;
    return split;
}

void Splitter::classify(const CutVoxel& voxel, ItemSpan items) {
    const std::uint8_t existing = existing_octants(voxel);
    if (masks_.size() < items.size()) {
        masks_.resize(items.size());
        doubtful_.resize(items.size() + 1);
        places_.resize(items.size() + 1);
    }
    std::size_t doubtful = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const std::uint8_t mask = kOctantsOfSides[sides(boxes_[items[i]], voxel.cut)] & existing;
        masks_[i] = mask;
        doubtful_[doubtful] = items[i];
        places_[doubtful] = static_cast<std::uint32_t>(i);
        doubtful += (mask & (mask - 1)) != 0 ? 1 : 0;
    }
    candidates_.resize(doubtful);
}

void Splitter::refine(const CutVoxel& voxel) {
    const std::size_t count = candidates_.size();
    if (count == 0) return;
    for (std::size_t i = 0; i < count; ++i) candidates_[i] = masks_[places_[i]];
    options_.overlaps(voxel, ItemSpan(doubtful_).first(count), candidates_);
    for (std::size_t i = 0; i < count; ++i) masks_[places_[i]] = candidates_[i];
}

// The surface area heuristic with the octants taken for leaves. [eq. 10]
bool Splitter::pays(const Split& split, std::size_t count) const {
    double cost = interior_cost(split.voxel.bounds);
    for (unsigned o = 0; o < 8; ++o)
        if (split.counts[o] != 0) cost += leaf_cost(octant_box(split.voxel, o), split.counts[o]);
    return cost < leaf_cost(split.voxel.bounds, count);
}

void Splitter::distribute(ItemSpan items, const std::array<std::size_t, 8>& first,
                          std::uint32_t* out) const {
    std::array<std::uint32_t*, 8> next;
    for (unsigned o = 0; o < 8; ++o) next[o] = out + first[o];
    // Without branches: every item is written everywhere, and stays where the place moves on.
    for (std::size_t i = 0; i < items.size(); ++i) {
        const unsigned mask = masks_[i];
        const std::uint32_t item = items[i];
        for (unsigned o = 0; o < 8; ++o) {
            *next[o] = item;
            next[o] += mask >> o & 1U;
        }
    }
}

}  // namespace nuvo
