#pragma once

#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "direction_cells.h"
#include "hull_planes.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/render/primitives.h"
#include "primitive_store.h"
#include "surface.h"

namespace nuvo {

inline LightPlace place_of(const Light& light) {
    if (light.kind == Light::Kind::kDirectional) return {-light.direction, true};
    return {light.location, false};
}

/// Every decision as exact arithmetic on the scene's doubles makes it (docs/numerics.md). `Store`
/// finds primitives by their id (primitive_store.h).
template <typename Store>
class ExactKernelOf {
  public:
    using Scalar = double;
    using PreparedRay = ExactRay;
    struct Hit {
        PrimitiveId primitive;
        Root root;
        SphereRoot which = SphereRoot::kNear;
    };
    struct Surface {
        Point3 point;
        Vector3 normal;  // shading
        double error;    // of the point, on each axis
        PrimitiveId primitive;
        Vec2<double> uv;  // on a triangle
    };
    struct Shadow {
        ExactRay ray;
        double end;  // of the way to the light, in units of the ray's direction
        double origin_error;
        std::optional<PrimitiveId> from;  // the primitive that is lit; none: the bias has left it
        const Light* light;
        // Another way from the same point: what blocks one blocks the point's light. [way_starts()]
        std::optional<WayStart> across = std::nullopt;
    };
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    ExactKernelOf(const Scene& scene, const Primitives& primitives, std::optional<double> bias,
                  BackFaces back_faces = BackFaces::kSolid)
        : store_(scene, primitives, back_faces),
          triangles_(primitives.kind(PrimitiveKind::kTriangle).box),
          bias_(bias) {}

    const PrimitiveSource& source(PrimitiveId id) const { return store_.source(id); }
    std::size_t memory_bytes() const { return store_.memory_bytes(); }
    const StageCounts& stage_counts() const { return counts_; }
    /// For kernels of other pictures to go on with: what they hold depends on no scene or camera.
    StageCounts& stage_counts() { return counts_; }

    PreparedRay prepare(const Ray& ray) const { return ExactRay(ray, triangles_); }
    Ray walk_ray(const ExactRay& ray) const { return {ray.origin(), ray.direction()}; }
    Ray nudged_ray(const ExactRay& ray) const { return walk_ray(ray); }

    /// The nearest hit on one primitive.
    std::optional<Hit> hit_of(const ExactRay& ray, PrimitiveId id) const {
        return store_.visit_faces(id, [&](const auto& primitive, Faces faces) {
            return hit_on(ray, primitive, faces, id);
        });
    }
    /// Replaces `best` by the nearest hit on the primitives of `range` if that is nearer, or as
    /// near and earlier in the document.
    void closest(const ExactRay& ray, PrimitiveRange range, std::optional<Hit>& best) const {
        for (PrimitiveId id = range.first; id < range.last; ++id) {
            const std::optional<Hit> hit = hit_of(ray, id);
            if (hit && (!best || precedes(ray, *hit, *best))) best = hit;
        }
    }
    /// Whether hit `a` comes before hit `b`: of equal t the lower id.
    bool precedes(const ExactRay& ray, const Hit& a, const Hit& b) const {
        if (a.root.high < b.root.low) return true;
        if (b.root.high < a.root.low) return false;
        if (a.primitive == b.primitive) return false;  // met again in another leaf
        const int order = store_.visit(a.primitive, [&](const auto& first) {
            return store_.visit(b.primitive, [&](const auto& second) {
                return compare_roots(ray, {&first, a.which}, {&second, b.which}, counts_);
            });
        });
        return order < 0 || (order == 0 && a.primitive < b.primitive);
    }
    double t(const Hit& hit) const { return hit.root.t; }
    double upper_t(const Hit& hit) const { return hit.root.high; }

    Surface surface(const ExactRay& ray, const Hit& hit, const Object& object) const {
        const SurfacePoint point = store_.visit(hit.primitive, [&](const auto& primitive) {
            if constexpr (std::is_same_v<std::decay_t<decltype(primitive)>, Triangle>)
                return surface_point(ray, primitive);
            else
                return surface_point(ray, primitive, hit.which);
        });
        const Vector3 normal = shading_normal(object, source(hit.primitive).triangle, point.normal,
                                              point.uv, ray.direction());
        return {point.point, normal, point.error, hit.primitive, point.uv};
    }

    Shadow shadow(const Surface& surface, const Light& light) const {
        if (bias_) return shadow({surface.point + surface.normal * *bias_, 0}, std::nullopt, light);
        WayStarts starts{{surface.point, surface.error}, std::nullopt};
        with_triangle(surface.primitive, [&](const Triangle& lit) {
            starts = way_starts(starts.first, lit, place_of(light), counts_);
            return true;
        });
        Shadow found = shadow(starts.first, surface.primitive, light);
        found.across = starts.second;
        return found;
    }
    /// Whether `blocked` says so of a way from the lit point to the light: most points have one.
    template <typename Blocked>
    bool any_way(const Shadow& first, Blocked&& blocked) const {
        if (blocked(first)) return true;
        return first.across && blocked(shadow(*first.across, first.from, *first.light));
    }

