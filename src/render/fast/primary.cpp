#include "fast/primary.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/primary.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>

#include "fast/beam.h"
#include "fast/lanes.h"
#include "fast/primary_lanes.h"

// A leaf's triangles are tested as a rasterizer's: coarse, against 16 blocks of pixels at once,
// then fine, 16 pixels at once (Abrash 2009, "Rasterization on Larrabee"), but in the order of the
// walk. Whatever a float within its bound leaves open, the referee decides at once.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Floats4 = Lanes<float, 4>;

class PrimaryTracer {
  public:
    PrimaryTracer(PrimaryJob& job, Tile& tile) : job_(job), tile_(tile), lanes_(job.camera, tile) {
        clear();
        if (!job.tables.spheres.empty()) directions_.fill(lanes_);
    }

    void run() {
        job_.mailbox.start();
        walk_beam(
            job_.scene.octree(), lanes_.beam,
            [&](float entry) HWY_ATTR { return entry * tile_near_ > 1 + kEntryRounding; },
            [&](const std::uint32_t* items, std::uint32_t count, float) HWY_ATTR {
                for (std::uint32_t i = 0; i < count; ++i)
                    if (!job_.mailbox.seen(items[i])) enqueue(items[i]);
                return false;
            });
        while (tested_ != queued_) test(queue_[tested_++ % kQueue]);
        finish();
    }

  private:
    static constexpr float kRoundoff = 0x1p-24F;
    static constexpr float kEntryRounding = 4 * kRoundoff;
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
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

    // An item waits until its record has come from memory.
    HWY_INLINE void enqueue(Slot slot) {
        const Slot triangle_end = job_.scene.triangle_end();
        if (slot < triangle_end)
            hwy::Prefetch(job_.tables.triangles.data() + slot);
        else
            hwy::Prefetch(job_.tables.spheres.data() + (slot - triangle_end));
        queue_[queued_++ % kQueue] = slot;
        if (queued_ - tested_ == kQueue) test(queue_[tested_++ % kQueue]);
    }

    HWY_INLINE void test(Slot slot) {
        if (slot < job_.scene.triangle_end())
            test_triangle(slot);
        else
            test_sphere(slot);
    }

    HWY_INLINE void test_triangle(Slot slot) {
        const CameraTriangle& t = job_.tables.triangles[slot];
        const Floats4 center =
            mul_add(Floats4::load(t.b), Floats4(lanes_.center_y),
                    mul_add(Floats4::load(t.a), Floats4(lanes_.center_x), Floats4::load(t.c)));
        // Nothing to do where a function is surely below its least value all over the tile.
        const Floats4 half_tile =
            (abs(Floats4::load(t.a)) + abs(Floats4::load(t.b))) * Floats4(TileRays::kHalfTile);
        const Floats4 most_of_tile = center + half_tile + Floats4::load(t.e);
        if ((most_of_tile < Floats4::load(least_)).any()) return;
        float at[4];
        center.store(at);
        const float edge_error = std::max(t.e[0], std::max(t.e[1], t.e[2]));
        // The blocks where no edge function is surely negative, and q not surely too small.
        Floats value[4];
        RayMask possible = Floats::load(block_near_) <= Floats(std::numeric_limits<float>::max());
        for (int i = 0; i < 4; ++i) {
            value[i] = mul_add(lanes_.block_x(), Floats(t.a[i]),
                               mul_add(lanes_.block_y(), Floats(t.b[i]), Floats(at[i])));
            const float half = lanes_.kHalfBlock * (std::fabs(t.a[i]) + std::fabs(t.b[i]));
            const Floats most = value[i] + Floats(half + (i < 3 ? edge_error : t.e[3]));
            possible = possible & (most >= (i < 3 ? Floats(0.0F) : Floats::load(block_near_)));
        }
        std::uint32_t blocks = possible.bits();
        if (blocks == 0) return;
        Floats offset[4];
        alignas(64) float block_value[4][kTileBlocks];
        for (int i = 0; i < 4; ++i) {
            offset[i] = mul_add(lanes_.lane_x(), Floats(t.a[i]), lanes_.lane_y() * Floats(t.b[i]));
            value[i].store(block_value[i]);
        }
        for (; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            const Floats u = Floats(block_value[0][b]) + offset[0];
            const Floats v = Floats(block_value[1][b]) + offset[1];
            const Floats w = Floats(block_value[2][b]) + offset[2];
            const Floats q = Floats(block_value[3][b]) + offset[3];
            take_triangle(slot, b, min(u, min(v, w)), q, edge_error, t.e[3]);
        }
    }

