// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_BLOCK_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_BLOCK_H_
#undef NUVO_RENDER_FAST_SHADOW_BLOCK_H_
#else
#define NUVO_RENDER_FAST_SHADOW_BLOCK_H_
#endif

#include <algorithm>
#include <bit>

#include "fast/shadow/shadow.h"
#include "fast/shadow/shadow_lanes.h"
#include "fast/simd/lanes.h"
#include "fast/tile/tile.h"

// The points of a block and what hides them. A shadow ray is blocked as soon as one item surely
// blocks it; what floats leave open is put aside for the fallback, who is asked only about points
// that nothing blocked surely.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// One light and what tells its shadows.
struct ShadowContext {
    ShadowContext(ShadowJob& of, std::size_t index)
        : job(of), light(index), table(of.tables.table(index)) {}

    ShadowJob& job;
    std::size_t light;
    const ShadowTable& table;
};

class ShadowBlock {
  public:
    HWY_INLINE void start(const ShadowContext& context, const Tile& tile, int block,
                          std::uint32_t lanes) {
        const ShadowTables& tables = context.job.tables;
        first_ = static_cast<std::uint32_t>(block * kBlockLanes);
        slots_ = reinterpret_cast<const std::int32_t*>(tile.slot) + first_;
        waiting_ = lanes;
        points_ = points_of(tile, block);
        error_ = Floats::load(tile.point_error + first_);
        const Floats size = max(max_norm(points_), Floats(tables.dense()));
        plane_error_ = mul_add(size, Floats(kPlaneError), error_ + Floats(tables.plane_error())) *
                       Floats(kRounded);
        if (!tables.has_quadrics()) return;
        quadric_error_ =
            mul_add(size, Floats(kQuadricError), error_ + error_ + Floats(tables.quadric_touch()));
        shadow_rays_ = ShadowRays(context.table.light, points_);
    }

    const Points& points() const { return points_; }
    const Floats& error() const { return error_; }
    /// Beyond it the sign of a plane's function is sure.
    const Floats& plane_error() const { return plane_error_; }
    /// The lanes that nothing has surely blocked yet.
    std::uint32_t waiting() const { return waiting_; }
    /// Ends the waiting of lanes.
    HWY_INLINE void block(std::uint32_t lanes) { waiting_ &= ~lanes; }

    /// Asks whether the item at a place of the table hides the light from `lanes`; of other lanes
    /// it may find so, too.
    HWY_INLINE void test(const ShadowContext& context, Slot place, std::uint32_t lanes) {
        const ShadowTable& table = context.table;
        if (place < table.triangles)
            test_triangle(context, table.planes[place], table.slot(place), lanes);
        else
            test_quadric(context, table.slot(place), lanes);
    }
    /// The same of a slot that a walk meets.
    HWY_INLINE void test_met(const ShadowContext& context, Slot slot, std::uint32_t lanes) {
        if (slot >= context.job.tables.scene().triangle_end())
            test_quadric(context, slot, lanes);
        else if (const ShadowPlanes* const planes = context.job.walk_planes.of(context.light, slot))
            test_triangle(context, *planes, slot, lanes);
    }

  private:
    // Outweighs the roundings of the sum that it multiplies.
    static constexpr float kRounded = 1 + roundings(4);

    HWY_INLINE void test_triangle(const ShadowContext& context, const ShadowPlanes& planes,
                                  Slot slot, std::uint32_t lanes) {
        const Floats depth = shadow_depth(planes, points_);
        block((depth > plane_error_).bits());
        // It does not hide its own points. All signs before the one branch: each alone is a guess.
        const std::uint32_t open = waiting_ & lanes & ~((depth < -plane_error_).bits() | own(slot));
        if (HWY_UNLIKELY(open != 0))
            leave_triangle(context, planes, slot, open, depth > Floats(0.0F));
    }
    // Of other triangles' points it is asked what it does to all of a triangle's.
    HWY_NOINLINE void leave_triangle(const ShadowContext& context, const ShadowPlanes& planes,
                                     Slot slot, std::uint32_t lanes, const RayMask& rounded) {
        for (std::uint32_t rest = lanes; rest != 0;) {
            const auto lit = static_cast<Slot>(slots_[std::countr_zero(rest)]);
            const std::uint32_t same = own(lit) & rest;
            rest &= ~same;
            if (lit >= context.job.tables.scene().triangle_end()) continue;
            const PairShadow pair = context.job.pairs.of(lit, slot, context.light);
            if (pair == PairShadow::kOpen) continue;
            lanes &= ~same;
            if (pair == PairShadow::kNone) continue;
            const Floats depth = shadow_depth_past(edge_of(pair), planes, points_);
            block(same & (depth > plane_error_).bits());
            lanes |= same & waiting_ & ~(depth < -plane_error_).bits();
        }
        put_aside(context.job, slot, lanes, rounded.bits());
    }
    // Whose plane is left out; as ShadowPlanes has them.
    static int edge_of(PairShadow pair) {
        return static_cast<int>(pair) - static_cast<int>(PairShadow::kPastEdgeAB);
    }

