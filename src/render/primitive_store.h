#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "nuvo/render/primitives.h"

namespace nuvo {

/// A triangle's corners in single precision.
struct TriangleF {
    Vec3<float> a;
    Vec3<float> b;
    Vec3<float> c;
};

/// The primitives' coordinates side by side, one array a kind, found by PrimitiveId. A kind that
/// the scene lacks costs nothing. T is the precision the triangles are kept in.
template <typename T>
class PrimitiveStore {
    using StoredTriangle = std::conditional_t<std::is_same_v<T, double>, Triangle, TriangleF>;

  public:
    PrimitiveStore(const Scene& scene, const Primitives& primitives)
        : sources_(primitives.sources) {
        slots_.reserve(sources_.size());
        for (const PrimitiveSource& source : sources_) add(scene.objects[source.object], source);
    }

    const PrimitiveSource& source(PrimitiveId id) const { return sources_[id]; }

    /// Calls `use` with the triangle, Sphere or Ellipsoid of that id.
    template <typename Use>
    auto visit(PrimitiveId id, Use&& use) const {
        const std::uint32_t slot = slots_[id];
        const std::uint32_t index = slot & kIndexMask;
        if (slot < kSphere) return use(triangles_[index]);
        if (slot < kEllipsoid) return use(spheres_[index]);
        return use(ellipsoids_[index]);
    }

  private:
    // A slot is an index with its kind in the two highest bits.
    static constexpr std::uint32_t kSphere = 1U << 30;
    static constexpr std::uint32_t kEllipsoid = 2U << 30;
    static constexpr std::uint32_t kIndexMask = kSphere - 1;

    void add(const Object& object, const PrimitiveSource& source) {
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            const Triangle triangle = mesh->triangle(source.triangle);
            slots_.push_back(static_cast<std::uint32_t>(triangles_.size()));
            if constexpr (std::is_same_v<T, double>)
                triangles_.push_back(triangle);
            else
                triangles_.push_back(
                    {Vec3<float>(triangle.a), Vec3<float>(triangle.b), Vec3<float>(triangle.c)});
        } else if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
            slots_.push_back(kSphere | static_cast<std::uint32_t>(spheres_.size()));
            spheres_.push_back(*sphere);
        } else {
            slots_.push_back(kEllipsoid | static_cast<std::uint32_t>(ellipsoids_.size()));
            ellipsoids_.push_back(std::get<Ellipsoid>(object.shape));
        }
    }

    const std::vector<PrimitiveSource>& sources_;
    std::vector<std::uint32_t> slots_;
    std::vector<StoredTriangle> triangles_;
    std::vector<Sphere> spheres_;
    std::vector<Ellipsoid> ellipsoids_;
};

}  // namespace nuvo
