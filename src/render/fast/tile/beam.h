// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_BEAM_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_BEAM_H_
#undef NUVO_RENDER_FAST_BEAM_H_
#else
#define NUVO_RENDER_FAST_BEAM_H_
#endif

#include <bit>

#include "fast/simd/lanes.h"
#include "fast/tile/beam_box.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/compact.h"

// A group of rays walks the octree as one: interval arithmetic over the group (Boulos, Wald and
// Benthin 2008, "Adaptive ray packet reordering"; Wald et al. 2007, MLRTA) in the parametric,
// top-down form (Revelles, Urena and Lastra 2000), all eight octants of a node in one register.
//
// On each axis a ray of the beam is inside the slab [x0, x1] at t only if
//     t * direction_high >= x0 - origin_high    and    t * direction_low <= x1 - origin_low.
// Each inequality bounds t from below or from above, by the sign of its coefficient; where the
// directions straddle 0 both bound it from below. So a beam needs no common signs, and no octant
// is missed: the rounding of each bound is made up for by kWiden.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The octants on the upper side of the cut of an axis.
HWY_INLINE LaneMask<float, 8> upper_octants(int axis) {
    constexpr std::uint32_t kUpper[3] = {0xaa, 0xcc, 0xf0};
    return LaneMask<float, 8>::from_bits(kUpper[axis]);
}

/// The slab tests of one beam. kStraddles: on some axis the directions have both signs.
template <bool kStraddles>
class BeamSlabs {
  public:
    explicit HWY_INLINE BeamSlabs(const BeamBox& beam)
        : t_end_(beam.t_end * (1 + kWiden)), flip_(beam.far_first ? 7 : 0) {
        for (int axis = 0; axis < 3; ++axis) {
            const float low = beam.direction_low[axis];
            const float high = beam.direction_high[axis];
            forward_[axis] = high > 0;
            if (high > 0) {
                entry_scale_[axis] = (1 - kWiden) / high;
                entry_origin_[axis] = beam.origin_high[axis];
                exit_origin_[axis] = beam.origin_low[axis];
                set_exit(axis, low < 0, 1 / low);
            } else {
                entry_scale_[axis] = (1 - kWiden) / low;
                entry_origin_[axis] = beam.origin_low[axis];
                exit_origin_[axis] = beam.origin_high[axis];
                set_exit(axis, false, 1 / high);
            }
            if (low + high < 0) flip_ ^= 1U << axis;
        }
    }

    /// Octant o ^ flip() for o = 0..7 is an order from near to far (or from far to near).
    unsigned flip() const { return flip_; }

    /// The octants of the voxel that the beam may meet.
    HWY_INLINE std::uint32_t meets(const float* low, const float* cut, const float* high) const {
        OctantFloats first(0.0F);
        OctantFloats last(t_end_);
        for (int axis = 0; axis < 3; ++axis) {
            const bool forward = forward_[axis];
            const OctantFloats lower = by_octant(axis, low[axis], cut[axis]);
            const OctantFloats upper = by_octant(axis, cut[axis], high[axis]);
            const OctantFloats near = (forward ? lower : upper) - OctantFloats(entry_origin_[axis]);
            const OctantFloats far = (forward ? upper : lower) - OctantFloats(exit_origin_[axis]);
            first = max(first, near * OctantFloats(entry_scale_[axis]));
            if constexpr (kStraddles) {
                first = max(first, far * OctantFloats(other_entry_scale_[axis]));
                last = min(last, mul_add(far, OctantFloats(exit_scale_[axis]),
                                         OctantFloats(exit_add_[axis])));
            } else {
                last = min(last, far * OctantFloats(exit_scale_[axis]));
            }
        }
        return (first <= last).bits();
    }

  private:
    // A bound is a difference, a quotient of roundings below: 4 units of 2^-24, here twice that.
    static constexpr float kWiden = roundings(8);

    HWY_INLINE void set_exit(int axis, bool bounds_below, float inverse) {
        other_entry_scale_[axis] = bounds_below ? inverse * (1 - kWiden) : 0;
        exit_scale_[axis] = bounds_below ? 0 : inverse * (1 + kWiden);
        exit_add_[axis] = bounds_below ? t_end_ : 0;
    }
    static HWY_INLINE OctantFloats by_octant(int axis, float lower, float upper) {
        return select(upper_octants(axis), OctantFloats(upper), OctantFloats(lower));
    }