    HWY_INLINE void test_quadric(const ShadowContext& context, Slot slot, std::uint32_t lanes) {
        const QuadricItem item(context.job.tables, context.table, slot);
        if (item.side == LightSide::kNoShadow) return;
        const Floats error =
            (quadric_error_ + Floats(kQuadricError * size_of(item.shape))) * Floats(kRounded);
        const QuadricTest test(item, points_, shadow_rays_, error);
        block(test.blocked());
        const std::uint32_t open = waiting_ & lanes & ~test.free();
        if (HWY_LIKELY(open == 0)) return;
        const FastScene& scene = context.job.tables.scene();
        if (!item.sphere && scene.ball(slot).sure)
            test_ball(context, scene.ball(slot), item.side, slot, open, error);
        else
            leave_quadric(context.job, slot, open, item, test, {points_, shadow_rays_, error});
    }
    // The same where the ellipsoid is a ball. [numerics: ellipsoids as balls]
    HWY_NOINLINE void test_ball(const ShadowContext& context, const BallMap& map, LightSide side,
                                Slot slot, std::uint32_t lanes, const Floats& error) {
        const LightPoint& light = context.table.light;
        const Points from_center = points_ - Points::all(Vec3<float>(map.center));
        const auto row = [&](int i) HWY_ATTR {
            return fused_dot(from_center, Points::all(Vec3<float>(map.to_ball.row[i])));
        };
        const Points points{row(0), row(1), row(2)};
        const ShadowRays rays(map.to_ball * (light.toward - map.center * light.weight),
                              light.weight, points);
        const LocalSphere ball{{0, 0, 0}, static_cast<float>(map.radius)};
        const QuadricItem item(ball, side);
        const Floats more = error * Floats(rounded_up(2 * map.stretch * (1 + map.stretch)));
        const QuadricTest test(item, points, rays, more);
        block(lanes & test.blocked());
        lanes &= waiting_ & ~test.free();
        if (HWY_UNLIKELY(lanes != 0))
            leave_quadric(context.job, slot, lanes, item, test, {points, rays, more});
    }
    // Points and rays as a quadric is tested against them, and how far these may be off.
    struct Seen {
        const Points& points;
        const ShadowRays& rays;
        const Floats& error;
    };
    // Nor does a sphere where the ray to the light leads outwards. Its own points touch it, so they
    // come here unless their shadow rays lead deep into it.
    HWY_NOINLINE void leave_quadric(ShadowJob& job, Slot slot, std::uint32_t lanes,
                                    const QuadricItem& item, const QuadricTest& test,
                                    const Seen& seen) {
        const Floats& error = seen.error;
        const std::uint32_t of_item = lanes & own(slot);
        std::uint32_t rounded =
            (test.square < Floats(item.shape.radius * item.shape.radius)).bits() & ~of_item;
        if (item.sphere) {
            const Points f = Points::all(item.shape.center) - seen.points;
            const Floats along = fused_dot(f, seen.rays.direction);
            // Off by the ray's own error at one end, at most 1 away or a ball's radius, and by the
            // point's.
            const Floats away(std::fmax(1.0F, item.shape.radius));
            const Floats margin = mul_add(seen.rays.inverse * away, error, error);
            const std::uint32_t outwards = (along < -margin).bits();
            const std::uint32_t inwards = (along > margin).bits();
            if (item.side == LightSide::kOutside) block(of_item & inwards);
            lanes &= ~(of_item & outwards);
            if (item.side == LightSide::kInside) {
                // The ray ends inside: blocked iff it starts outside.
                const Floats square = fused_dot(f, f);
                const Floats less = max(Floats(item.shape.radius) - error, Floats(0.0F));
                block(lanes & ~of_item & (square > test.outside).bits());
                lanes &= ~(of_item | (square < less * less).bits());
            }
            rounded |= of_item & (along > Floats(0.0F)).bits();
        }
        put_aside(job, slot, lanes & waiting_, rounded);
    }

    // Lanes that lie on the primitive.
    HWY_INLINE std::uint32_t own(Slot slot) const {
        return (Ints::load(slots_) == Ints(static_cast<std::int32_t>(slot))).bits();
    }
    HWY_INLINE void put_aside(ShadowJob& job, Slot slot, std::uint32_t lanes,
                              std::uint32_t rounded) {
        if (!job.redo_exactly) {
            block(lanes & rounded);
            return;
        }
        for (; lanes != 0; lanes &= lanes - 1)
            job.open.push_back(
                {first_ + static_cast<std::uint32_t>(std::countr_zero(lanes)), slot});
    }

    const std::int32_t* slots_;
    std::uint32_t first_;  // lane of the tile
    std::uint32_t waiting_;
    Points points_;
    Floats error_;
    Floats plane_error_;
    Floats quadric_error_;
    ShadowRays shadow_rays_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_BLOCK_H_
