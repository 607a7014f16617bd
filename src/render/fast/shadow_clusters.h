// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_CLUSTERS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_CLUSTERS_H_
#undef NUVO_RENDER_FAST_SHADOW_CLUSTERS_H_
#else
#define NUVO_RENDER_FAST_SHADOW_CLUSTERS_H_
#endif

#include <bit>
#include <cmath>
#include <limits>

#include "lanes.h"
#include "shadow_lanes.h"
#include "tile.h"

// A tile's lit points, split into clusters until each lies together: points on one surface share a
// thin beam to the light, points on several would share a thick one (Mora 2011, "Naive ray-tracing:
// a divide-and-conquer approach", splits rays the like way).

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The numbers of a tile's lanes.
struct LaneNumbers {
    constexpr LaneNumbers() {
        for (int i = 0; i < kTileLanes; ++i) lane[i] = i;
    }
    alignas(64) std::int32_t lane[kTileLanes]{};
};
inline constexpr LaneNumbers kLaneNumbers{};

class PointClusters {
  public:
    /// `leaf_width`: see ShadowTables; no beam is left thicker.
    PointClusters(const Tile& tile, const TileMask& wanted, const LightPoint& light,
                  float leaf_width)
        : thickest_(leaf_width) {
        Floats error(0.0F);
        for (int b = 0; b < kTileBlocks; ++b)
            if (wanted[b] != 0) add(tile, b, wanted[b], error);
        point_error_ = highest(error);
        if (count_ > 0) whole_ = box(0, count_);
        weigh_axes(light);
    }

    /// The largest of the points.
    float point_error() const { return point_error_; }

    /// Calls `use(first, count, box)` for runs of at most kTileLanes points.
    template <typename Use>
    HWY_INLINE void for_each(Use&& use) {
        struct Run {
            int first;
            int count;
            PointBox box;
        };
        Run waiting[kTileLanes];
        int runs = 0;
        if (count_ > 0) waiting[runs++] = {0, count_, whole_};
        while (runs > 0) {
            const Run run = waiting[--runs];
            if (thickness(run.box) > thickest_ && run.count > 1) {
                const int below = split(run.first, run.count, run.box);
                const int above = run.count - below;
                if (below > 0 && above > 0) {
                    waiting[runs++] = {run.first, below, box(run.first, below)};
                    waiting[runs++] = {run.first + below, above, box(run.first + below, above)};
                    continue;
                }
            }
            use(run.first, run.count, run.box);
        }
    }

    /// Points from `first` on; those behind the first `count` repeat the last.
    HWY_INLINE Points points(int first, int count) const {
        Points p{Floats::load(at_[0] + first), Floats::load(at_[1] + first),
                 Floats::load(at_[2] + first)};
        if (count < 16) {
            const RayMask there = RayMask::from_bits((1U << count) - 1);
            const int last = first + count - 1;
            p.x = select(there, p.x, Floats(at_[0][last]));
            p.y = select(there, p.y, Floats(at_[1][last]));
            p.z = select(there, p.z, Floats(at_[2][last]));
        }
        return p;
    }
    /// Which of 16 points from `first` on lie on the primitive `slot`.
    HWY_INLINE std::uint32_t of_slot(int first, Slot slot) const {
        return (Ints::load(slot_ + first) == Ints(static_cast<std::int32_t>(slot))).bits();
    }
    /// Whether 16 points from `first` on are those of a whole block in order.
    bool is_block(int first) const {
        return first + 16 <= count_ && lane_[first] % 16 == 0 &&
               (Ints::load(lane_ + first) == Ints::load(kLaneNumbers.lane + lane_[first])).bits() ==
                   0xffff;
    }
    std::uint32_t lane(int i) const { return static_cast<std::uint32_t>(lane_[i]); }

    static HWY_INLINE PointBox box(const Points& p) {
        return {{lowest(p.x), lowest(p.y), lowest(p.z)},
                {highest(p.x), highest(p.y), highest(p.z)}};
    }

  private:
    static constexpr double kLeastAcross = 0.03;

