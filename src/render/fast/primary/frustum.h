// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_FRUSTUM_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_FRUSTUM_H_
#undef NUVO_RENDER_FAST_FRUSTUM_H_
#else
#define NUVO_RENDER_FAST_FRUSTUM_H_
#endif

#include <cmath>

#include "fast/camera/camera_tables.h"
#include "fast/primary/affine_lanes.h"
#include "fast/primary/macro_tile.h"
#include "fast/simd/lanes.h"
#include "fast/tile/beam.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/compact.h"

// The octree from near to far as a macro tile sees it: where in the tile a voxel can be seen, and
// how near its contents may be, for all eight octants of a node at once. Voxels between the middles
// of pixels are left out, and those that only cover pixels which show something nearer (Greene,
// Kass and Miller 1993, "Hierarchical Z-buffer visibility").
//
// A point p at the depth z = p.forward from the eye is seen A / z pixels from the macro tile's
// middle, A and z being affine in p; in a parallel projection z is 1 everywhere. Over a box an
// affine function is its value in the middle, more or less the sum of |coefficient| half width.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Blocks of a macro tile, as columns and rows first .. last, four bits each.
struct BlockRange {
    std::uint32_t packed;

    static constexpr std::uint32_t kAll = 0xf0f0;
    int first_column() const { return static_cast<int>(packed & 15); }
    int last_column() const { return static_cast<int>(packed >> 4 & 15); }
    int first_row() const { return static_cast<int>(packed >> 8 & 15); }
    int last_row() const { return static_cast<int>(packed >> 12 & 15); }
};

/// The pyramid of the rays of a macro tile, in a parallel projection their prism.
class Frustum {
  public:
    /// Where the octants of a voxel can be seen.
    struct Seen {
        float range[8];    ///< BlockRange as a float
        float nearest[8];  ///< bounds q of what is in it from above
    };

    /// For points whose local coordinates are at most `reach`.
    Frustum(const CameraRays& camera, const MacroTile& tile, double reach)
        : parallel_(camera.parallel), starts_at_(start_range(camera).high) {
        // Zero where the depth does not grow with the way.
        const Vector3 forward = parallel_ ? Vector3{} : camera.forward;
        depth_ = Affine(forward, forward, camera.origin, reach, parallel_ ? 1 : 0);
        if (parallel_) toward_ = Affine(-camera.forward, camera.forward, camera.origin, reach);
        const double middle[2] = {camera.center_x(tile.x) + kMiddle,
                                  camera.center_y(tile.y) + kMiddle};
        const Vector3 step[2] = {camera.right, camera.down};
        Vector3 across[2];
        for (int k = 0; k < 2; ++k) {
            const Vector3 pixels = step[k] * (1 / dot(step[k], step[k]));
            across[k] = pixels - forward * middle[k];
            Vector3 size;
            for (int axis = 0; axis < 3; ++axis)
                size[axis] = std::fabs(pixels[axis]) + std::fabs(forward[axis] * middle[k]);
            across_[k] = Affine(across[k], size, camera.origin, reach, parallel_ ? -middle[k] : 0);
            // Positive before the eye on the inner side of an edge of the pyramid, a pixel and a
            // half outside of the outermost rays.
            constexpr double kBeyond = kMiddle + 1.5;
            for (int side = 0; side < 2; ++side)
                sides_[2 * k + side] =
                    Affine(forward * kBeyond + across[k] * (side == 0 ? 1.0 : -1.0),
                           size + magnitude(forward) * kBeyond, camera.origin, reach);
        }
        usable_ = depth_.usable();
        for (const Affine& f : across_) usable_ = usable_ && f.usable();
        for (const Affine& f : sides_) usable_ = usable_ && f.usable();
        const Vector3 toward = camera.direction(middle[0], middle[1]);
        flip_ = 0;
        for (int axis = 0; axis < 3; ++axis)
            if (toward[axis] < 0) flip_ |= 1U << axis;
    }

    /// Octant o ^ flip() for o = 0..7 is an order from near to far.
    unsigned flip() const { return flip_; }

