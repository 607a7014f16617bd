#pragma once

#include <limits>
#include <optional>
#include <type_traits>

#include "nuvo/geometry/plain_tests.h"
#include "nuvo/geometry/plain_triangles.h"
#include "nuvo/render/primitives.h"
#include "primitive_store.h"
#include "surface.h"

namespace nuvo {

/// The thesis' arithmetic: plain tests in T, float as published or double. What rounding decides it
/// decides; the kernel is there to be measured against ExactKernel.
template <typename T>
class PlainKernel {
    struct PlainSphere {
        Vec3<T> center;
        T radius;
        explicit PlainSphere(const Sphere& s)
            : center(s.center), radius(static_cast<T>(s.radius)) {}
    };
    using PlainEllipsoid = plain::LocalEllipsoid<T>;
    using Triangles = plain::Triangles<T>;

    // Whether leaf items are more than single primitives.
    static bool holds_runs(const Primitives& primitives) {
        return primitives.item_count() < primitives.sources.size();
    }

  public:
    using Scalar = T;
    using PreparedRay = RayT<T>;
    struct Hit {
        PrimitiveId primitive;
        T t;
        Vec2<T> uv;
    };
    struct Surface {
        Point3 point;
        Vector3 normal;  // shading
        PrimitiveId primitive;
        Vec2<double> uv;  // on a triangle
    };
    struct Shadow {
        RayT<T> ray;
        T end;                            // of the way to the light
        std::optional<PrimitiveId> from;  // the primitive that is lit; none: the bias has left it
    };
    static constexpr T kInfinity = std::numeric_limits<T>::infinity();

    PlainKernel(const Scene& scene, const Primitives& primitives, std::optional<double> bias,
                BackFaces back_faces = BackFaces::kSolid)
        : store_(scene, primitives, back_faces, Triangles(holds_runs(primitives))), bias_(bias) {}

    const PrimitiveSource& source(PrimitiveId id) const { return store_.source(id); }
    std::size_t memory_bytes() const { return store_.memory_bytes(); }

    PreparedRay prepare(const Ray& ray) const {
        return {Vec3<T>(ray.origin), Vec3<T>(ray.direction)};
    }
    Ray walk_ray(const RayT<T>& ray) const { return {Point3(ray.origin), Vector3(ray.direction)}; }
    const RayT<T>& nudged_ray(const RayT<T>& ray) const { return ray; }

    void closest(const RayT<T>& ray, PrimitiveRange range, std::optional<Hit>& best) const {
        for_each_hit<false>(ray, range, [&](PrimitiveId id, const plain::Hit<T>& hit) {
            if (!best || hit.t < best->t || (hit.t == best->t && id < best->primitive))
                best = Hit{id, hit.t, hit.uv};
        });
    }
    T t(const Hit& hit) const { return hit.t; }
    T upper_t(const Hit& hit) const { return hit.t; }

    Surface surface(const RayT<T>& ray, const Hit& hit, const Object& object) const {
        const Vec3<T> point = ray.at(hit.t);
        const Vec3<T> normal = store_.visit(hit.primitive, [&](const auto& primitive) {
            return geometric_normal(primitive, point);
        });
        const Vec2<double> uv{hit.uv.x, hit.uv.y};
        return {Point3(point),
                shading_normal(object, source(hit.primitive).triangle, Vector3(normal), uv,
                               Vector3(ray.direction)),
                hit.primitive, uv};
    }

    Shadow shadow(const Surface& surface, const Light& light) const {
        const Point3 origin = bias_ ? surface.point + surface.normal * *bias_ : surface.point;
        const auto from = bias_ ? std::nullopt : std::optional<PrimitiveId>(surface.primitive);
        if (light.kind == Light::Kind::kDirectional)
            return {{Vec3<T>(origin), Vec3<T>(-light.direction)}, kInfinity, from};
        const Vec3<T> way = Vec3<T>(light.location) - Vec3<T>(origin);
        const T distance = length(way);
        return {{Vec3<T>(origin), way / distance}, distance, from};
    }

