#include "fast/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shadow.cpp"
#include <hwy/foreach_target.h>

#include "fast/beam.h"
#include "fast/shadow_clusters.h"
#include "fast/shadow_lanes.h"

// One light, one tile. A way from a point to the light is blocked as soon as one item surely blocks
// it; what floats leave open is put aside and asked of the referee only for the points that nothing
// blocked surely.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class ShadowTracer {
  public:
    ShadowTracer(ShadowJob& job, const Tile& tile, std::size_t light, const TileMask& wanted,
                 TileMask& lit)
        : job_(job),
          scene_(job.tables.scene()),
          table_(job.tables.table(light)),
          clusters_(tile, wanted),
          lit_(lit),
          rounds_(job.tables.has_rounds()) {
        const float error = clusters_.point_error() * (1 + 4 * kRoundoff);
        plane_error_ = (error + job.tables.plane_error()) * (1 + 4 * kRoundoff);
        round_error_ = (2 * error + job.tables.round_error()) * (1 + 4 * kRoundoff);
    }

    void run() {
        clusters_.for_each([&](int first, int count, const PointBox& box) HWY_ATTR {
            load(first, count);
            trace_beam(box);
            for (int p = 0; p < packets_; ++p) finish(p);
        });
    }

  private:
    static constexpr float kRoundoff = 0x1p-24F;

    // Copies a cluster's lanes into packets, the last filled up with its own last lane.
    HWY_INLINE void load(int first, int count) {
        first_ = first;
        packets_ = (count + 15) / 16;
        alive_ = (1U << packets_) - 1;
        for (int p = 0; p < packets_; ++p) {
            const int here = std::min(16, count - 16 * p);
            waiting_[p] = (1U << here) - 1;
            points_[p] = clusters_.points(first + 16 * p, here);
        }
        if (packets_ > 1) load_boxes();
        if (rounds_)
            for (int p = 0; p < packets_; ++p) ways_[p] = Ways(table_.light, points_[p]);
    }

    // The middles of the packets' boxes and how far their points are from these.
    HWY_INLINE void load_boxes() {
        alignas(64) float center[3][16] = {};
        alignas(64) float half[16] = {};
        alignas(64) float radius[16] = {};
        for (int p = 0; p < packets_; ++p) {
            const PointBox box = PointClusters::box(points_[p]);
            float square = 0;
            for (int axis = 0; axis < 3; ++axis) {
                // One rounding of the middle, one of the difference.
                const float h = 0.5F * box.extent(axis) * (1 + 4 * kRoundoff) + 2 * kRoundoff;
                center[axis][p] = 0.5F * (box.low[axis] + box.high[axis]);
                half[p] = std::max(half[p], h);
                square += h * h;
            }
            radius[p] = square;
        }
        centers_ = {Floats::load(center[0]), Floats::load(center[1]), Floats::load(center[2])};
        box_error_ = Floats::load(half) + Floats(plane_error_);
        if (!rounds_) return;
        center_ways_ = Ways(table_.light, centers_);
        round_box_error_ =
            sqrt(Floats::load(radius)) * Floats(1 + 8 * kRoundoff) + Floats(round_error_);
    }

    void trace_beam(const PointBox& box) {
        job_.mailbox.start();
        const Slot triangle_end = scene_.triangle_end();
        walk_beam(
            scene_.octree(), beam_to(box), [](float) { return false; },
            [&](const std::uint32_t* items, std::uint32_t count, float) HWY_ATTR {
                for (std::uint32_t i = 0; i < count; ++i) {
                    const Slot slot = items[i];
                    if (job_.mailbox.seen(slot)) continue;
                    if (slot < triangle_end)
                        test_triangle(slot);
                    else
                        test_round(slot);
                    if (alive_ == 0) return true;
                }
                return false;
            });
    }

    // From a light nearby to the points, else from the points towards the light.
    BeamBox beam_to(const PointBox& box) const {
        constexpr double kNear = 0x1p-6;
        const LightPoint& light = table_.light;
        const float slack = plane_error_ + 8 * kRoundoff;
        BeamBox beam;
        const bool from_light = light.weight >= kNear;
        for (int axis = 0; axis < 3; ++axis) {
            const float low = box.low[axis] - slack;
            const float high = box.high[axis] + slack;
            const auto toward = static_cast<float>(light.toward[axis]);
            if (from_light) {
                const auto from = static_cast<float>(light.toward[axis] / light.weight);
                const float rounding = 4 * kRoundoff * (std::fabs(from) + 2);
                beam.origin_low[axis] = from - rounding;
                beam.origin_high[axis] = from + rounding;
                beam.direction_low[axis] = low - from - rounding;
                beam.direction_high[axis] = high - from + rounding;
            } else {
                const auto weight = static_cast<float>(light.weight);
                const float rounding = light.weight == 0 && toward == 0 ? 0x1p-100F : 4 * kRoundoff;
                beam.origin_low[axis] = low;
                beam.origin_high[axis] = high;
                beam.direction_low[axis] = toward - weight * high - rounding;
                beam.direction_high[axis] = toward - weight * low + rounding;
            }
        }
        constexpr double kEndless = 0x1p60;
        beam.t_end =
            from_light ? 1.0F : static_cast<float>(std::min(kEndless, 1.0001 / light.weight));
        beam.far_first = from_light;
        beam.keep_off_zero();
        return beam;
    }

    HWY_INLINE void test_triangle(Slot slot) {
        const ShadowPlanes& planes = table_.planes[slot];
        std::uint32_t packets = alive_;
        if (packets_ > 1) {
            const Floats depth = hidden(planes, centers_);
            packets &= ~(depth < -box_error_).bits();
            const std::uint32_t sure = packets & (depth > box_error_).bits();
            block_whole(sure);
            packets ^= sure;
        }
        for (; packets != 0; packets &= packets - 1) {
            const int p = std::countr_zero(packets);
            const Floats depth = hidden(planes, points_[p]);
            const std::uint32_t perhaps = waiting_[p] & ~(depth < Floats(-plane_error_)).bits();
            if (perhaps == 0) continue;
            const std::uint32_t sure = perhaps & (depth > Floats(plane_error_)).bits();
            block(p, sure);
            if (perhaps != sure) put_aside(slot, p, perhaps ^ sure, depth > Floats(0.0F));
        }
    }

    HWY_INLINE void test_round(Slot slot) {
        const RoundShape& shape = job_.tables.round(slot);
        const LightSide side = table_.round_sides.empty()
                                   ? LightSide::kOutside
                                   : table_.round_sides[slot - scene_.triangle_end()];
        const bool sphere = slot < scene_.sphere_end();
        std::uint32_t packets = alive_;
        if (packets_ > 1) {
            const RoundTest test(shape, centers_, center_ways_, round_box_error_);
            packets &= ~free(test, side, sphere);
            if (packets == 0) return;
            const std::uint32_t sure = packets & blocked(test, side, sphere);
            block_whole(sure);
            packets ^= sure;
        }
        for (; packets != 0; packets &= packets - 1)
            test_round(slot, shape, side, sphere, std::countr_zero(packets));
    }

    HWY_INLINE void test_round(Slot slot, const RoundShape& shape, LightSide side, bool sphere,
                               int p) {
        const RoundTest test(shape, points_[p], ways_[p], Floats(round_error_));
        const std::uint32_t own = clusters_.of_slot(first_ + 16 * p, slot) & waiting_[p];
        std::uint32_t perhaps = waiting_[p] & ~own & ~free(test, side, sphere);
        std::uint32_t sure = perhaps & blocked(test, side, sphere);
        if (own != 0) {
            // The way from the sphere itself enters it iff it points inwards.
            const Floats margin =
                mul_add(ways_[p].inverse, Floats(round_error_), Floats(round_error_));
            if (!sphere)
                perhaps |= own;
            else if (side != LightSide::kInside)
                perhaps |= own & ~(test.along < -margin).bits();
            if (sphere && side == LightSide::kOutside) sure |= own & (test.along > margin).bits();
        }
        if (perhaps == 0) return;
        block(p, sure);
        if (perhaps != sure)
            put_aside(slot, p, perhaps & ~sure, without(test.crosses, test.behind | test.beyond));
    }

    static HWY_INLINE std::uint32_t free(const RoundTest& test, LightSide side, bool sphere) {
        RayMask mask = test.passes | (test.outside & test.behind);
        if (side == LightSide::kOutside) mask = mask | (test.outside & test.beyond);
        if (side == LightSide::kInside && sphere) mask = mask | test.inside;
        return mask.bits();
    }
    static HWY_INLINE std::uint32_t blocked(const RoundTest& test, LightSide side, bool sphere) {
        if (!sphere || side == LightSide::kUnknown) return 0;
        if (side == LightSide::kInside) return test.outside.bits();
        const RayMask through = without(test.crosses & test.outside, test.behind | test.beyond);
        return (through | test.inside).bits();
    }

    HWY_INLINE void block_whole(std::uint32_t packets) {
        alive_ &= ~packets;
        for (; packets != 0; packets &= packets - 1) waiting_[std::countr_zero(packets)] = 0;
    }
    HWY_INLINE void block(int p, std::uint32_t lanes) {
        waiting_[p] &= ~lanes;
        if (waiting_[p] == 0) alive_ &= ~(1U << p);
    }
    HWY_NOINLINE void put_aside(Slot slot, int p, std::uint32_t lanes, const RayMask& rounded) {
        if (slot < scene_.triangle_end()) lanes &= ~clusters_.of_slot(first_ + 16 * p, slot);
        if (!job_.redo_exactly) {
            block(p, lanes & rounded.bits());
            return;
        }
        for (; lanes != 0; lanes &= lanes - 1)
            job_.open.push_back({clusters_.lane(first_ + 16 * p + std::countr_zero(lanes)), slot});
    }

    // The lanes that are still waiting are lit.
    HWY_INLINE void finish(int p) {
        for (std::uint32_t lanes = waiting_[p]; lanes != 0; lanes &= lanes - 1) {
            const std::uint32_t lane = clusters_.lane(first_ + 16 * p + std::countr_zero(lanes));
            lit_[lane / 16] = static_cast<std::uint16_t>(lit_[lane / 16] | 1U << lane % 16);
        }
    }

    ShadowJob& job_;
    const FastScene& scene_;
    const ShadowTable& table_;
    PointClusters clusters_;
    TileMask& lit_;
    bool rounds_;
    float plane_error_;
    float round_error_;

    // The cluster that is being traced.
    int first_ = 0;
    int packets_ = 0;
    std::uint32_t alive_ = 0;    // packets with lanes that wait
    std::uint32_t waiting_[16];  // lanes that nothing has blocked yet
    Points points_[16];
    Ways ways_[16];
    Points centers_;
    Ways center_ways_;
    Floats box_error_;
    Floats round_box_error_;
};

