#include "fast/primary/primary.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/primary/primary.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>

#include "fast/primary/box_culling.h"
#include "fast/primary/primary_lanes.h"
#include "fast/primary/sphere_lanes.h"
#include "fast/simd/lanes.h"
#include "fast/tile/beam.h"
#include "nuvo/math/error_bounds.h"

// The items of leaves wait until there are 16 of them, whose pixel boxes are then compared with the
// tile's blocks and what these show so far, all at once: few are left. Those are tested as a
// rasterizer tests them, in the order of the walk: coarse, against 16 blocks of pixels at once,
// unless they show in a few blocks only; then fine, 16 pixels at once (Abrash 2009, "Rasterization
// on Larrabee"). Each step asks for the memory that the next one reads. Whatever a float within its
// bound leaves open, the fallback decides at once.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Floats4 = Lanes<float, 4>;

class PrimaryTracer {
  public:
    PrimaryTracer(PrimaryJob& job, Tile& tile)
        : job_(job), tile_(tile), rays_(job.camera, tile), culling_(tile) {
        clear();
    }

    void run() {
        job_.mailbox.start();
        walk_beam(
            job_.scene.octree(), rays_.beam,
            [&](float entry) HWY_ATTR { return entry * tile_near_ > 1 + kEntryRounding; },
            [&](const std::uint32_t* items, std::uint32_t count, float) HWY_ATTR {
                const PixelBox* const boxes = boxes_ + (items - items_);
                for (std::uint32_t i = 0; i < count; ++i) enqueue(boxes[i]);
                return false;
            });
        while (waiting_ != 0 || chosen_count_ != 0) step();
        finish();
    }

  private:
    static constexpr float kEntryRounding = 4 * kFloatRoundoff;
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // Up to so many blocks are tested one by one: from 2 to 7 the time was the same.
    static constexpr int kFewBlocks = 4;
    const Ints none_{static_cast<std::int32_t>(kNoSlot)};

    // Lanes outside of the picture get a hit nearer than any.
    void clear() {
        const int width = job_.camera.resolution.width - tile_.x;
        const int height = job_.camera.resolution.height - tile_.y;
        const bool whole = width >= kTileSide && height >= kTileSide;
        for (int b = 0; b < kTileBlocks; ++b) {
            const std::uint32_t inside = whole ? 0xffff : lanes_inside(b, width, height);
            tile_.inside[b] = static_cast<std::uint16_t>(inside);
            const Floats near = select(RayMask::from_bits(inside), Floats(0.0F), Floats(kInfinity));
            near.store(tile_.near_low + b * kBlockLanes);
            near.store(tile_.near_high + b * kBlockLanes);
            block_near_[b] = inside != 0 ? 0 : kInfinity;
            none_.store(slots(b));
        }
    }
    static std::uint32_t lanes_inside(int b, int width, int height) {
        std::uint32_t inside = 0;
        for (int lane = 0; lane < kBlockLanes; ++lane) {
            const int at = b * kBlockLanes + lane;
            if (lane_x(at) < width && lane_y(at) < height) inside |= 1U << lane;
        }
        return inside;
    }

    std::int32_t* slots(int b) {
        return reinterpret_cast<std::int32_t*>(tile_.slot) + b * kBlockLanes;
    }

    void finish() {
        for (int b = 0; b < kTileBlocks; ++b)
            tile_.hit[b] = static_cast<std::uint16_t>((Ints::load(slots(b)) != none_).bits());
    }

    HWY_INLINE void enqueue(const PixelBox& box) {
        queue_[BoxCulling::place(waiting_)] = box;
        waiting_ += job_.mailbox.seen(box.slot) ? 0 : 1;
        if (waiting_ == kBatch) step();
    }

    // Chooses from the items that wait; then tests those chosen before, or if there are none these.
    HWY_NOINLINE void step() {
        std::size_t first = chosen_count_;
        if (waiting_ != 0) {
            chosen_count_ += culling_.choose(queue_, waiting_, block_near_, tile_near_,
                                             chosen_ + first, blocks_ + first);
            waiting_ = 0;
            for (std::size_t i = first; i < chosen_count_; ++i) prefetch(chosen_[i]);
            if (first == 0) return;
        } else {
            first = chosen_count_;
        }
        test(first);
        update_near();
        chosen_count_ -= first;
        Ints::load(chosen_ + first).store(chosen_);
        Ints::load(blocks_ + first).store(blocks_);
    }

    HWY_INLINE void prefetch(std::int32_t chosen) const {
        const auto slot = static_cast<Slot>(chosen);
        const Slot triangle_end = job_.scene.triangle_end();
        if (slot < triangle_end)
            hwy::Prefetch(job_.tables.triangles.data() + slot);
        else
            hwy::Prefetch(job_.tables.spheres.data() + (slot - triangle_end));
    }