    HWY_INLINE void take_triangle(Slot slot, int b, const Floats& inside, const Floats& q,
                                  float edge_error, float q_error) {
        const Candidates found(tile_, b, q - Floats(q_error), q + Floats(q_error));
        const RayMask sure = (inside > Floats(edge_error)) & found.surely_nearer;
        const RayMask open = without((inside >= Floats(-edge_error)) & found.perhaps_nearer, sure);
        const std::uint32_t open_bits = open.bits() & tile_.inside[b];
        const bool any_sure = sure.any();
        if (any_sure) found.store(tile_, b, sure, slot);
        if (open_bits != 0) {
            if (job_.redo_exactly)
                decide(slot, b, open_bits);
            else
                found.store(tile_, b, open & (inside >= Floats(0.0F)) & found.perhaps_nearer, slot);
        }
        if (any_sure || open_bits != 0) update_near(b);
    }

    HWY_INLINE void test_sphere(Slot slot) {
        const CameraSphere& s = job_.tables.spheres[slot - job_.scene.triangle_end()];
        if (surely_passed(s, lanes_, tile_near_)) return;
        const SphereOverTile sphere(s, lanes_);
        std::uint32_t blocks = sphere.blocks(s, block_near_);
        if (blocks == 0) return;
        const SphereOffsets offsets(sphere);
        for (; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            const SphereDiscriminant found(s, sphere, offsets, directions_, b);
            if (found.perhaps.any()) take_sphere(slot, s, sphere, offsets, found, b);
        }
    }

    HWY_INLINE void take_sphere(Slot slot, const CameraSphere& s, const SphereOverTile& sphere,
                                const SphereOffsets& offsets, const SphereDiscriminant& line,
                                int b) {
        const SphereHits hits(s, sphere, offsets, line, b);
        const Candidates found(tile_, b, hits.low, hits.high);
        RayMask sure = line.meets & found.surely_nearer;
        RayMask open = without(line.perhaps & found.perhaps_nearer, sure);
        if (s.exactly) {
            sure = RayMask::from_bits(0);
            open = line.perhaps;
        } else if (!job_.redo_exactly) {
            sure = sure | (open & (line.value >= Floats(0.0F)));
            open = RayMask::from_bits(0);
        }
        const std::uint32_t open_bits = open.bits() & tile_.inside[b];
        const bool any_sure = sure.any();
        if (any_sure) {
            found.store(tile_, b, sure, slot);
            hits.store_normal(s, sphere, offsets, directions_, tile_, b, sure);
        }
        if (open_bits != 0) decide(slot, b, open_bits);
        if (any_sure || open_bits != 0) update_near(b);
    }

    // Lane by lane, exactly.
    HWY_NOINLINE void decide(Slot slot, int b, std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) {
            const int lane = b * kBlockLanes + std::countr_zero(bits);
            if (tile_.slot[lane] == slot) continue;
            const auto nearest = job_.referee.nearer(tile_.x + lane_x(lane), tile_.y + lane_y(lane),
                                                     slot, tile_.slot[lane]);
            if (!nearest) continue;
            tile_.slot[lane] = slot;
            tile_.near_low[lane] = nearest->low;
            tile_.near_high[lane] = nearest->high;
            for (int axis = 0; axis < 3; ++axis)
                tile_.round_normal[axis][lane] = static_cast<float>(nearest->normal[axis]);
            tile_.round_error[lane] = 2 * kRoundoff;
        }
    }

    HWY_INLINE void update_near(int b) {
        block_near_[b] = lowest(Floats::load(tile_.near_low + b * kBlockLanes));
        tile_near_ = lowest(Floats::load(block_near_));
        least_[3] = tile_near_;
    }

    PrimaryJob& job_;
    Tile& tile_;
    static constexpr std::uint32_t kQueue = 16;
    Slot queue_[kQueue];
    std::uint32_t queued_ = 0;
    std::uint32_t tested_ = 0;
    TileRays lanes_;
    TileDirections directions_;                  // of scenes with spheres
    alignas(64) float block_near_[kTileBlocks];  // the least near_low of a block
    float tile_near_ = 0;                        // the least of these
    float least_[4] = {};                        // of u, v, w and q that matter
};

void trace_primary(PrimaryJob& job, Tile& tile) { PrimaryTracer(job, tile).run(); }

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

PrimaryStage::PrimaryStage(InstructionSet isa) : trace_(NUVO_FOR_ISA(isa, trace_primary)) {}

}  // namespace nuvo
#endif
