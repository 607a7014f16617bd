#include "fast/primary/primary.h"

#include <bit>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/primary/primary.cpp"
#include <hwy/foreach_target.h>

#include "fast/camera/camera_triangle_lanes.h"
#include "fast/camera/corner_fetch.h"
#include "fast/camera/pixel_box_lanes.h"
#include "fast/primary/box_culling.h"
#include "fast/primary/depth_pyramid.h"
#include "fast/primary/frustum.h"
#include "fast/primary/primary_lanes.h"
#include "fast/primary/sphere_lanes.h"
#include "fast/primary/triangle_culling.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Voxels, items and blocks that cannot be nearer than what a macro tile shows are left out by a
// pyramid of its depths. Triangles are made ready 16 at a time when their leaves are met: floats
// tell most of those that cannot show; of the others come first pixel boxes, then, of batches that
// still matter, edge functions. They are tested as a rasterizer tests them: coarse, against 16
// blocks of pixels at once, unless they show in a few blocks only; then fine, 16 pixels at once
// (Abrash 2009, "Rasterization on Larrabee"). Spheres wait by tile, for their functions are those
// of a tile. Whatever a float within its bound leaves open, the exact fallback decides at once.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Floats4 = Lanes<float, 4>;

// The lanes of a tile's block that lie in a picture of that size from the tile on.
std::uint32_t lanes_inside(int b, int width, int height) {
    if (width >= kTileSide && height >= kTileSide) return 0xffff;
    std::uint32_t inside = 0;
    for (int lane = 0; lane < kBlockLanes; ++lane) {
        const int at = b * kBlockLanes + lane;
        if (lane_x(at) < width && lane_y(at) < height) inside |= 1U << lane;
    }
    return inside;
}

// Shows nothing; lanes outside of the picture get a hit nearer than any.
void clear(MacroTile& tile, const CameraRays& camera) {
    const Resolution picture = camera.resolution;
    const Floats outside(kFloatInfinity);
    const Ints none(kNoSlot);
    for (int b = 0; b < MacroTile::kBlocks; ++b) {
        const int t = b / kTileBlocks;
        const std::uint32_t inside = lanes_inside(b % kTileBlocks, picture.width - tile.tile_x(t),
                                                  picture.height - tile.tile_y(t));
        tile.inside[b] = static_cast<std::uint16_t>(inside);
        const Floats near =
            select(RayMask::from_bits(inside), Floats(camera.background()), outside);
        near.store(tile.near_low + b * kBlockLanes);
        near.store(tile.near_high + b * kBlockLanes);
        none.store(tile.slot + b * kBlockLanes);
    }
}

class PrimaryTracer {
  public:
    /// Of a tile that was cleared.
    PrimaryTracer(PrimaryJob& job, MacroTile& tile, EllipsoidNormals* normals)
        : job_(job),
          tile_(tile),
          normals_(normals),
          culling_(tile),
          box_maker_(job.camera),
          triangle_maker_(job.camera),
          corners_(job.scene),
          pyramid_(tile, job.camera.background()),
          starts_(start_range(job.camera)) {}

    void run() {
        const CompactOctree& octree = job_.scene.octree();
        const Slot triangle_end = job_.scene.triangle_end();
        const Frustum frustum(job_.camera, tile_, job_.scene.reach());
        TriangleQueue triangles(job_.scene, job_.camera, frustum);
        const auto fetch = [&](const Slot* slots, std::size_t count)
                               HWY_ATTR { advance_triangles(slots, count); };
        job_.mailbox.start();
        walk_frustum(
            octree, frustum,
            [&](BlockRange range, float nearest)
                HWY_ATTR { return pyramid_.is_open(range, nearest); },
            [&](const std::uint32_t* items, std::uint32_t count) HWY_ATTR {
                for (std::uint32_t i = 0; i < count; ++i) {
                    if (job_.mailbox.seen(items[i])) continue;
                    if (items[i] < triangle_end) {
                        triangles.add(items[i], fetch);
                    } else {
                        add_quadric(items[i] - triangle_end);
                    }
                }
            });
        triangles.finish(fetch);
        while (!corners_.empty()) advance_triangles(nullptr, 0);
        choose_quadrics();
        for (int t = 0; t < MacroTile::kTiles; ++t) test_spheres(t);
        finish();
    }

  private:
    static constexpr std::size_t kBatch = BoxCulling::kBatch;
    static_assert(kBatch == TriangleQueue::kBatch && kBatch == CornerFetch::kBatch &&
                  kBatch == SphereConics::kMost);
    // Up to so many blocks are tested one by one: from 2 to 7 the time was the same.
    static constexpr int kFewBlocks = 4;

