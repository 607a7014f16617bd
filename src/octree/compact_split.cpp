#include "compact_split.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "box_lanes.h"

// One cut: the octants that an item's box touches follow from comparisons with the planes. Where
// items are so large for their voxel that boxes tell little, the items themselves are tested.

namespace nuvo {
namespace {

// Many items may go on being cut at a loss up to this factor. Triangles as large as the scene, at
// random, touch more than half of the octants: 1.1.
constexpr double kHope = 1.3;

// Where items touch more octants than this by their boxes, on average, the items are tested: above
// many other voxels, where a mistake goes on and on, sooner.
constexpr std::size_t kManyOctants = 4;
constexpr std::size_t kManyOfLargeVoxel = 2;
constexpr std::size_t kLargeVoxel = 128;  // items

// Octants in the lower and in the upper half of each axis.
constexpr std::uint8_t kLower[3] = {0x55, 0x33, 0x0f};
constexpr std::uint8_t kUpper[3] = {0xaa, 0xcc, 0xf0};

// Octants by SidesOfPlanes.
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
unsigned existing_octants(const CutVoxel& voxel) {
    unsigned mask = 0xff;
    for (int axis = 0; axis < 3; ++axis)
        if (!(voxel.cut[axis] < voxel.bounds.max[axis])) mask &= kLower[axis];
    return mask;
}

// Adds up masks, eight counters in a word for as long as none overflows.
class OctantCounter {
  public:
    void add(unsigned mask) {
        bytes_ += kSpread[mask];
        if (++in_bytes_ == kByteRange) flush();
    }
    std::array<std::size_t, 8> counts() {
        flush();
        return counts_;
    }

  private:
    static constexpr unsigned kByteRange = 255;
    void flush() {
        for (unsigned o = 0; o < 8; ++o) counts_[o] += bytes_ >> (8 * o) & 0xff;
        bytes_ = 0;
        in_bytes_ = 0;
    }

    std::array<std::size_t, 8> counts_{};
    std::uint64_t bytes_ = 0;
    unsigned in_bytes_ = 0;
};

}  // namespace

std::array<std::size_t, 8> count_octants(const std::uint8_t* masks, std::size_t count) {
    OctantCounter counter;
    for (std::size_t i = 0; i < count; ++i) counter.add(masks[i]);
    return counter.counts();
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
            cost += share(octant_box(split.voxel.bounds, split.voxel.cut, o), voxel, width) *
                    leaf(split.counts[o]);
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

std::array<std::size_t, 8> mark_octants(BoxSpan boxes, const OctantTest& overlaps,
                                        const CutVoxel& voxel, ItemSpan items,
                                        std::uint8_t* masks) {
    const unsigned existing = existing_octants(voxel);
    const SidesOfPlanes sides(voxel.cut);
    OctantCounter counter;
    for (std::size_t i = 0; i < items.size(); ++i) {
        __builtin_prefetch(&boxes[items[std::min(i + kPrefetchAhead, items.size() - 1)]]);
        const unsigned mask = kOctantsOfSides[sides.of(boxes[items[i]])] & existing;
        masks[i] = static_cast<std::uint8_t>(mask);
        counter.add(mask);
    }
    const std::array<std::size_t, 8> counts = counter.counts();
    const std::size_t octants = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    const std::size_t many = items.size() >= kLargeVoxel ? kManyOfLargeVoxel : kManyOctants;
    if (!overlaps || octants <= many * items.size()) return counts;
    overlaps(voxel, items, std::span(masks, items.size()));
    return count_octants(masks, items.size());
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
