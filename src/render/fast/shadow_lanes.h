// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_LANES_H_
#undef NUVO_RENDER_FAST_SHADOW_LANES_H_
#else
#define NUVO_RENDER_FAST_SHADOW_LANES_H_
#endif

#include "beam_box.h"
#include "lanes.h"
#include "shadow_tables.h"
#include "tile.h"

// Points in registers against what hides them from a light.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

struct Points {
    Floats x, y, z;
};

/// A box around points.
struct PointBox {
    float low[3];
    float high[3];

    float extent(int axis) const { return high[axis] - low[axis]; }
    float size() const { return extent(0) + extent(1) + extent(2); }
};

/// The least of the four functions of `t` at the points.
HWY_INLINE Floats hidden(const ShadowPlanes& t, const Points& p) {
    const auto at = [&](const float(&n)[4]) HWY_ATTR {
        return mul_add(p.x, Floats(n[0]),
                       mul_add(p.y, Floats(n[1]), mul_add(p.z, Floats(n[2]), Floats(n[3]))));
    };
    return min(min(at(t.plane[0]), at(t.plane[1])), min(at(t.plane[2]), at(t.plane[3])));
}

/// The ways from points to a light.
struct Ways {
    Floats x, y, z;   ///< unit
    Floats distance;  ///< infinite for a direction
    Floats inverse;   ///< of the distance

    HWY_INLINE Ways() = default;
    HWY_INLINE Ways(const LightPoint& light, const Points& p) {
        const auto weight = static_cast<float>(light.weight);
        x = neg_mul_add(p.x, Floats(weight), Floats(static_cast<float>(light.toward.x)));
        y = neg_mul_add(p.y, Floats(weight), Floats(static_cast<float>(light.toward.y)));
        z = neg_mul_add(p.z, Floats(weight), Floats(static_cast<float>(light.toward.z)));
        const Floats square = mul_add(x, x, mul_add(y, y, z * z));
        const Floats inverse_root = Floats(1.0F) / sqrt(square);
        x = x * inverse_root;
        y = y * inverse_root;
        z = z * inverse_root;
        inverse = inverse_root * Floats(weight);
        distance = Floats(1.0F) / inverse;
    }
};

/// A sphere, or one around an ellipsoid, with what is known of it towards the light.
struct RoundItem {
    HWY_INLINE RoundItem(const ShadowTables& tables, const ShadowTable& table, Slot slot)
        : shape(tables.round(slot)),
          side(table.round_sides.empty() ? LightSide::kOutside
                                         : table.round_sides[slot - tables.scene().triangle_end()]),
          sphere(slot < tables.scene().sphere_end()) {}

    const RoundShape& shape;
    LightSide side;
    bool sphere;
};

/// What points and ways tell of a sphere; `error` bounds how far a way may be off.
/// The point of a way nearest to the centre tells all: where it lies inside and both ends lie
/// outside, the way is blocked; the rounding of its parameter does not matter, for wherever it lies
/// on the way, it is a point of the way.
struct RoundTest {
    HWY_INLINE RoundTest(const RoundShape& shape, const Points& p, const Ways& way, Floats error) {
        const Floats fx = Floats(shape.center[0]) - p.x;
        const Floats fy = Floats(shape.center[1]) - p.y;
        const Floats fz = Floats(shape.center[2]) - p.z;
        const Floats b = mul_add(fx, way.x, mul_add(fy, way.y, fz * way.z));
        const Floats lx = neg_mul_add(b, way.x, fx);
        const Floats ly = neg_mul_add(b, way.y, fy);
        const Floats lz = neg_mul_add(b, way.z, fz);
        const Floats aside = mul_add(lx, lx, mul_add(ly, ly, lz * lz));
        const Floats square = mul_add(b, b, aside);
        const Floats radius(shape.radius);
        const Floats more = radius + error;
        const Floats less = max(radius - error, Floats(0.0F));
        const Floats more_square = more * more;
        const Floats less_square = less * less;
        along = b;
        passes = aside > more_square;
        outside = square > more_square;
        inside = square < less_square;
        crosses = aside < less_square;
        behind = b <= Floats(0.0F);
        beyond = b >= way.distance;
    }

    /// Lanes whose ways the item surely does not block.
    HWY_INLINE std::uint32_t free(const RoundItem& item) const {
        RayMask mask = passes | (outside & behind);
        if (item.side == LightSide::kOutside) mask = passes | (outside & (behind | beyond));
        if (item.side == LightSide::kInside && item.sphere) mask = mask | inside;
        return mask.bits();
    }
    /// Lanes whose ways the item surely blocks.
    HWY_INLINE std::uint32_t blocked(const RoundItem& item) const {
        if (!item.sphere || item.side == LightSide::kUnknown) return 0;
        if (item.side == LightSide::kInside) return outside.bits();
        return (without(crosses & outside, behind | beyond) | inside).bits();
    }

    Floats along;     ///< from the point to the foot of the centre
    RayMask passes;   ///< the line surely misses the sphere
    RayMask outside;  ///< the point surely lies outside, and does not touch
    RayMask inside;
    RayMask crosses;  ///< the foot surely lies inside
    RayMask behind;   ///< the foot lies before the point
    RayMask beyond;   ///< the foot lies behind the light
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_LANES_H_
