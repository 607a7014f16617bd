#pragma once

#include <cstdint>
#include <vector>

#include "nuvo/math/bounds.h"
#include "nuvo/octree/compact_build.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/primitives.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// The frame in which floats are good for the scene: moved so that its box lies around 0 and scaled
/// by a power of two so that it is about 1 wide.
struct LocalFrame {
    Point3 center;
    double scale = 1;  ///< a power of two

    /// Three roundings at most: of the difference, in units of the larger operand; none of the
    /// product unless it is subnormal.
    Point3 local(const Point3& p) const { return (p - center) * scale; }
    Vector3 local_direction(const Vector3& d) const { return d * scale; }
};

/// Index of a primitive by kind: triangles first, in document order, then spheres, then ellipsoids,
/// near ones near each other where there are many.
using Slot = std::uint32_t;
inline constexpr Slot kNoSlot = ~Slot{0};

/// The scene sorted by kind, with its octree in the local frame: all that does not depend on camera
/// and lights.
class FastScene {
  public:
    FastScene(const Scene& scene, const Primitives& primitives, OctreeType type, int threads);

    const Scene& scene() const { return scene_; }
    const Primitives& primitives() const { return primitives_; }
    const LocalFrame& frame() const { return frame_; }
    const CompactOctree& octree() const { return octree_; }
    /// Another one; `overlaps` of the options is filled in.
    CompactOctree octree(CompactBuildOptions options) const;

    Slot triangle_end() const { return triangle_end_; }
    Slot sphere_end() const { return sphere_end_; }
    Slot slot_end() const { return slot_end_; }
    /// Document order's name of the primitive.
    PrimitiveId id(Slot slot) const { return ids_.empty() ? slot : ids_[slot]; }
    const PrimitiveSource& source(Slot slot) const { return primitives_.sources[id(slot)]; }
    /// A sphere or ellipsoid.
    struct Round {
        PrimitiveId id;
        Slot slot;
    };
    /// All of them in document order, in which the scene is read fastest.
    const std::vector<Round>& rounds() const { return rounds_; }

  private:
    void order_slots();

    const Scene& scene_;
    const Primitives& primitives_;
    LocalFrame frame_;
    Slot triangle_end_ = 0;
    Slot sphere_end_ = 0;
    Slot slot_end_ = 0;
    std::vector<PrimitiveId> ids_;  // empty: the same order
    std::vector<Round> rounds_;
    CompactOctree octree_;
};

}  // namespace nuvo