    Slot* slots(int b) { return tile_.slot + b * kBlockLanes; }

    void finish() {
        for (int b = 0; b < MacroTile::kBlocks; ++b)
            tile_.hit[b] =
                static_cast<std::uint16_t>((Ints::load(slots(b)) != Ints(kNoSlot)).bits());
    }

    HWY_NOINLINE void advance_triangles(const Slot* slots, std::size_t added) {
        corners_.advance(slots, added);
        const std::size_t count = corners_.count();
        if (count == 0) return;
        constexpr std::size_t kHalf = TriangleBatch::kSize;
        PixelBox boxes[kBatch];
        for (std::size_t half = 0; half * kHalf < count; ++half)
            box_maker_.triangles(corners_.corners(half).corner, job_.camera.anchor,
                                 job_.camera.scale, boxes + half * kHalf,
                                 std::min(kHalf, count - half * kHalf));
        for (std::size_t i = 0; i < count; ++i) queue_[BoxCulling::place(i)] = boxes[i];
        const std::size_t chosen = choose(count);
        CameraTriangle triangles[kBatch];
        bool made[kBatch / kHalf] = {};
        std::uint32_t unseen = 0;
        for (std::size_t c = 0; c < chosen; ++c) {
            const auto i = static_cast<std::size_t>(chosen_[c]);
            const std::size_t half = i / kHalf;
            if (!made[half]) unseen |= make(half, triangles + half * kHalf) << half * kHalf;
            made[half] = true;
            if ((unseen >> i & 1) != 0) continue;
            for_each_tile(boxes[i], c, [&](int t, std::uint32_t blocks) HWY_ATTR {
                test_triangle(triangles[i], corners_.slot(i), t, blocks);
            });
        }
        pyramid_.update();
    }