    HWY_INLINE void add(const Tile& tile, int b, std::uint32_t lanes, Floats& error) {
        const int from = b * kBlockLanes;
        const Floats errors = Floats::load(tile.point_error + from);
        const auto* const slots = reinterpret_cast<const std::int32_t*>(tile.slot) + from;
        const Ints numbers = Ints::load(kLaneNumbers.lane + from);
        if (lanes == 0xffff) {
            for (int axis = 0; axis < 3; ++axis)
                Floats::load(tile.point[axis] + from).store(at_[axis] + count_);
            error = max(error, errors);
            Ints::load(slots).store(slot_ + count_);
            numbers.store(lane_ + count_);
        } else {
            const RayMask mask = RayMask::from_bits(lanes);
            const auto ints = mask_for<std::int32_t>(mask);
            for (int axis = 0; axis < 3; ++axis)
                Floats::load(tile.point[axis] + from).compress_store(at_[axis] + count_, mask);
            error = max(error, select(mask, errors, Floats(0.0F)));
            Ints::load(slots).compress_store(slot_ + count_, ints);
            numbers.compress_store(lane_ + count_, ints);
        }
        count_ += std::popcount(lanes);
    }

    // A beam gets no thicker by what its points lie apart on the way to the light.
    void weigh_axes(const LightPoint& light) {
        Vector3 way = light.toward;
        for (int axis = 0; axis < 3; ++axis)
            way[axis] -= light.weight * 0.5 * (whole_.low[axis] + whole_.high[axis]);
        const Vector3 unit = normalized(way);
        for (int axis = 0; axis < 3; ++axis)
            across_[axis] = static_cast<float>(std::fmax(1 - std::fabs(unit[axis]), kLeastAcross));
    }
    float thickness(const PointBox& box) const {
        return across_[0] * box.extent(0) + across_[1] * box.extent(1) + across_[2] * box.extent(2);
    }

    HWY_INLINE PointBox box(int first, int count) const {
        Points low = points(first, std::min(count, 16));
        Points high = low;
        for (int i = 16; i < count; i += 16) {
            const Points p = points(first + i, std::min(count - i, 16));
            low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
            high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
        }
        return {{lowest(low.x), lowest(low.y), lowest(low.z)},
                {highest(high.x), highest(high.y), highest(high.z)}};
    }

    // Puts the points below the middle of the box' longest side first; returns their number.
    int split(int first, int count, const PointBox& box) {
        const auto extent = [&](int i) { return across_[i] * box.extent(i); };
        int axis = extent(0) >= extent(1) ? 0 : 1;
        if (extent(2) > extent(axis)) axis = 2;
        const Floats middle(0.5F * (box.low[axis] + box.high[axis]));
        alignas(64) std::int32_t upper[5][kTileLanes + 16];
        int below = first;
        int above = 0;
        for (int i = 0; i < count; i += 16) {
            const std::uint32_t there = count - i < 16 ? (1U << (count - i)) - 1 : 0xffff;
            const int from = first + i;
            const std::uint32_t less = there & (Floats::load(at_[axis] + from) < middle).bits();
            const Ints v[5] = {ints(at_[0], from), ints(at_[1], from), ints(at_[2], from),
                               Ints::load(slot_ + from), Ints::load(lane_ + from)};
            std::int32_t* const to[5] = {bits(at_[0]), bits(at_[1]), bits(at_[2]), slot_, lane_};
            const auto low = LaneMask<std::int32_t, 16>::from_bits(less);
            const auto high = LaneMask<std::int32_t, 16>::from_bits(there ^ less);
            alignas(64) std::int32_t kept[16];
            for (int k = 0; k < 5; ++k) {
                v[k].compress_store(upper[k] + above, high);
                v[k].compress_store(kept, low);
                std::copy(kept, kept + std::popcount(less), to[k] + below);
            }
            below += std::popcount(less);
            above += std::popcount(there ^ less);
        }
        std::int32_t* const to[5] = {bits(at_[0]), bits(at_[1]), bits(at_[2]), slot_, lane_};
        for (int k = 0; k < 5; ++k) std::copy(upper[k], upper[k] + above, to[k] + below);
        return below - first;
    }
    static Ints ints(const float* from, int at) {
        return Ints::load(reinterpret_cast<const std::int32_t*>(from) + at);
    }
    static std::int32_t* bits(float* at) { return reinterpret_cast<std::int32_t*>(at); }

    PointBox whole_{};
    float across_[3];
    float thickest_;
    int count_ = 0;
    float point_error_ = 0;
    // With room for a register beyond the last.
    alignas(64) float at_[3][kTileLanes + 16];
    alignas(64) std::int32_t slot_[kTileLanes + 16];
    alignas(64) std::int32_t lane_[kTileLanes + 16];
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_CLUSTERS_H_