    float t_end_;
    bool forward_[3];  // the nearer face is the lower one
    float entry_origin_[3];
    float exit_origin_[3];
    float entry_scale_[3];
    float exit_scale_[3];
    float exit_add_[3];
    float other_entry_scale_[3];
    unsigned flip_;
};

/// Bit i of the result is bit i ^ flip of the 8 bits.
HWY_INLINE std::uint32_t flipped(std::uint32_t bits, unsigned flip) {
    if (flip & 1) bits = (bits & 0x55) << 1 | (bits & 0xaa) >> 1;
    if (flip & 2) bits = (bits & 0x33) << 2 | (bits & 0xcc) >> 2;
    if (flip & 4) bits = (bits & 0x0f) << 4 | (bits & 0xf0) >> 4;
    return bits;
}

/// A voxel on the stack of a walk: its low faces, a word of no meaning, its high faces and another,
/// so that it is written and read by whole registers.
struct alignas(32) StackedVoxel {
    explicit StackedVoxel(const Bounds3T<float>& box)
        : face{box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, 0} {}
    StackedVoxel() = default;
    float face[8];
};

/// Calls put(octant, faces), with the faces of a StackedVoxel, for some octants of a voxel, the
/// farthest first, so that of a stack the nearest is taken next. Octant o ^ flip for o = 0..7 is
/// from near to far.
template <typename Put>
HWY_INLINE void from_far_to_near(std::uint32_t octants, unsigned flip, const StackedVoxel& voxel,
                                 const CompactNode& node, Put&& put) {
    const OctantFloats faces = OctantFloats::load(voxel.face);
    const OctantFloats cut = OctantFloats::load_repeated(node.cut);
    for (std::uint32_t ahead = flipped(octants, flip); ahead != 0;) {
        const auto order = static_cast<unsigned>(31 - std::countl_zero(ahead));
        const unsigned octant = order ^ flip;
        ahead ^= 1U << order;
        // Upper on an axis: the cut is the low face; else the high one.
        const std::uint32_t moved = octant | (~octant & 7) << 4;
        put(octant, select(LaneMask<float, 8>::from_bits(moved), cut, faces));
    }
}

/// Calls `leaf(items, count)` for each leaf that the beam may meet, in the beam's order, until it
/// returns true.
template <bool kStraddles, typename Leaf>
HWY_INLINE void walk_beam(const CompactOctree& octree, const BeamSlabs<kStraddles>& slabs,
                          Leaf&& leaf) {
    StackedVoxel voxels[CompactOctree::kMostWaiting];
    std::uint32_t places[CompactOctree::kMostWaiting];
    const CompactNode* const nodes = octree.nodes.data();
    StackedVoxel voxel(octree.bounds);
    std::uint32_t at = 0;
    int waiting = 0;
    for (;;) {
        const CompactNode& node = nodes[at];
        if (node.is_leaf()) {
            if (leaf(octree.items.data() + node.first_item(), node.item_count())) return;
        } else {
            __builtin_prefetch(nodes + node.first_child());
            const std::uint32_t met = slabs.meets(voxel.face, node.cut, voxel.face + 4);
            from_far_to_near(met & node.mask(), slabs.flip(), voxel, node,
                             [&](unsigned octant, const OctantFloats& faces) HWY_ATTR {
                                 faces.store(voxels[waiting].face);
                                 places[waiting++] = node.child(octant);
                             });
        }
        if (waiting == 0) return;
        at = places[--waiting];
        voxel = voxels[waiting];
    }
}

/// The same, choosing the cheaper slab tests where no axis is straddled.
template <typename Leaf>
HWY_INLINE void walk_beam(const CompactOctree& octree, const BeamBox& beam, Leaf&& leaf) {
    if (beam.straddles())
        walk_beam(octree, BeamSlabs<true>(beam), leaf);
    else
        walk_beam(octree, BeamSlabs<false>(beam), leaf);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_BEAM_H_
