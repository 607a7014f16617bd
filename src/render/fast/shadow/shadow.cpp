#include "fast/shadow/shadow.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shadow/shadow.cpp"
#include <hwy/foreach_target.h>

#include "fast/shadow/segment_walk.h"
#include "fast/shadow/shadow_beam.h"
#include "fast/shadow/shadow_block.h"
#include "fast/shadow/shadow_lookup.h"
#include "fast/tile/beam.h"

// One light, one tile: points are looked up in the light's buffer; those that cannot be go through
// the octree, the points of a block as one beam. Where lists are long the octree is asked first.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class ShadowTracer {
  public:
    ShadowTracer(ShadowJob& job, const Tile& tile, std::size_t light, const ExactFallback& fallback)
        : context_(job, light), tile_(tile), fallback_(fallback), lookup_(context_, blocks_) {}

    void run(const TileMask& wanted, TileMask& lit) {
        std::uint32_t unknown[kTileBlocks];
        const bool walks_first = context_.table.buffer.long_lists;
        for (int b = 0; b < kTileBlocks; ++b) {
            unknown[b] = 0;
            if (wanted[b] == 0) continue;
            blocks_[b].start(context_, tile_, b, wanted[b]);
            const std::uint32_t left = walks_first ? walk(b, wanted[b]) : wanted[b];
            unknown[b] = left & ~lookup_.add(b, left);
        }
        lookup_.run();
        for (int b = 0; b < kTileBlocks; ++b) {
            std::uint32_t left = unknown[b];
            if (!walks_first && left != 0) left = walk(b, left);
            for (; left != 0; left &= left - 1)
                walk_alone(static_cast<std::uint32_t>(b * kBlockLanes + std::countr_zero(left)));
        }
        settle();
        for (int b = 0; b < kTileBlocks; ++b)
            lit[b] = wanted[b] == 0 ? 0 : static_cast<std::uint16_t>(blocks_[b].waiting());
    }

  private:
    // Where floats leave more than this open of a beam or of a point, what is near the points is
    // found in double.
    static constexpr std::size_t kMostOpenOfBeam = 128;
    static constexpr std::ptrdiff_t kMostOpenOfPoint = 32;
    // And where a beam meets more items than this.
    static constexpr std::size_t kMostTests = 1024;
    // Where a leaf holds more items, or more of one come near a ray, what other rays have found of
    // them is asked.
    static constexpr std::uint32_t kLarge = 256;
    static constexpr int kCrowded = 32;

    // All points of a block together; returns those of which it would cost too much.
    HWY_NOINLINE std::uint32_t walk(int b, std::uint32_t lanes) {
        ShadowBlock& block = blocks_[b];
        const ShadowTables& tables = context_.job.tables;
        const RayMask there = RayMask::from_bits(lanes);
        float low[3];
        float high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = lowest(select(there, block.points()[axis], Floats(kFloatInfinity)));
            high[axis] = highest(select(there, block.points()[axis], Floats(-kFloatInfinity)));
        }
        const float slack = highest(select(there, block.plane_error(), Floats(0.0F)));
        std::vector<OpenShadow>& open = context_.job.open;
        const std::size_t open_before = open.size();
        std::size_t tests = 0;
        const auto too_many = [&] {
            return open.size() - open_before > kMostOpenOfBeam || tests > kMostTests;
        };
        Mailbox& mailbox = context_.job.mailbox;
        mailbox.start();
        walk_beam(tables.scene().octree(), beam_to_light(context_.table.light, low, high, slack),
                  [&](const std::uint32_t* items, std::uint32_t count) HWY_ATTR {
                      for (std::uint32_t i = 0; i < count && !too_many(); ++i, ++tests)
                          if (context_.job.walk_planes.may_hide(context_.light, items[i]) &&
                              !mailbox.seen(items[i]))
                              block.test_met(context_, items[i], lanes);
                      return (block.waiting() & lanes) == 0 || too_many();
                  });
        if (!too_many()) return 0;
        open.resize(open_before);
        return block.waiting() & lanes;
    }

    auto shadow_ray(std::uint32_t lane) const {
        const auto i = static_cast<int>(lane);
        return fallback_.shadow_ray(tile_.x + lane_x(i), tile_.y + lane_y(i), tile_.slot[i],
                                    context_.light);
    }

    // The walk of a single point, in double.
    HWY_NOINLINE void walk_alone(std::uint32_t lane) {
        if (fallback_.any_way(shadow_ray(lane),
                              [&](const auto& ray) { return walk_along(ray, lane); }))
            block_lane(lane);
    }
    template <typename Shadow>
    bool walk_along(const Shadow& ray, std::uint32_t lane) {
        const FastScene& scene = context_.job.tables.scene();
        Mailbox& mailbox = context_.job.mailbox;
        mailbox.start();
        // The lit primitive, whose root rounding may lose, is asked in any case.
        const Slot lit = tile_.slot[lane];
        if (fallback_.blocks(ray, lit)) return true;
        mailbox.seen(lit);
        const auto leaf = [&](const std::uint32_t* items, std::uint32_t count) {
            if (count > kLarge) return fallback_.blocks_any(ray, {items, count});
            if (!fallback_.may_visit(count)) return true;
            int near = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                if (!context_.job.walk_planes.may_hide(context_.light, items[i]) ||
                    mailbox.seen(items[i]) || !fallback_.comes_near(ray, items[i]))
                    continue;
                if (++near > kCrowded) return fallback_.blocks_any(ray, {items, count});
                if (fallback_.blocks(ray, items[i])) return true;
            }
            return false;
        };
        return SegmentWalk(ray.ray, ray.end, scene.frame()).any(scene.octree(), leaf);
    }
    void block_lane(std::uint32_t lane) {
        blocks_[lane / kBlockLanes].block(1U << lane % kBlockLanes);
    }

    // By counting: lists are long where nothing else is.
    static void sort_by_lane(std::vector<OpenShadow>& open) {
        std::size_t starts[kTileLanes + 1] = {};
        for (const OpenShadow& one : open) ++starts[one.lane + 1];
        for (int lane = 0; lane < kTileLanes; ++lane) starts[lane + 1] += starts[lane];
        std::vector<OpenShadow> sorted(open.size());
        for (const OpenShadow& one : open) sorted[starts[one.lane]++] = one;
        open = std::move(sorted);
    }

    // Asks the fallback about the points that nothing has surely blocked, point by point, so that
    // each point's shadow ray is made once.
    void settle() {
        std::vector<OpenShadow>& open = context_.job.open;
        if (open.empty()) return;
        sort_by_lane(open);
        for (auto at = open.begin(); at != open.end();) {
            const std::uint32_t lane = at->lane;
            const auto end = std::find_if(at, open.end(),
                                          [lane](const auto& other) { return other.lane != lane; });
            const bool waiting =
                (blocks_[lane / kBlockLanes].waiting() >> lane % kBlockLanes & 1) != 0;
            if (waiting && end - at > kMostOpenOfPoint) {
                walk_alone(lane);
            } else if (waiting) {
                const auto blocked = [&](const auto& ray) {
                    return std::any_of(
                        at, end, [&](const auto& o) { return fallback_.blocks(ray, o.item); });
                };
                if (fallback_.any_way(shadow_ray(lane), blocked)) block_lane(lane);
            }
            at = end;
        }
        open.clear();
    }

    ShadowContext context_;
    const Tile& tile_;
    const ExactFallback& fallback_;
    ShadowBlock blocks_[kTileBlocks];
    ShadowLookup lookup_;
};

void trace_shadows(ShadowJob& job, const Tile& tile, std::size_t light, const TileMask& wanted,
                   const ExactFallback& fallback, TileMask& lit) {
    ShadowTracer(job, tile, light, fallback).run(wanted, lit);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

ShadowStage::ShadowStage(const ShadowTables& tables, PairShadows& pairs, InstructionSet isa,
                         bool redo_exactly, bool new_points)
    : job_{tables, pairs, redo_exactly, new_points}, trace_(NUVO_FOR_ISA(isa, trace_shadows)) {}

void ShadowStage::trace(const Tile& tile, std::size_t light, const TileMask& wanted,
                        const ExactFallback& fallback, TileMask& lit) {
    if (job_.tables.scene().scene().lights[light].casts_shadow)
        trace_(job_, tile, light, wanted, fallback, lit);
    else
        lit = wanted;
}

}  // namespace nuvo
#endif