    bool blocks(const Shadow& shadow, PrimitiveRange range) const {
        return shadow_t(shadow, range) < shadow.end;
    }
    /// Its own leaf finds out, rightly or wrongly.
    bool blocks_itself(const Shadow&) const { return false; }
    /// Where the shadow ray first meets the range, before or behind the light; infinity: never.
    T shadow_t(const Shadow& shadow, PrimitiveRange range) const {
        T nearest = kInfinity;
        for_each_hit<true>(shadow.ray, range, [&](PrimitiveId id, const plain::Hit<T>& hit) {
            if (!store_.faces(id).cast_shadows) return;
            const bool self = shadow.from && *shadow.from == id;
            nearest = std::min(nearest, self ? other_root(shadow.ray, id) : hit.t);
        });
        return nearest;
    }

  private:
    // Calls `use(id, hit)` for each primitive of the range that the ray hits. What of a solid shape
    // is seen the ray enters; what a light sees a shadow ray leaves.
    template <bool kToLight, typename Use>
    void for_each_hit(const RayT<T>& ray, PrimitiveRange range, Use&& use) const {
        store_.for_each_run(
            range,
            [&](const Triangles& triangles, std::size_t index, PrimitiveRange run) {
                triangles.for_each_hit(
                    ray, index, index + (run.last - run.first),
                    [&](std::size_t i, const plain::Hit<T>& hit) {
                        const auto id = static_cast<PrimitiveId>(run.first + (i - index));
                        if (hit.front != kToLight || store_.faces(id).sides == Sides::kBoth)
                            use(id, hit);
                    });
            },
            [&](PrimitiveId id, const auto& primitive) {
                const plain::Met met = store_.faces(id).sides == Sides::kBoth ? plain::Met::kFirst
                                       : kToLight                             ? plain::Met::kExit
                                                                              : plain::Met::kEntry;
                if (const std::optional<plain::Hit<T>> hit = test(ray, primitive, met))
                    use(id, *hit);
            });
    }
    static std::optional<plain::Hit<T>> test(const RayT<T>& ray, const PlainSphere& p,
                                             plain::Met met) {
        return plain::hit(ray, p.center, p.radius, met);
    }
    static std::optional<plain::Hit<T>> test(const RayT<T>& ray, const PlainEllipsoid& p,
                                             plain::Met met) {
        return plain::hit(ray, p, met);
    }

    // [eq. 47]
    static Vec3<T> geometric_normal(const plain::Corners<T>& p, const Vec3<T>&) {
        return normalized(cross(p.b - p.a, p.c - p.a));
    }
    static Vec3<T> geometric_normal(const PlainSphere& p, const Vec3<T>& point) {
        return normalized(point - p.center);
    }
    static Vec3<T> geometric_normal(const PlainEllipsoid& p, const Vec3<T>& point) {
        // The inverse transpose of the linear part, applied to the local normal.
        const Vec3<T> local = p.local(point - p.center);
        return normalized(p.inverse[0] * local.x + p.inverse[1] * local.y + p.inverse[2] * local.z);
    }

    // A ray that starts on the primitive does not meet a triangle again, and a sphere at
    // -2 (f.d) / (d.d).
    T other_root(const RayT<T>& ray, PrimitiveId id) const {
        return store_.visit(id, [&](const auto& p) {
            using Kind = std::decay_t<decltype(p)>;
            if constexpr (std::is_same_v<Kind, PlainSphere>)
                return other_root(ray.origin - p.center, ray.direction);
            else if constexpr (std::is_same_v<Kind, PlainEllipsoid>)
                return other_root(p.local(ray.origin - p.center), p.local(ray.direction));
            else
                return kInfinity;
        });
    }
    static T other_root(const Vec3<T>& f, const Vec3<T>& d) {
        const T t = -2 * dot(f, d) / dot(d, d);
        return t > 0 ? t : kInfinity;
    }

    PrimitiveStore<Triangles, PlainSphere, PlainEllipsoid> store_;
    std::optional<double> bias_;
};

}  // namespace nuvo