void trace_shadows(ShadowJob& job, const Tile& tile, std::size_t light, const TileMask& wanted,
                   TileMask& lit) {
    ShadowTracer(job, tile, light, wanted, lit).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

ShadowStage::ShadowStage(const ShadowTables& tables, InstructionSet isa, bool redo_exactly)
    : job_{tables, redo_exactly}, trace_(NUVO_FOR_ISA(isa, trace_shadows)) {}

void ShadowStage::trace(const Tile& tile, std::size_t light, const TileMask& wanted,
                        const Referee& referee, TileMask& lit) {
    if (!job_.tables.scene().scene().lights[light].casts_shadow) {
        std::copy(std::begin(wanted), std::end(wanted), std::begin(lit));
        return;
    }
    std::fill(std::begin(lit), std::end(lit), std::uint16_t{0});
    job_.open.clear();
    trace_(job_, tile, light, wanted, lit);
    for (const OpenShadow& open : job_.open) {
        const std::uint32_t lane = open.lane;
        const auto bit = static_cast<std::uint16_t>(1U << lane % 16);
        if ((lit[lane / 16] & bit) == 0) continue;
        const int at = static_cast<int>(lane);
        if (referee.blocks(tile.x + lane_x(at), tile.y + lane_y(at), tile.slot[at], light,
                           open.item))
            lit[lane / 16] = static_cast<std::uint16_t>(lit[lane / 16] & ~bit);
    }
}

}  // namespace nuvo
#endif
