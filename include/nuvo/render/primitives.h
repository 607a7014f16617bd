#pragma once

#include <array>
#include <cstdint>

#include "nuvo/math/big_vector.h"
#include "nuvo/math/bounds.h"
#include "nuvo/render/profile.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// Place of a primitive (a sphere, an ellipsoid or one triangle of non-zero area) in document
/// order; of two hits at equal t the lower id wins.
using PrimitiveId = std::uint32_t;

/// The primitives of one leaf item.
struct PrimitiveRange {
    PrimitiveId first = 0;
    PrimitiveId last = 0;  ///< one past the end
};

/// Where a primitive comes from.
struct PrimitiveSource {
    std::uint32_t object = 0;    ///< index into Scene::objects
    std::uint32_t triangle = 0;  ///< index into the mesh's triangles; 0 for a sphere
};

enum class PrimitiveKind : std::uint8_t { kTriangle, kSphere, kEllipsoid };
inline PrimitiveKind kind_of(const Shape& shape) {
    if (std::holds_alternative<TriangleMesh>(shape)) return PrimitiveKind::kTriangle;
    return std::holds_alternative<Sphere>(shape) ? PrimitiveKind::kSphere
                                                 : PrimitiveKind::kEllipsoid;
}

/// All primitives of one kind.
struct KindSummary {
    std::size_t count = 0;
    Bounds3 box;  ///< around all
};

/// The scene flattened for tracing: primitives in document order, and the leaf items (single
/// primitives or whole shapes) that an octree distributes.
struct Primitives {
    BigVector<PrimitiveSource> sources;  ///< one per primitive
    BigVector<PrimitiveId>
        item_first;                 ///< item i holds primitives [item_first[i], item_first[i + 1])
    BigVector<Bounds3> item_boxes;  ///< one per item
    std::size_t zero_area_triangles = 0;  ///< left out: they can never be hit
    std::array<KindSummary, 3> kinds;     ///< by PrimitiveKind
    bool sorted_by_kind = true;           ///< none comes before one of a lower kind
    bool all_cast_shadows = true;

    std::size_t item_count() const { return item_boxes.size(); }
    PrimitiveRange of_item(std::size_t item) const {
        return {item_first[item], item_first[item + 1]};
    }
    const KindSummary& kind(PrimitiveKind kind) const {
        return kinds[static_cast<std::size_t>(kind)];
    }
    PrimitiveRange all() const { return {0, static_cast<PrimitiveId>(sources.size())}; }
};

/// Flattens `scene` with single primitives or whole shapes as leaf items. Up to `threads` share the
/// work on large meshes.
Primitives flatten(const Scene& scene, LeafContent leaves, int threads = 1);

}  // namespace nuvo
