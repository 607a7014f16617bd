#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "nuvo/geometry/predicates.h"
#include "nuvo/render/primitives.h"
#include "nuvo/render/profile.h"

namespace nuvo {

/// What is there of a surface.
struct Faces {
    Sides sides;        ///< to be seen
    bool cast_shadows;  ///< those that a light sees
};

/// Of a shape under that rule.
inline Sides sides_of(const Object& object, BackFaces back_faces) {
    return object.solid && back_faces == BackFaces::kSolid ? Sides::kFront : Sides::kBoth;
}

/// The scene itself as a store: nothing is copied, a triangle is put together when it is asked for.
class SceneStore {
  public:
    SceneStore(const Scene& scene, const Primitives& primitives, BackFaces back_faces)
        : scene_(scene), sources_(primitives.sources), back_faces_(back_faces) {}

    const PrimitiveSource& source(PrimitiveId id) const { return sources_[id]; }
    Faces faces(PrimitiveId id) const {
        return {sides_of(object(id), back_faces_), object(id).casts_shadow};
    }

    /// Calls `use` with the triangle, sphere or ellipsoid of that id, and what is there of it.
    template <typename Use>
    auto visit_faces(PrimitiveId id, Use&& use) const {
        const Faces there = faces(id);
        return visit(id, [&](const auto& primitive) { return use(primitive, there); });
    }
    template <typename Use>
    auto visit(PrimitiveId id, Use&& use) const {
        const PrimitiveSource& source = sources_[id];
        const Shape& shape = scene_.objects[source.object].shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
            const Triangle triangle = mesh->triangle(source.triangle);
            return use(triangle);
        }
        if (const auto* sphere = std::get_if<Sphere>(&shape)) return use(*sphere);
        return use(std::get<Ellipsoid>(shape));
    }

  private:
    const Object& object(PrimitiveId id) const { return scene_.objects[sources_[id].object]; }

    const Scene& scene_;
    const BigVector<PrimitiveSource>& sources_;
    BackFaces back_faces_;
};

/// The primitives' coordinates side by side, one array a kind, found by PrimitiveId. A kind that
/// the scene lacks costs nothing. TriangleList takes Triangles by push_back; the other two types
/// are made from Sphere and Ellipsoid.
template <typename TriangleList, typename SphereT, typename EllipsoidT>
class PrimitiveStore {
  public:
    PrimitiveStore(const Scene& scene, const Primitives& primitives, BackFaces back_faces,
                   TriangleList empty = {})
        : sources_(primitives.sources), triangles_(std::move(empty)) {
        slots_.reserve(sources_.size());
        if constexpr (std::is_same_v<TriangleList, std::vector<Triangle>>)
            triangles_.reserve(primitives.kind(PrimitiveKind::kTriangle).count);
        for (const PrimitiveSource& source : sources_) {
            const Object& object = scene.objects[source.object];
            add(object, source);
            if (sides_of(object, back_faces) == Sides::kFront) slots_.back() |= kFrontOnly;
            if (!object.casts_shadow) slots_.back() |= kShadowless;
        }
    }

    const PrimitiveSource& source(PrimitiveId id) const { return sources_[id]; }
    Faces faces(PrimitiveId id) const { return faces_of(slots_[id]); }
    std::size_t memory_bytes() const {
        const std::size_t others =
            vector_bytes(slots_) + vector_bytes(spheres_) + vector_bytes(ellipsoids_);
        if constexpr (requires { triangles_.memory_bytes(); })
            return others + triangles_.memory_bytes();
        else
            return others + vector_bytes(triangles_);
    }

    /// Calls `use` with the triangle, sphere or ellipsoid of that id, and what is there of it.
    template <typename Use>
    auto visit_faces(PrimitiveId id, Use&& use) const {
        const std::uint32_t slot = slots_[id];
        const std::uint32_t index = slot & kIndexMask;
        const Faces faces = faces_of(slot);
        if (slot < kSphere) return use(triangles_[index], faces);
        if (slot < kEllipsoid) return use(spheres_[index], faces);
        return use(ellipsoids_[index], faces);
    }
    template <typename Use>
    auto visit(PrimitiveId id, Use&& use) const {
        return visit_faces(id, [&](const auto& primitive, Faces) { return use(primitive); });
    }

    /// The range in order: `use_triangles(list, index, run)` for each run of triangles, which stand
    /// in the list from `index` on, and `use_other(id, primitive)` for each sphere and ellipsoid.
    template <typename UseTriangles, typename UseOther>
    void for_each_run(PrimitiveRange range, UseTriangles&& use_triangles,
                      UseOther&& use_other) const {
        for (PrimitiveId id = range.first; id < range.last;) {
            const std::uint32_t slot = slots_[id];
            if (slot < kSphere) {
                const PrimitiveId end = end_of_triangles(id, range.last);
                use_triangles(triangles_, slot & kIndexMask, PrimitiveRange{id, end});
                id = end;
            } else {
                if (slot < kEllipsoid)
                    use_other(id, spheres_[slot & kIndexMask]);
                else
                    use_other(id, ellipsoids_[slot & kIndexMask]);
                ++id;
            }
        }
    }

  private:
    PrimitiveId end_of_triangles(PrimitiveId id, PrimitiveId last) const {
        // All between two triangles are triangles if as many indices lie between them.
        if (slots_[last - 1] < kSphere && slots_[last - 1] - slots_[id] == last - 1 - id)
            return last;
        while (id < last && slots_[id] < kSphere) ++id;
        return id;
    }

    static Faces faces_of(std::uint32_t slot) {
        return {static_cast<Sides>(slot / kFrontOnly & 1), (slot & kShadowless) == 0};
    }

    // A slot is an index with its kind in the two highest bits, and what holds for its shape.
    static constexpr std::uint32_t kSphere = 1U << 30;
    static constexpr std::uint32_t kEllipsoid = 2U << 30;
    static constexpr std::uint32_t kFrontOnly = 1U << 29;
    static constexpr std::uint32_t kShadowless = 1U << 28;
    static constexpr std::uint32_t kIndexMask = kShadowless - 1;

    void add(const Object& object, const PrimitiveSource& source) {
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            slots_.push_back(static_cast<std::uint32_t>(triangles_.size()));
            triangles_.push_back(mesh->triangle(source.triangle));
        } else if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
            slots_.push_back(kSphere | static_cast<std::uint32_t>(spheres_.size()));
            spheres_.push_back(SphereT(*sphere));
        } else {
            slots_.push_back(kEllipsoid | static_cast<std::uint32_t>(ellipsoids_.size()));
            ellipsoids_.push_back(EllipsoidT(std::get<Ellipsoid>(object.shape)));
        }
    }

    const BigVector<PrimitiveSource>& sources_;
    std::vector<std::uint32_t> slots_;
    TriangleList triangles_;
    std::vector<SphereT> spheres_;
    std::vector<EllipsoidT> ellipsoids_;
};

}  // namespace nuvo