    bool blocks(const Shadow& shadow, PrimitiveRange range) const {
        for (PrimitiveId id = range.first; id < range.last; ++id)
            if (blocks_before(shadow, shadow.end, id)) return true;
        return false;
    }
    /// Around the primitives of these ids.
    template <typename Ids>
    HullPlanes hull(const Ids& ids) const {
        HullPlanes planes;
        for (const PrimitiveId id : ids)
            if (!with_triangle(id, [&](const Triangle& t) { return planes = HullPlanes(t), true; }))
                return {};
        for (const PrimitiveId id : ids)
            with_triangle(id, [&](const Triangle& t) {
                for (const Point3& corner : {t.a, t.b, t.c}) planes.hold(corner);
                return true;
            });
        return planes;
    }
    /// Lists in `cells` what rays through their point may meet of this primitive.
    void add_to(DirectionCells& cells, PrimitiveId id, const Bounds3& box) const {
        const bool is_triangle =
            with_triangle(id, [&](const Triangle& t) { return cells.add(id, t), true; });
        if (!is_triangle) cells.add(id, box);
    }
    /// Whether `other` can be left out where a ray from `eye` meets `front`.
    bool hides(PrimitiveId front, const Point3& eye, PrimitiveId other) const {
        return with_triangle(front, [&](const Triangle& f) {
            return with_triangle(other, [&](const Triangle& o) {
                return nuvo::hides(f, eye, o, front < other, counts_);
            });
        });
    }
    bool lights_triangle(const Shadow& shadow) const {
        return shadow.from && with_triangle(*shadow.from, [](const Triangle&) { return true; });
    }
    /// Whether `other` can be left out on all ways from the lit triangle to the light.
    bool leaves_in_light(PrimitiveId other, const Shadow& shadow) const {
        const LightPlace light = place_of(*shadow.light);
        return with_triangle(*shadow.from, [&](const Triangle& lit) {
            return with_triangle(other, [&](const Triangle& o) {
                return nuvo::leaves_in_light(o, lit, light, counts_) ||
                       nuvo::stays_behind(o, lit, light, counts_);
            });
        });
    }
    /// Whether the primitive that is lit stands in its own light.
    bool blocks_itself(const Shadow& shadow) const {
        return shadow.from && blocks_before(shadow, shadow.end, *shadow.from);
    }
    /// Where the shadow ray first meets the range, before or behind the light; infinity: never.
    double shadow_t(const Shadow& shadow, PrimitiveRange range) const {
        double nearest = kInfinity;
        for (PrimitiveId id = range.first; id < range.last; ++id) {
            if (blocks_before(shadow, kInfinity, id))
                nearest = std::fmin(nearest, blocking_t(shadow.ray, id));
        }
        return nearest;
    }

  private:
    std::optional<Hit> hit_on(const ExactRay& ray, const Triangle& triangle, Faces faces,
                              PrimitiveId id) const {
        const std::optional<Root> root = hit(ray, triangle, counts_, faces.sides);
        if (!root) return std::nullopt;
        return Hit{id, *root};
    }
    template <typename Quadric>
    std::optional<Hit> hit_on(const ExactRay& ray, const Quadric& quadric, Faces faces,
                              PrimitiveId id) const {
        const std::optional<SphereHit> found = hit(ray, quadric, counts_, faces.sides);
        if (!found) return std::nullopt;
        return Hit{id, found->root, found->which};
    }

    // What `use` says of the triangle of that id; of others false.
    template <typename Use>
    bool with_triangle(PrimitiveId id, Use&& use) const {
        return store_.visit(id, [&](const auto& primitive) {
            if constexpr (std::is_same_v<std::decay_t<decltype(primitive)>, Triangle>)
                return use(primitive);
            else
                return false;
        });
    }

    Shadow shadow(const WayStart& start, std::optional<PrimitiveId> from,
                  const Light& light) const {
        const LightPlace place = place_of(light);
        if (place.endless)
            return {ExactRay(Ray{start.point, place.at}, triangles_), kInfinity, start.error, from,
                    &light};
        return {ExactRay::between(start.point, place.at, triangles_), 1, start.error, from, &light};
    }

    bool stays_behind(const Triangle& other, const Shadow& shadow) const {
        return shadow.from && with_triangle(*shadow.from, [&](const Triangle& lit) {
                   return nuvo::stays_behind(other, lit, place_of(*shadow.light), counts_);
               });
    }

    // Where a shadow ray meets a primitive that blocks it.
    double blocking_t(const ExactRay& ray, PrimitiveId id) const {
        return store_.visit(id, [&](const auto& primitive) {
            if constexpr (std::is_same_v<std::decay_t<decltype(primitive)>, Triangle>) {
                const std::optional<Root> root = hit(ray, primitive, counts_);
                return root ? root->t : kInfinity;
            } else {
                if (store_.faces(id).sides == Sides::kFront) {  // where it leaves the solid
                    const Point3 exit = surface_point(ray, primitive, SphereRoot::kFar).point;
                    return dot(exit - ray.origin(), ray.direction()) / ray.square();
                }
                const std::optional<SphereHit> found = hit(ray, primitive, counts_);
                return found ? found->root.t : kInfinity;
            }
        });
    }

    bool blocks_before(const Shadow& shadow, double end, PrimitiveId id) const {
        const bool self = shadow.from && *shadow.from == id;
        return store_.visit_faces(id, [&](const auto& primitive, Faces faces) {
            if (!faces.cast_shadows) return false;
            if constexpr (std::is_same_v<std::decay_t<decltype(primitive)>, Triangle>)
                return !self &&
                       nuvo::blocks(shadow.ray, end, shadow.origin_error, primitive, counts_,
                                    faces.sides) &&
                       !stays_behind(primitive, shadow);
            else
                return nuvo::blocks(shadow.ray, end, shadow.origin_error, primitive, self, counts_,
                                    faces.sides);
        });
    }

    Store store_;
    Bounds3 triangles_;
    std::optional<double> bias_;
    mutable StageCounts counts_;
};

/// The serial tracer's.
using ExactKernel = ExactKernelOf<PrimitiveStore<std::vector<Triangle>, Sphere, Ellipsoid>>;

}  // namespace nuvo