    /// The octants of the voxel that the macro tile may show: all, and anywhere, where floats
    /// cannot hold the view's numbers.
    HWY_INLINE std::uint32_t sees(const float* low, const float* cut, const float* high,
                                  Seen& seen) const {
        if (HWY_UNLIKELY(!usable_)) {
            OctantFloats(BlockRange::kAll).store(seen.range);
            OctantFloats(kFloatInfinity).store(seen.nearest);
            return 0xff;
        }
        MiddlesAndHalves boxes;
        for (int axis = 0; axis < 3; ++axis) {
            const auto upper = upper_octants(axis);
            const float a = low[axis];
            const float b = cut[axis];
            const float c = high[axis];
            boxes.middle[axis] =
                select(upper, OctantFloats(0.5F * (b + c)), OctantFloats(0.5F * (a + b)));
            boxes.half[axis] =
                select(upper, OctantFloats(0.5F * (c - b)), OctantFloats(0.5F * (b - a)));
            boxes.distance[axis] = abs(boxes.middle[axis]);
        }
        const OctantFloats zero(0.0F);
        const OctantFloats one(1.0F);
        const OctantFloats depth = depth_.at(boxes.middle);
        const OctantFloats spread = depth_.spread(boxes);
        const OctantFloats near = depth - spread;
        const OctantFloats far = depth + spread;
        // Boxes that reach behind the eye or all but: anywhere in the tile.
        const auto anywhere = near <= OctantFloats(kLeastDepth);
        auto shown = far > zero;
        const OctantFloats by_near = one / near;
        const OctantFloats by_far = one / far;
        OctantFloats first[2];
        OctantFloats last[2];
        const OctantFloats most(kMacroSide - 1);
        for (int k = 0; k < 2; ++k) {
            const OctantFloats middle = across_[k].at(boxes.middle);
            const OctantFloats reach = across_[k].spread(boxes);
            const OctantFloats low_end = middle - reach;
            const OctantFloats high_end = middle + reach;
            first[k] = first_pixel(min(low_end * by_near, low_end * by_far), OctantFloats(kMargin));
            last[k] = last_pixel(max(high_end * by_near, high_end * by_far), OctantFloats(kMargin));
            shown = without(shown, without(no_pixel(first[k], last[k]), anywhere));
        }
        std::uint32_t octants = shown.bits();
        if ((octants & anywhere.bits()) != 0)
            for (const Affine& side : sides_)
                octants &= ~(anywhere & (side.at(boxes.middle) + side.spread(boxes) < zero)).bits();
        if (octants == 0) return 0;
        const OctantFloats quarter(1.0F / kBlockSide);
        const auto block = [&](const OctantFloats& pixel)
                               HWY_ATTR { return floor(min(max(pixel, zero), most) * quarter); };
        const OctantFloats sixteen(16.0F);
        const OctantFloats rows = mul_add(block(last[1]), sixteen, block(first[1]));
        const OctantFloats columns = mul_add(block(last[0]), sixteen, block(first[0]));
        select(anywhere, OctantFloats(BlockRange::kAll), mul_add(rows, sixteen * sixteen, columns))
            .store(seen.range);
        if (parallel_) {
            const OctantFloats toward = toward_.at(boxes.middle);
            const OctantFloats reach = toward_.spread(boxes);
            (toward + reach).store(seen.nearest);
            return octants & (toward - reach < OctantFloats(starts_at_)).bits();
        }
        select(anywhere, OctantFloats(kFloatInfinity), by_near * OctantFloats(1 + roundings(4)))
            .store(seen.nearest);
        return octants;
    }

    /// Which of 16 triangles may cover the middle of a pixel: at[i] are their corners, rounded to
    /// nearest, `size` the largest |coordinate| on each axis.
    HWY_INLINE RayMask may_cover(const Floats (&at)[3][3], const Floats (&size)[3]) const {
        if (HWY_UNLIKELY(!usable_)) return RayMask::from_bits(0xffff);
        Floats near(kFloatInfinity);
        Floats low[2] = {near, near};
        Floats high[2] = {-near, -near};
        for (const auto& corner : at) {
            const Floats depth = depth_.at(corner);
            const Floats inverse = Floats(1.0F) / depth;
            near = min(near, depth);
            for (int k = 0; k < 2; ++k) {
                const Floats pixel = across_[k].at(corner) * inverse;
                low[k] = min(low[k], pixel);
                high[k] = max(high[k], pixel);
            }
        }
        // What the errors of both affine functions add to a quotient where the depth may be half as
        // large. [numerics: voxels seen by a macro tile]
        const Floats depth_error = depth_.error(size);
        const RayMask known = near > max(depth_error + depth_error, Floats(kLeastDepth));
        const Floats twice_inverse = Floats(2.0F) / near;
        RayMask missed = RayMask::from_bits(0);
        for (int k = 0; k < 2; ++k) {
            const Floats farthest = max(abs(low[k]), abs(high[k]));
            const Floats slack = mul_add(mul_add(farthest, depth_error, across_[k].error(size)),
                                         twice_inverse, Floats(kMargin));
            missed = missed | no_pixel(first_pixel(low[k], slack), last_pixel(high[k], slack));
        }
        missed = missed & known;
        if (HWY_UNLIKELY((~known).any()))
            for (const Affine& side : sides_)
                missed = missed | (max(side.at(at[0]), max(side.at(at[1]), side.at(at[2]))) <
                                   -side.error(size));
        return ~missed;
    }

