#include "fast/primary.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/primary.cpp"
#include <hwy/foreach_target.h>

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
    }

    void run() {
        job_.mailbox.start();
        const Slot triangle_end = job_.scene.triangle_end();
        walk_beam(
            job_.scene.octree(), lanes_.beam,
            [&](float entry) HWY_ATTR { return entry * tile_near_ > 1 + kEntryRounding; },
            [&](const std::uint32_t* items, std::uint32_t count, float) HWY_ATTR {
                for (std::uint32_t i = 0; i < count; ++i) {
                    const Slot slot = items[i];
                    if (job_.mailbox.seen(slot)) continue;
                    if (slot < triangle_end)
                        test_triangle(slot);
                    else
                        test_sphere(slot);
                }
                return false;
            });
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

    HWY_INLINE void test_triangle(Slot slot) {
        const CameraTriangle& t = job_.tables.triangles[slot];
        const Floats4 center =
            mul_add(Floats4::load(t.b), Floats4(lanes_.center_y),
                    mul_add(Floats4::load(t.a), Floats4(lanes_.center_x), Floats4::load(t.c)));
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
        const SphereOverTile sphere(s, lanes_);
        std::uint32_t blocks = sphere.blocks(s, block_near_);
        for (; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            const SphereHits hits(s, sphere, lanes_, b);
            const Candidates found(tile_, b, hits.low, hits.high);
            RayMask sure = hits.meets & found.surely_nearer;
            if (s.exactly) sure = RayMask::from_bits(0);
            const RayMask open =
                s.exactly ? hits.perhaps : without(hits.perhaps & found.perhaps_nearer, sure);
            const std::uint32_t open_bits = open.bits() & tile_.inside[b];
            const bool any_sure = sure.any();
            if (any_sure) {
                found.store(tile_, b, sure, slot);
                hits.store_normal(s, sphere, tile_, b, sure);
            }
            if (open_bits != 0) decide_sphere(slot, s, sphere, hits, b, open, open_bits);
            if (any_sure || open_bits != 0) update_near(b);
        }
    }

    void decide_sphere(Slot slot, const CameraSphere& s, const SphereOverTile& sphere,
                       const SphereHits& hits, int b, const RayMask& open,
                       std::uint32_t open_bits) {
        if (job_.redo_exactly || s.exactly) {
            decide(slot, b, open_bits);
            return;
        }
        const Candidates found(tile_, b, hits.low, hits.high);
        const RayMask taken = open & (hits.discriminant >= Floats(0.0F)) & found.perhaps_nearer;
        found.store(tile_, b, taken, slot);
        hits.store_normal(s, sphere, tile_, b, taken);
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
    }

    PrimaryJob& job_;
    Tile& tile_;
    TileRays lanes_;
    alignas(64) float block_near_[kTileBlocks];  // the least near_low of a block
    float tile_near_ = 0;                        // the least of these
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