    // Returns which of them are not seen from the eye, wherever they lie.
    HWY_INLINE std::uint32_t make(std::size_t half, CameraTriangle* triangles) {
        const TriangleBatch& batch = corners_.corners(half);
        auto [unknown, unseen] = triangle_maker_.make(batch, triangles, TriangleBatch::kSize);
        for (; HWY_UNLIKELY(unknown != 0); unknown &= unknown - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(unknown));
            if (!make_exact_camera_triangle(job_.camera, batch.triangle(i),
                                            (batch.front_only >> i & 1) != 0, triangles[i]))
                unseen |= 1U << i;
        }
        return unseen;
    }

    HWY_INLINE std::size_t choose(std::size_t count) {
        return culling_.choose(queue_, count, pyramid_.tiles(), pyramid_.all(), chosen_, tiles_);
    }
    // Calls test(tile, blocks) where the c-th of those chosen may be seen.
    template <typename Test>
    HWY_INLINE void for_each_tile(const PixelBox& box, std::size_t c, Test&& test) const {
        for (auto tiles = static_cast<std::uint32_t>(tiles_[c]); tiles != 0; tiles &= tiles - 1) {
            const int t = std::countr_zero(tiles);
            const std::uint32_t blocks =
                culling_.blocks(box, t) & (pyramid_.blocks(t) <= Floats(box.nearest)).bits();
            if (blocks != 0) test(t, blocks);
        }
    }

    // The middle of a tile in pixel coordinates.
    HWY_INLINE float center_x(int t) const {
        return static_cast<float>(job_.camera.center_x(tile_.tile_x(t)) + kHalfTile);
    }
    HWY_INLINE float center_y(int t) const {
        return static_cast<float>(job_.camera.center_y(tile_.tile_y(t)) + kHalfTile);
    }

    HWY_INLINE void test_triangle(const CameraTriangle& triangle, Slot slot, int t,
                                  std::uint32_t blocks) {
        const Floats4 center = mul_add(
            Floats4::load(triangle.b), Floats4(center_y(t)),
            mul_add(Floats4::load(triangle.a), Floats4(center_x(t)), Floats4::load(triangle.c)));
        float at[4];
        center.store(at);
        const float edge_error = std::max(triangle.e[0], std::max(triangle.e[1], triangle.e[2]));
        if (std::popcount(blocks) > kFewBlocks) blocks = met(triangle, at, edge_error, t, blocks);
        for (; blocks != 0; blocks &= blocks - 1) {
            const int b = std::countr_zero(blocks);
            const Floats from_x = Floats::load(kOffsets.x[b]);
            const Floats from_y = Floats::load(kOffsets.y[b]);
            Floats value[4];
            for (int i = 0; i < 4; ++i)
                value[i] = mul_add(from_x, Floats(triangle.a[i]),
                                   mul_add(from_y, Floats(triangle.b[i]), Floats(at[i])));
            take_triangle(slot, kTileBlocks * t + b, min(value[0], min(value[1], value[2])),
                          value[3], edge_error, triangle.e[3]);
        }
    }

    // The blocks where no edge function is surely negative, and q not surely too small.
    HWY_INLINE std::uint32_t met(const CameraTriangle& triangle, const float (&at)[4],
                                 float edge_error, int t, std::uint32_t blocks) const {
        const Floats x = Floats::load(kOffsets.block_x);
        const Floats y = Floats::load(kOffsets.block_y);
        RayMask possible = RayMask::from_bits(blocks);
        for (int i = 0; i < 4; ++i) {
            const float half = kHalfBlock * (std::fabs(triangle.a[i]) + std::fabs(triangle.b[i]));
            const Floats value =
                mul_add(x, Floats(triangle.a[i]), mul_add(y, Floats(triangle.b[i]), Floats(at[i])));
            const Floats most = value + Floats(half + (i < 3 ? edge_error : triangle.e[3]));
            possible = possible & (most >= (i < 3 ? Floats(0.0F) : pyramid_.blocks(t)));
        }
        return possible.bits();
    }

    HWY_INLINE void take_triangle(Slot slot, int b, const Floats& inside, const Floats& q,
                                  float edge_error, float q_error) {
        const Candidates found(tile_, b, q - Floats(q_error), q + Floats(q_error));
        RayMask perhaps = (inside >= Floats(-edge_error)) & found.perhaps_nearer;
        if (!perhaps.any()) return;
        RayMask met = inside > Floats(edge_error);
        if (job_.camera.parallel) {
            perhaps = perhaps & (found.low <= Floats(starts_.high));
            met = met & (found.high < Floats(starts_.low));
        }
        const RayMask sure = met & found.surely_nearer;
        const RayMask open = without(perhaps, sure);
        const std::uint32_t open_bits = open.bits() & tile_.inside[b];
        found.store(tile_, b, sure, slot);
        if (open_bits != 0) {
            if (job_.redo_exactly)
                decide_triangle(slot, b, open_bits, met.bits(), found);
            else
                found.store(tile_, b, open & (inside >= Floats(0.0F)), slot);
        }
        pyramid_.changed(b);
    }

    // By the order of two planes where the triangle is surely met (`inside`) and many lanes show
    // the same other one; else lane by lane.
    HWY_NOINLINE void decide_triangle(Slot slot, int b, std::uint32_t open, std::uint32_t inside,
                                      const Candidates& found) {
        constexpr int kMany = 3;
        const int t = b / kTileBlocks;
        const int of_tile = b % kTileBlocks;
        const Ints shown = Ints::load(slots(b));
        for (std::uint32_t rest = open & inside; rest != 0;) {
            const Slot other = tile_.slot[b * kBlockLanes + std::countr_zero(rest)];
            const std::uint32_t same = (shown == Ints(other)).bits() & rest;
            rest &= ~same;
            if (std::popcount(same) < kMany || other >= job_.scene.triangle_end()) continue;
            const PixelFunction order = job_.orders.between(slot, other);
            const float at = order.c + order.a * center_x(t) + order.b * center_y(t);
            const Floats value =
                mul_add(Floats::load(kOffsets.x[of_tile]), Floats(order.a),
                        mul_add(Floats::load(kOffsets.y[of_tile]), Floats(order.b), Floats(at)));
            const std::uint32_t nearer = (value > Floats(order.e)).bits() & same;
            found.store(tile_, b, RayMask::from_bits(nearer), slot);
            open &= ~(nearer | ((value < Floats(-order.e)).bits() & same));
        }
        if (open != 0) decide(slot, b, open);
    }

    HWY_INLINE void add_quadric(std::uint32_t place) {
        __builtin_prefetch(job_.tables.boxes.data() + place);
        quadrics_[quadric_count_++] = place;
        if (quadric_count_ == kBatch) choose_quadrics();
    }

    HWY_NOINLINE void choose_quadrics() {
        const std::size_t count = std::exchange(quadric_count_, std::size_t{0});
        for (std::size_t i = 0; i < count; ++i)
            queue_[BoxCulling::place(i)] = job_.tables.boxes[quadrics_[i]];
        const std::size_t chosen = choose(count);
        for (std::size_t c = 0; c < chosen; ++c) {
            const std::uint32_t place = quadrics_[chosen_[c]];
            __builtin_prefetch(job_.tables.spheres.data() + place);
            for_each_tile(job_.tables.boxes[place], c, [&](int t, std::uint32_t blocks) HWY_ATTR {
                WaitingSpheres& waiting = spheres_[t];
                waiting.place[waiting.count] = place;
                waiting.blocks[waiting.count++] = blocks;
                if (waiting.count == kBatch) test_spheres(t);
            });
        }
    }

    HWY_NOINLINE void test_spheres(int t) {
        WaitingSpheres& waiting = spheres_[t];
        const std::size_t count = std::exchange(waiting.count, std::size_t{0});
        if (count == 0) return;
        SeenQuadric seen[kBatch];
        for (std::size_t i = 0; i < count; ++i)
            seen[i] = job_.tables.seen(job_.scene.triangle_end() + waiting.place[i]);
        conics_.fill(seen, count, TileRays(job_.camera, tile_.tile_x(t), tile_.tile_y(t)));
        for (std::size_t i = 0; i < count; ++i) {
            const Slot slot = job_.scene.triangle_end() + waiting.place[i];
            std::uint32_t blocks = waiting.blocks[i];
            if (std::popcount(blocks) > kFewBlocks) blocks = conics_.met(i, blocks);
            for (; blocks != 0; blocks &= blocks - 1)
                take_sphere(slot, *seen[i].sphere, i, t, std::countr_zero(blocks));
        }
        pyramid_.update();
    }

    HWY_INLINE void take_sphere(Slot slot, const CameraSphere& s, std::size_t i, int t,
                                int b_of_tile) {
        const int b = kTileBlocks * t + b_of_tile;
        const Floats x = Floats::load(kOffsets.x[b_of_tile]);
        const Floats y = Floats::load(kOffsets.y[b_of_tile]);
        const Floats discriminant = conics_.discriminant(i, x, y);
        const RayMask perhaps = discriminant >= Floats(-conics_.error(i));
        if (!perhaps.any()) return;
        const SphereHits hits(s, conics_, i, discriminant, x, y);
        const Candidates found(tile_, b, hits.low, hits.high);
        RayMask sure = (discriminant > Floats(conics_.error(i))) & found.surely_nearer;
        RayMask open = without(perhaps & found.perhaps_nearer, sure);
        if (s.floats_cannot_tell || !conics_.known(i)) {
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
        pyramid_.changed(b);
    }

    // Lane by lane, exactly.
    HWY_NOINLINE void decide(Slot slot, int b, std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) {
            const int lane = b * kBlockLanes + std::countr_zero(bits);
            if (tile_.slot[lane] == slot) continue;
            const int t = b / kTileBlocks;
            const int of_tile = lane % kTileLanes;
            const auto nearest =
                job_.fallback.nearer(tile_.tile_x(t) + lane_x(of_tile),
                                     tile_.tile_y(t) + lane_y(of_tile), slot, tile_.slot[lane]);
            if (!nearest) continue;
            tile_.slot[lane] = slot;
            tile_.near_low[lane] = nearest->low;
            tile_.near_high[lane] = nearest->high;
            if (normals_ == nullptr) continue;
            for (int axis = 0; axis < 3; ++axis)
                normals_->normal[axis][lane] = static_cast<float>(nearest->normal[axis]);
            normals_->error[lane] = roundings(2);
        }
    }

    // Spheres that may be seen in a tile: places in the tables, and blocks.
    struct WaitingSpheres {
        std::size_t count = 0;
        std::uint32_t place[kBatch];
        std::uint32_t blocks[kBatch];
    };

    PrimaryJob& job_;
    MacroTile& tile_;
    EllipsoidNormals* normals_;
    BoxCulling culling_;
    PixelBoxMaker box_maker_;
    TriangleMaker triangle_maker_;
    CornerFetch corners_;
    DepthPyramid pyramid_;
    StartRange starts_;
    // Boxes of the items of a batch, those chosen, and the tiles where they may be seen.
    alignas(64) PixelBox queue_[kBatch] = {};
    std::int32_t chosen_[2 * kBatch];
    std::int32_t tiles_[2 * kBatch];
    std::uint32_t quadrics_[kBatch];
    std::size_t quadric_count_ = 0;
    WaitingSpheres spheres_[MacroTile::kTiles];
    SphereConics conics_;
};

void trace_primary(PrimaryJob& job, MacroTile& tile, EllipsoidNormals* normals) {
    clear(tile, job.camera);
    PrimaryTracer(job, tile, normals).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

PrimaryStage::PrimaryStage(InstructionSet isa) : trace_(NUVO_FOR_ISA(isa, trace_primary)) {}

}  // namespace nuvo
#endif
