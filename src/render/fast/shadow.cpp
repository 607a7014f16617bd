#include "fast/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shadow.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>

#include "fast/beam.h"
#include "fast/shadow_beam.h"
#include "fast/shadow_boxes.h"
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
          light_(light),
          table_(job.tables.table(light)),
          planes_(job.tables.planes(light)),
          clusters_(tile, wanted, table_.light, job.tables.leaf_width()),
          lit_(lit),
          has_rounds_(job.tables.has_rounds()) {
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
    // Batches grow along the way: what blocks is often close.
    static constexpr std::uint32_t kFirstBatch = 4;

    struct Batch {
        static constexpr std::uint32_t kSize = 32;
        std::uint32_t count = 0;
        Slot slot[kSize];

        HWY_INLINE void add(Slot item, std::uint32_t fresh) {
            slot[count] = item;
            count += fresh;
        }
        bool full() const { return count == kSize; }
    };

    // Copies a cluster's lanes into packets, the last filled up with its own last lane.
    HWY_INLINE void load(int first, int count) {
        first_ = first;
        packets_ = (count + 15) / 16;
        alive_ = (1U << packets_) - 1;
        by_fours_ = packets_ <= 4;
        group_shift_ = by_fours_ ? 2 : 0;
        group_mask_ = by_fours_ ? 0xf : 1;
        groups_ = by_fours_ ? 0xffff >> (16 - 4 * packets_) : alive_;
        for (int p = 0; p < packets_; ++p) {
            const int here = std::min(16, count - 16 * p);
            waiting_[p] = (1U << here) - 1;
            points_[p] = clusters_.points(first + 16 * p, here);
        }
        if (packets_ > 1) load_boxes();
        if (has_rounds_)
            for (int p = 0; p < packets_; ++p) ways_[p] = Ways(table_.light, points_[p]);
    }

    // A small cluster is tested by fours of points first, a larger one by packets.
    HWY_INLINE void load_boxes() {
        const GroupBoxes boxes(points_, packets_, by_fours_);
        centers_ = boxes.center;
        box_error_ = boxes.half + Floats(plane_error_);
        if (!has_rounds_) return;
        center_ways_ = Ways(table_.light, centers_);
        round_box_error_ = boxes.radius + Floats(round_error_);
    }

    void trace_beam(const PointBox& box) {
        job_.mailbox.start();
        triangles_.count = 0;
        rounds_.count = 0;
        enough_ = kFirstBatch;
        blocker_ = kNoSlot;
        OccluderCache& cache = job_.caches[light_];
        if (cache.worth_a_try()) {
            try_occluders(cache);
            if (alive_ == 0) return;
        }
        const BeamBox beam =
            beam_to_light(table_.light, box.low, box.high, plane_error_ + 8 * kRoundoff);
        const bool done = walk_beam(
            scene_.octree(), beam, [](float) { return false; },
            [&](const std::uint32_t* items, std::uint32_t count, float)
                HWY_ATTR { return take(items, count); });
        if (!done) test_taken();
        if (blocker_ != kNoSlot) cache.put(blocker_);
    }

    HWY_NOINLINE void try_occluders(OccluderCache& cache) {
        for (const Slot slot : cache.slots()) {
            if (slot == kNoSlot || job_.mailbox.seen(slot)) continue;
            (slot < scene_.triangle_end() ? triangles_ : rounds_).add(slot, 1);
        }
        test_taken();
        cache.tried(alive_ == 0);
    }

    // Tests are put off until there are some: what comes out of one cannot be foreseen, but they
    // can run at the same time. Returns whether nothing waits any more.
    HWY_INLINE bool take(const std::uint32_t* items, std::uint32_t count) {
        const Slot triangle_end = scene_.triangle_end();
        for (std::uint32_t i = 0; i < count; ++i) {
            const Slot slot = items[i];
            const std::uint32_t fresh = job_.mailbox.seen(slot) ? 0 : 1;
            if (slot < triangle_end) hwy::Prefetch(planes_ + slot);
            if (slot < triangle_end)
                triangles_.add(slot, fresh);
            else
                rounds_.add(slot, fresh);
            if (triangles_.full() || rounds_.full()) {
                test_taken();
                if (alive_ == 0) return true;
            }
        }
        if (triangles_.count + rounds_.count < enough_) return false;
        enough_ = std::min(2 * enough_, Batch::kSize);
        test_taken();
        return alive_ == 0;
    }
    HWY_INLINE void test_taken() {
        if (triangles_.count > 0) test_triangles();
        if (rounds_.count > 0) test_rounds();
        update();
    }

    // The items that may hide a point of some group, with these groups.
    struct Near {
        std::uint32_t count = 0;
        Slot slot[Batch::kSize + 1];
        std::uint32_t groups[Batch::kSize + 1];

        HWY_INLINE void add(Slot item, std::uint32_t of) {
            slot[count] = item;
            groups[count] = of;
            count += of != 0 ? 1 : 0;
        }
    };

    HWY_NOINLINE void test_triangles() {
        Near near;
        Slot blocker = blocker_;
        if (packets_ > 1) {
            std::uint32_t whole = 0;
            for (std::uint32_t i = 0; i < triangles_.count; ++i) {
                const Floats depth = hidden(planes_[triangles_.slot[i]], centers_);
                near.add(triangles_.slot[i], groups_ & ~(depth < -box_error_).bits());
                const std::uint32_t sure = (depth > box_error_).bits();
                blocker = (sure & groups_) != 0 ? triangles_.slot[i] : blocker;
                whole |= sure;
            }
            block_groups(whole & groups_);
        } else {
            for (std::uint32_t i = 0; i < triangles_.count; ++i) near.add(triangles_.slot[i], 1);
        }
        for (std::uint32_t i = 0; i < near.count; ++i) {
            const ShadowPlanes& planes = planes_[near.slot[i]];
            for (std::uint32_t at = near.groups[i]; at != 0;) {
                const int p = next_packet(at);
                const Floats depth = hidden(planes, points_[p]);
                const std::uint32_t perhaps = waiting_[p] & ~(depth < Floats(-plane_error_)).bits();
                const std::uint32_t sure = perhaps & (depth > Floats(plane_error_)).bits();
                waiting_[p] &= ~sure;
                blocker = sure != 0 ? near.slot[i] : blocker;
                if (perhaps != sure)
                    leave_triangle(near.slot[i], p, perhaps ^ sure, depth > Floats(0.0F));
            }
        }
        triangles_.count = 0;
        blocker_ = blocker;
    }
    // The packet of the first group in `groups`, all of whose groups are taken out.
    HWY_INLINE int next_packet(std::uint32_t& groups) const {
        const int p = std::countr_zero(groups) >> group_shift_;
        groups &= ~(group_mask_ << (p << group_shift_));
        return p;
    }

    HWY_NOINLINE void test_rounds() {
        Near near;
        Slot blocker = blocker_;
        if (packets_ > 1) {
            std::uint32_t whole = 0;
            for (std::uint32_t i = 0; i < rounds_.count; ++i) {
                const RoundItem item(job_.tables, table_, rounds_.slot[i]);
                const RoundTest test(item, centers_, center_ways_, round_box_error_);
                near.add(rounds_.slot[i], groups_ & ~test.free());
                whole |= test.blocked();
            }
            block_groups(whole & groups_);
        } else {
            for (std::uint32_t i = 0; i < rounds_.count; ++i) near.add(rounds_.slot[i], 1);
        }
        for (std::uint32_t i = 0; i < near.count; ++i) {
            const RoundItem item(job_.tables, table_, near.slot[i]);
            for (std::uint32_t at = near.groups[i]; at != 0;) {
                const int p = next_packet(at);
                const RoundTest test(item, points_[p], ways_[p], Floats(round_error_));
                const std::uint32_t perhaps = waiting_[p] & ~test.free();
                const std::uint32_t sure = perhaps & test.blocked();
                waiting_[p] &= ~sure;
                blocker = sure != 0 ? near.slot[i] : blocker;
                if (perhaps != sure) leave_round(near.slot[i], p, perhaps ^ sure, item, test);
            }
        }
        rounds_.count = 0;
        blocker_ = blocker;
    }

    void block_groups(std::uint32_t groups) {
        groups_ &= ~groups;
        for (; groups != 0; groups &= groups - 1) {
            const int group = std::countr_zero(groups);
            if (by_fours_)
                waiting_[group / 4] &= ~(0xfU << (group % 4 * 4));
            else
                waiting_[group] = 0;
        }
    }
    // Finds out what still waits.
    HWY_INLINE void update() {
        alive_ = 0;
        for (int p = 0; p < packets_; ++p) alive_ |= waiting_[p] != 0 ? 1U << p : 0;
        if (!by_fours_) groups_ &= alive_;
    }
    // A triangle does not hide its own points.
    HWY_NOINLINE void leave_triangle(Slot slot, int p, std::uint32_t lanes,
                                     const RayMask& rounded) {
        lanes &= ~clusters_.of_slot(first_ + 16 * p, slot);
        put_aside(slot, p, lanes, rounded.bits());
    }
    // Nor does a sphere where the way to the light leads outwards. Its own points touch it, so they
    // come here unless their ways lead deep into it.
    HWY_NOINLINE void leave_round(Slot slot, int p, std::uint32_t lanes, const RoundItem& item,
                                  const RoundTest& test) {
        const std::uint32_t own = lanes & clusters_.of_slot(first_ + 16 * p, slot);
        std::uint32_t rounded =
            (test.square < Floats(item.shape.radius * item.shape.radius)).bits() & ~own;
        if (item.sphere) {
            const Points& at = points_[p];
            const Ways& way = ways_[p];
            const Floats fx = Floats(item.shape.center[0]) - at.x;
            const Floats fy = Floats(item.shape.center[1]) - at.y;
            const Floats fz = Floats(item.shape.center[2]) - at.z;
            const Floats along = mul_add(fx, way.x, mul_add(fy, way.y, fz * way.z));
            // Off by the way's own error at one end, at most 1 away, and by the point's.
            const Floats margin = mul_add(way.inverse, Floats(round_error_), Floats(round_error_));
            const std::uint32_t outwards = (along < -margin).bits();
            const std::uint32_t inwards = (along > margin).bits();
            if (item.side == LightSide::kOutside) waiting_[p] &= ~(own & inwards);
            lanes &= ~(own & outwards);
            if (item.side == LightSide::kInside) {
                // The way ends inside: blocked iff it starts outside.
                const Floats square = mul_add(fx, fx, mul_add(fy, fy, fz * fz));
                const float less = std::max(item.shape.radius - round_error_, 0.0F);
                waiting_[p] &= ~(lanes & ~own & (square > test.outside).bits());
                lanes &= ~(own | (square < Floats(less * less)).bits());
            }
            rounded |= own & (along > Floats(0.0F)).bits();
        }
        put_aside(slot, p, lanes & waiting_[p], rounded);
    }
    HWY_INLINE void put_aside(Slot slot, int p, std::uint32_t lanes, std::uint32_t rounded) {
        if (!job_.redo_exactly) {
            waiting_[p] &= ~(lanes & rounded);
            return;
        }
        for (; lanes != 0; lanes &= lanes - 1)
            job_.open.push_back({clusters_.lane(first_ + 16 * p + std::countr_zero(lanes)), slot});
    }

    // The lanes that are still waiting are lit.
    HWY_INLINE void finish(int p) {
        const int first = first_ + 16 * p;
        const std::uint32_t block = clusters_.lane(first) / 16;
        if (clusters_.is_block(first)) {
            lit_[block] = static_cast<std::uint16_t>(lit_[block] | waiting_[p]);
            return;
        }
        for (std::uint32_t lanes = waiting_[p]; lanes != 0; lanes &= lanes - 1) {
            const std::uint32_t lane = clusters_.lane(first + std::countr_zero(lanes));
            lit_[lane / 16] = static_cast<std::uint16_t>(lit_[lane / 16] | 1U << lane % 16);
        }
    }

    ShadowJob& job_;
    const FastScene& scene_;
    std::size_t light_;
    const ShadowTable& table_;
    const ShadowPlanes* planes_;
    PointClusters clusters_;
    TileMask& lit_;
    bool has_rounds_;
    float plane_error_;
    float round_error_;

    // The cluster that is being traced.
    int first_ = 0;
    int packets_ = 0;
    bool by_fours_ = false;
    int group_shift_ = 0;
    std::uint32_t group_mask_ = 1;
    std::uint32_t alive_ = 0;    // packets with lanes that wait
    std::uint32_t groups_ = 0;   // groups of these
    std::uint32_t waiting_[16];  // lanes that nothing has blocked yet
    Points points_[16];
    Ways ways_[16];
    Points centers_;
    Ways center_ways_;
    Floats box_error_;
    Floats round_box_error_;
    Batch triangles_;  // waiting for their tests
    Batch rounds_;
    std::uint32_t enough_ = kFirstBatch;
    Slot blocker_ = kNoSlot;  // the last item that surely blocked something
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
    : job_{tables, redo_exactly, {}, {}, std::vector<OccluderCache>(tables.light_count())},
      trace_(NUVO_FOR_ISA(isa, trace_shadows)) {}

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