  private:
    // In pixels: far more than the rounding of a quotient that lies within the tile.
    static constexpr float kMargin = 0x1p-6F;
    static constexpr float kLeastDepth = 0x1p-90F;
    // The tile's middle, from that of its first pixel.
    static constexpr float kMiddle = 0.5F * (kMacroSide - 1);

    // The first pixel whose middle is not surely before `at`, which counts from the tile's middle,
    // and the last that is not surely behind it, both from the tile's first pixel on.
    template <typename Numbers>
    static HWY_INLINE Numbers first_pixel(const Numbers& at, const Numbers& slack) {
        return -floor(slack - Numbers(kMiddle) - at);
    }
    template <typename Numbers>
    static HWY_INLINE Numbers last_pixel(const Numbers& at, const Numbers& slack) {
        return floor(at + (slack + Numbers(kMiddle)));
    }
    // Whether the tile surely has none of these; NaN says no.
    template <typename Numbers>
    static HWY_INLINE typename Numbers::Mask no_pixel(const Numbers& first, const Numbers& last) {
        return (first > last) | (first > Numbers(kMacroSide - 1)) | (last < Numbers(0.0F));
    }

    bool parallel_;
    float starts_at_;
    Affine toward_;  // q, of a parallel projection
    Affine depth_;
    Affine across_[2];
    Affine sides_[4];
    bool usable_;  // whether floats hold the view's numbers
    unsigned flip_;
};

/// Calls `leaf(items, count)` for each leaf that the macro tile may show, from near to far, but for
/// voxels of which is_open(range, nearest) says that nothing in them matters. A leaf comes a few
/// leaves late, when its items have arrived from memory.
template <typename IsOpen, typename Leaf>
HWY_INLINE void walk_frustum(const CompactOctree& octree, const Frustum& frustum, IsOpen&& is_open,
                             Leaf&& leaf) {
    struct Place {
        float nearest;
        std::uint32_t node;
        BlockRange range;
    };
    constexpr unsigned kLate = 8;
    StackedVoxel voxels[CompactOctree::kMostWaiting];
    Place places[CompactOctree::kMostWaiting];
    const CompactNode* late[kLate] = {};
    unsigned next_late = 0;
    const CompactNode* const nodes = octree.nodes.data();
    const std::uint32_t* const items = octree.items.data();
    StackedVoxel voxel(octree.bounds);
    std::uint32_t at = 0;
    int waiting = 0;
    for (;;) {
        const CompactNode& node = nodes[at];
        if (node.is_leaf()) {
            const std::uint32_t* const first = items + node.first_item();
            __builtin_prefetch(first);
            if (node.item_count() != 0) __builtin_prefetch(first + node.item_count() - 1);
            const CompactNode*& place = late[next_late++ % kLate];
            if (place != nullptr) leaf(items + place->first_item(), place->item_count());
            place = &node;
        } else {
            __builtin_prefetch(nodes + node.first_child());
            Frustum::Seen seen;
            const std::uint32_t seen_octants =
                frustum.sees(voxel.face, node.cut, voxel.face + 4, seen);
            from_far_to_near(seen_octants & node.mask(), frustum.flip(), voxel, node,
                             [&](unsigned octant, const OctantFloats& faces) HWY_ATTR {
                                 faces.store(voxels[waiting].face);
                                 places[waiting++] = {
                                     seen.nearest[octant],
                                     node.child(octant),
                                     {static_cast<std::uint32_t>(
                                         static_cast<std::int32_t>(seen.range[octant]))}};
                             });
        }
        do {
            if (waiting == 0) {
                for (unsigned i = 0; i < kLate; ++i)
                    if (const CompactNode* const place = late[next_late++ % kLate])
                        leaf(items + place->first_item(), place->item_count());
                return;
            }
            --waiting;
        } while (!is_open(places[waiting].range, places[waiting].nearest));
        at = places[waiting].node;
        voxel = voxels[waiting];
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_FRUSTUM_H_
