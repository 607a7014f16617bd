#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compact_cut.h"

namespace nuvo {

/// A voxel cut, and how many items each octant holds.
struct Split {
    CutVoxel voxel;
    std::array<std::size_t, 8> counts{};

    std::size_t references() const {
        std::size_t sum = 0;
        for (const std::size_t count : counts) sum += count;
        return sum;
    }
    /// Bit o: octant o holds items.
    unsigned occupied() const {
        unsigned mask = 0;
        for (unsigned o = 0; o < 8; ++o) mask |= (counts[o] != 0 ? 1U : 0U) << o;
        return mask;
    }
    unsigned octants() const { return static_cast<unsigned>(std::popcount(occupied())); }
};

/// The surface area heuristic [eq. 10], for beams of rays: a beam meets a voxel as often as a line
/// meets one that is wider by the beam's width. Each price is that of a beam that meets the voxel,
/// in units of one primitive test.
class Prices {
  public:
    /// `root` and `count`: the whole tree's box and items.
    Prices(const CompactCosts& costs, const Bounds3T<float>& root, std::size_t count)
        : costs_(costs),
          root_width_(static_cast<double>(max_norm(root.widths()))),
          root_count_(static_cast<double>(count)) {}

    double leaf(std::size_t count) const { return costs_.leaf + static_cast<double>(count); }
    double interior() const { return costs_.interior; }
    /// The beam's width at a voxel that holds so many items: where they stand closer than in the
    /// scene as a whole, cameras that show them apart do so from nearer, with narrower beams.
    double beam(const Bounds3T<float>& voxel, std::size_t count) const;
    /// How often a beam of this width that meets the voxel meets an octant of it, too.
    static double share(const Bounds3T<float>& octant, const Bounds3T<float>& voxel, double beam) {
        return surface(octant, beam) / surface(voxel, beam);
    }
    /// False where a cut cannot pay: it costs a step and saves at most all tests.
    bool may_pay(std::size_t count) const { return static_cast<double>(count) > costs_.interior; }
    /// Of the cut voxel of so many items with the octants taken for leaves.
    double after(const Split& split, std::size_t count) const;
    /// Whether to go on below the cut of a voxel with so many items: not only where it pays at
    /// once, for items that are large for the voxel are parted by several cuts only.
    bool worth_trying(const Split& split, std::size_t count) const;

  private:
    // Half the surface of the voxel, wider by the beam.
    static double surface(const Bounds3T<float>& voxel, double beam) {
        const double x = static_cast<double>(voxel.max.x - voxel.min.x) + beam;
        const double y = static_cast<double>(voxel.max.y - voxel.min.y) + beam;
        const double z = static_cast<double>(voxel.max.z - voxel.min.z) + beam;
        return x * y + y * z + z * x;
    }

    CompactCosts costs_;
    double root_width_;
    double root_count_;
};

/// Sets masks[i] to the octants of a cut voxel that items[i] touches, and returns how many items
/// touch each octant: by their boxes, and where these tell little by the test, if there is one.
std::array<std::size_t, 8> mark_octants(BoxSpan boxes, const OctantTest& overlaps,
                                        const CutVoxel& voxel, ItemSpan items, std::uint8_t* masks);

/// How many masks have bit o.
std::array<std::size_t, 8> count_octants(const std::uint8_t* masks, std::size_t count);

/// Writes the items of octant o in order to out[first[o]] and on, with one place of scratch behind.
void distribute(ItemSpan items, const std::uint8_t* masks, const std::array<std::size_t, 8>& first,
                std::uint32_t* out);

}  // namespace nuvo
