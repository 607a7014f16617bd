// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_LANES_H_
#undef NUVO_RENDER_FAST_SHADOW_LANES_H_
#else
#define NUVO_RENDER_FAST_SHADOW_LANES_H_
#endif

#include "fast/light/light_cells.h"
#include "fast/shadow/shadow_tables.h"
#include "fast/simd/lanes.h"

// Points in registers against what hides them from a light.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

HWY_INLINE Floats plane_at(const float (&n)[4], const Points& p) {
    return mul_add(p.x, Floats(n[0]),
                   mul_add(p.y, Floats(n[1]), mul_add(p.z, Floats(n[2]), Floats(n[3]))));
}
/// The least of the four functions of `t` at the points.
HWY_INLINE Floats shadow_depth(const ShadowPlanes& t, const Points& p) {
    return min(min(plane_at(t.plane[0], p), plane_at(t.plane[1], p)),
               min(plane_at(t.plane[2], p), plane_at(t.plane[3], p)));
}
/// The least of those but the plane through one edge.
HWY_INLINE Floats shadow_depth_past(int edge, const ShadowPlanes& t, const Points& p) {
    return min(min(plane_at(t.plane[(edge + 1) % 3], p), plane_at(t.plane[(edge + 2) % 3], p)),
               plane_at(t.plane[3], p));
}

/// Shadow rays from points to a light.
struct ShadowRays {
    Points direction;  ///< unit
    Floats distance;   ///< infinite for a direction
    Floats inverse;    ///< of the distance

    HWY_INLINE ShadowRays() = default;
    HWY_INLINE ShadowRays(const LightPoint& light, const Points& p)
        : ShadowRays(light.toward, light.weight, p) {}
    /// To the point toward / weight.
    HWY_INLINE ShadowRays(const Vector3& toward, double light_weight, const Points& p) {
        const Floats weight(static_cast<float>(light_weight));
        const Points way = mul_add(p, -weight, Points::all(Vec3<float>(toward)));
        const Floats inverse_root = Floats(1.0F) / sqrt(fused_dot(way, way));
        direction = way * inverse_root;
        inverse = inverse_root * weight;
        distance = Floats(1.0F) / inverse;
    }
};

/// A sphere, one around an ellipsoid, or an ellipsoid's ball, with what is known of it towards the
/// light.
struct QuadricItem {
    HWY_INLINE QuadricItem(const LocalSphere& ball, LightSide of_sphere_around)
        : shape(ball),
          sphere(true),
          side(of_sphere_around == LightSide::kOutside ? of_sphere_around : LightSide::kUnknown) {}
    HWY_INLINE QuadricItem(const ShadowTables& tables, const ShadowTable& table, Slot slot)
        : shape(tables.quadric(slot)),
          sphere(slot < tables.scene().sphere_end()),
          side(table.quadric_sides.empty()
                   ? LightSide::kOutside
                   : table.quadric_sides[slot - tables.scene().triangle_end()]) {}

    const LocalSphere& shape;
    bool sphere;  ///< not one around something
    LightSide side;
};

/// The point of a shadow ray that is nearest to the centre of a sphere. If it surely lies outside
/// the ray is free: it neither crosses nor touches the sphere. If it surely lies inside, and the
/// light outside, the ray is blocked: it has to come out, at t > 0, wherever it starts; if it
/// starts on the sphere itself, then inwards. The rounding of the parameter does not matter, for
/// any other is a point of the ray, too.
struct QuadricTest {
    /// `error` bounds how far shadow rays may be off.
    HWY_INLINE QuadricTest(const QuadricItem& item, const Points& p, const ShadowRays& ray,
                           const Floats& error) {
        const Points f = Points::all(item.shape.center) - p;
        const Floats b = fused_dot(f, ray.direction);
        const Floats at = min(max(b, Floats(0.0F)), ray.distance);
        const Points l = mul_add(ray.direction, -at, f);
        square = fused_dot(l, l);
        const Floats more = Floats(item.shape.radius) + error;
        outside = more * more;
        // Nothing is surely inside of an ellipsoid's sphere.
        const bool full = item.sphere && item.side == LightSide::kOutside;
        const Floats less = max(Floats(full ? item.shape.radius : 0.0F) - error, Floats(0.0F));
        inside = less * less;
    }
    HWY_INLINE std::uint32_t free() const { return (square > outside).bits(); }
    HWY_INLINE std::uint32_t blocked() const { return (square < inside).bits(); }

    Floats square;   ///< of the distance of that point from the centre
    Floats outside;  ///< beyond this the point lies outside
    Floats inside;   ///< below this inside
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_LANES_H_