    // The first `count` of those chosen.
    HWY_INLINE void test(std::size_t count) {
        const CameraSphere* spheres[kBatch];
        std::size_t place[kBatch];
        std::size_t sphere_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto slot = static_cast<Slot>(chosen_[i]);
            if (slot < job_.scene.triangle_end()) {
                test_triangle(slot, static_cast<std::uint32_t>(blocks_[i]));
            } else {
                spheres[sphere_count] = &job_.tables.spheres[slot - job_.scene.triangle_end()];
                place[sphere_count++] = i;
            }
        }
        if (sphere_count != 0) test_spheres(spheres, place, sphere_count);
    }

    HWY_INLINE void test_triangle(Slot slot, std::uint32_t blocks) {
        const CameraTriangle& t = job_.tables.triangles[slot];
        const Floats4 center =
            mul_add(Floats4::load(t.b), Floats4(rays_.center_y),
                    mul_add(Floats4::load(t.a), Floats4(rays_.center_x), Floats4::load(t.c)));
        float at[4];
        center.store(at);
        const float edge_error = std::max(t.e[0], std::max(t.e[1], t.e[2]));
        if (std::popcount(blocks) > kFewBlocks) blocks = met(t, at, edge_error, blocks);
        for (; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            const Floats x = Floats::load(kOffsets.x[b]);
            const Floats y = Floats::load(kOffsets.y[b]);
            Floats value[4];
            for (int i = 0; i < 4; ++i)
                value[i] = mul_add(x, Floats(t.a[i]), mul_add(y, Floats(t.b[i]), Floats(at[i])));
            take_triangle(slot, b, min(value[0], min(value[1], value[2])), value[3], edge_error,
                          t.e[3]);
        }
    }

    // The blocks where no edge function is surely negative, and q not surely too small.
    HWY_INLINE std::uint32_t met(const CameraTriangle& t, const float (&at)[4], float edge_error,
                                 std::uint32_t blocks) const {
        const Floats x = Floats::load(kOffsets.block_x);
        const Floats y = Floats::load(kOffsets.block_y);
        RayMask possible = RayMask::from_bits(blocks);
        for (int i = 0; i < 4; ++i) {
            const float half = kHalfBlock * (std::fabs(t.a[i]) + std::fabs(t.b[i]));
            const Floats value =
                mul_add(x, Floats(t.a[i]), mul_add(y, Floats(t.b[i]), Floats(at[i])));
            const Floats most = value + Floats(half + (i < 3 ? edge_error : t.e[3]));
            possible = possible & (most >= (i < 3 ? Floats(0.0F) : Floats::load(block_near_)));
        }
        return possible.bits();
    }

    HWY_INLINE void take_triangle(Slot slot, int b, const Floats& inside, const Floats& q,
                                  float edge_error, float q_error) {
        const Candidates found(tile_, b, q - Floats(q_error), q + Floats(q_error));
        const RayMask perhaps = (inside >= Floats(-edge_error)) & found.perhaps_nearer;
        if (!perhaps.any()) return;
        const RayMask sure = (inside > Floats(edge_error)) & found.surely_nearer;
        const RayMask open = without(perhaps, sure);
        const std::uint32_t open_bits = open.bits() & tile_.inside[b];
        found.store(tile_, b, sure, slot);
        if (open_bits != 0) {
            if (job_.redo_exactly)
                decide_triangle(slot, b, open_bits, (inside > Floats(edge_error)).bits(), found);
            else
                found.store(tile_, b, open & (inside >= Floats(0.0F)), slot);
        }
        changed_ |= 1U << b;
    }

    // By the order of two planes where the triangle is surely met (`inside`) and many lanes show
    // the same other one; else lane by lane.
    HWY_NOINLINE void decide_triangle(Slot slot, int b, std::uint32_t open, std::uint32_t inside,
                                      const Candidates& found) {
        constexpr int kMany = 3;
        const Ints shown = Ints::load(slots(b));
        for (std::uint32_t rest = open & inside; rest != 0;) {
            const Slot other = tile_.slot[b * kBlockLanes + std::countr_zero(rest)];
            const std::uint32_t same =
                (shown == Ints(static_cast<std::int32_t>(other))).bits() & rest;
            rest &= ~same;
            if (std::popcount(same) < kMany || other >= job_.scene.triangle_end()) continue;
            const PlaneOrder order = job_.orders.between(slot, other);
            const float at = order.c + order.a * rays_.center_x + order.b * rays_.center_y;
            const Floats value =
                mul_add(Floats::load(kOffsets.x[b]), Floats(order.a),
                        mul_add(Floats::load(kOffsets.y[b]), Floats(order.b), Floats(at)));
            const std::uint32_t nearer = (value > Floats(order.e)).bits() & same;
            found.store(tile_, b, RayMask::from_bits(nearer), slot);
            open &= ~(nearer | ((value < Floats(-order.e)).bits() & same));
        }
        if (open != 0) decide(slot, b, open);
    }

    HWY_NOINLINE void test_spheres(const CameraSphere* const* spheres, const std::size_t* place,
                                   std::size_t count) {
        conics_.fill(spheres, count, rays_);
        for (std::size_t i = 0; i < count; ++i) {
            const auto slot = static_cast<Slot>(chosen_[place[i]]);
            auto blocks = static_cast<std::uint32_t>(blocks_[place[i]]);
            if (std::popcount(blocks) > kFewBlocks) blocks = conics_.met(i, blocks);
            for (; blocks != 0; blocks &= blocks - 1)
                take_sphere(slot, *spheres[i], i, std::countr_zero(blocks));
        }
    }

    HWY_INLINE void take_sphere(Slot slot, const CameraSphere& s, std::size_t i, int b) {
        const Floats x = Floats::load(kOffsets.x[b]);
        const Floats y = Floats::load(kOffsets.y[b]);
        const Floats discriminant = conics_.discriminant(i, x, y);
        const RayMask perhaps = discriminant >= Floats(-conics_.error(i));
        if (!perhaps.any()) return;
        const SphereHits hits(s, conics_, i, discriminant, x, y);
        const Candidates found(tile_, b, hits.low, hits.high);
        RayMask sure = (discriminant > Floats(conics_.error(i))) & found.surely_nearer;
        RayMask open = without(perhaps & found.perhaps_nearer, sure);
        if (s.exactly) {
            sure = RayMask::from_bits(0);
            open = perhaps;
        } else if (!job_.redo_exactly) {
            sure = sure | (open & (discriminant >= Floats(0.0F)));
            open = RayMask::from_bits(0);
        }
        const std::uint32_t open_bits = open.bits() & tile_.inside[b];
        if (!sure.any() && open_bits == 0) return;
        found.store(tile_, b, sure, slot);
        if (open_bits != 0) decide(slot, b, open_bits);
        changed_ |= 1U << b;
    }

    // Lane by lane, exactly.
    HWY_NOINLINE void decide(Slot slot, int b, std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) {
            const int lane = b * kBlockLanes + std::countr_zero(bits);
            if (tile_.slot[lane] == slot) continue;
            const auto nearest = job_.fallback.nearer(
                tile_.x + lane_x(lane), tile_.y + lane_y(lane), slot, tile_.slot[lane]);
            if (!nearest) continue;
            tile_.slot[lane] = slot;
            tile_.near_low[lane] = nearest->low;
            tile_.near_high[lane] = nearest->high;
            for (int axis = 0; axis < 3; ++axis)
                tile_.quadric_normal[axis][lane] = static_cast<float>(nearest->normal[axis]);
            tile_.quadric_error[lane] = 2 * kFloatRoundoff;
        }
    }

    HWY_INLINE void update_near() {
        if (changed_ == 0) return;
        for (std::uint32_t blocks = changed_; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            block_near_[b] = lowest(Floats::load(tile_.near_low + b * kBlockLanes));
        }
        changed_ = 0;
        tile_near_ = lowest(Floats::load(block_near_));
    }

    static constexpr std::size_t kBatch = BoxCulling::kBatch;

    PrimaryJob& job_;
    Tile& tile_;
    TileRays rays_;
    BoxCulling culling_;
    alignas(64) float block_near_[kTileBlocks];  // the least near_low of a block
    float tile_near_ = 0;                        // the least of these
    std::uint32_t changed_ = 0;                  // blocks where they are out of date, too small
    // Items that wait, and those chosen with the blocks where they may show.
    const std::uint32_t* const items_ = job_.scene.octree().items.data();
    const PixelBox* const boxes_ = job_.tables.boxes.data();
    alignas(64) PixelBox queue_[kBatch] = {};
    std::size_t waiting_ = 0;
    std::int32_t chosen_[3 * kBatch];
    std::int32_t blocks_[3 * kBatch];
    std::size_t chosen_count_ = 0;
    SphereConics conics_;
};

void trace_primary(PrimaryJob& job, Tile& tile) { PrimaryTracer(job, tile).run(); }

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

PrimaryStage::PrimaryStage(InstructionSet isa) : trace_(NUVO_FOR_ISA(isa, trace_primary)) {}

}  // namespace nuvo
#endif
