#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fast/scene/ball_map.h"
#include "fast/scene/local_frame.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/bounds.h"
#include "nuvo/octree/compact_build.h"
#include "nuvo/octree/walk.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/primitives.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// A primitive's place: triangles first, in document order, then spheres, then ellipsoids, each in
/// an order of their own.
using Slot = std::uint32_t;
inline constexpr Slot kNoSlot = ~Slot{0};

/// Slots by places: those of a list, ascending; or, without one, each slot at its own place.
struct SlotList {
    const BigVector<Slot>* list = nullptr;
    Slot operator[](Slot place) const { return list ? (*list)[place] : place; }
};

/// A sphere or ellipsoid.
struct QuadricSlot {
    PrimitiveId id;
    Slot slot;
};
using QuadricSpan = std::span<const QuadricSlot>;

/// Asks for an object's first and last cache line. (As a call g++ would take it for one without
/// effects, and leave it out.)
[[gnu::always_inline]] inline void prefetch_object(const Object& object) {
    __builtin_prefetch(&object);
    __builtin_prefetch(reinterpret_cast<const char*>(&object + 1) - 1);
}

/// The scene sorted by kind, with its octree in the local frame: all that does not depend on camera
/// and lights.
class FastScene {
  public:
    /// No type: whichever CompactBuildOptions::rule finds.
    FastScene(const Scene& scene, const Primitives& primitives, std::optional<OctreeType> type,
              int threads, BackFaces back_faces = BackFaces::kSolid, Progress* progress = nullptr);

    const Scene& scene() const { return scene_; }
    const Primitives& primitives() const { return primitives_; }
    BackFaces back_faces() const { return back_faces_; }
    /// Whether the object's back faces are invisible.
    bool front_only(const Object& object) const {
        return object.solid && back_faces_ == BackFaces::kSolid;
    }
    /// Which of 16 triangles are of such objects: bit i is that of slots[i].
    std::uint32_t front_only(const Slot* slots) const {
        constexpr int kSlots = 16;
        std::uint32_t bits = 0;
        if (front_only_.empty()) return bits;
        for (int i = 0; i < kSlots; ++i)
            bits |= static_cast<std::uint32_t>(front_only_[slots[i] / 8] >> slots[i] % 8 & 1) << i;
        return bits;
    }
    const LocalFrame& frame() const { return frame_; }
    /// Around all primitives; world space.
    const Bounds3& box() const { return box_; }
    /// Of that box.
    double largest_coordinate() const { return largest_coordinate_; }
    /// Of a size at which no product of the local frame and a ray leaves the doubles; scenes of
    /// others are the serial tracer's.
    bool is_ordinary() const {
        return largest_coordinate_ == 0 || detail::is_ordinary(largest_coordinate_);
    }
    const CompactOctree& octree() const { return octree_; }
    /// Bounds |coordinate| in the octree's box, in the local frame; 1 for an empty scene.
    double reach() const { return reach_; }

    Slot triangle_end() const { return triangle_end_; }
    Slot sphere_end() const { return sphere_end_; }
    Slot slot_end() const { return slot_end_; }
    bool has_ellipsoids() const { return sphere_end_ != slot_end_; }
    /// Document order's name of the primitive.
    PrimitiveId id(Slot slot) const { return ids_.empty() ? slot : ids_[slot]; }
    const PrimitiveSource& source(Slot slot) const { return primitives_.sources[id(slot)]; }
    const Object& object(PrimitiveId id) const {
        return scene_.objects[primitives_.sources[id].object];
    }
    /// The mesh of a triangle.
    const TriangleMesh& mesh(const PrimitiveSource& triangle) const {
        return *std::get_if<TriangleMesh>(&scene_.objects[triangle.object].shape);
    }
    /// The triangle of that slot; world space.
    Triangle triangle(Slot slot) const {
        const PrimitiveSource& from = source(slot);
        return mesh(from).triangle(from.triangle);
    }
    /// In the local frame, rounded to nearest.
    LocalSphere local(const Sphere& sphere) const {
        return {Vec3<float>(frame_.local(sphere.center)),
                static_cast<float>(sphere.radius * frame_.scale)};
    }
    /// What tells these primitives, and how triangles lie, is on its way from memory.
    void prefetch(std::span<const Slot> slots) const;
    /// All spheres and ellipsoids in document order, in which the scene is read fastest.
    QuadricSpan quadrics() const { return quadrics_; }
    /// One a few places after one of quadrics(), if there is any; its object is prefetched.
    const QuadricSlot* prefetched_after(const QuadricSlot& quadric) const {
        constexpr std::ptrdiff_t kAhead = 12;
        if (quadrics_.data() + quadrics_.size() - &quadric <= kAhead) return nullptr;
        const QuadricSlot* const then = &quadric + kAhead;
        prefetch_object(object(then->id));
        return then;
    }
    /// Of the ellipsoid of that slot.
    const BallMap& ball(Slot slot) const { return balls_[slot - sphere_end_]; }
    /// Corners rounded to nearest, by slot.
    const BigVector<LocalTriangle>& triangles() const { return triangles_; }
    /// Without the octree.
    std::size_t memory_bytes() const {
        return vector_bytes(ids_) + vector_bytes(quadrics_) + vector_bytes(triangles_) +
               vector_bytes(balls_) + vector_bytes(front_only_);
    }

  private:
    void order_slots();
    void map_ellipsoids(int threads);

    const Scene& scene_;
    const Primitives& primitives_;
    BackFaces back_faces_;
    Bounds3 box_;
    LocalFrame frame_;
    double largest_coordinate_ = 0;
    Slot triangle_end_ = 0;
    Slot sphere_end_ = 0;
    Slot slot_end_ = 0;
    std::vector<PrimitiveId> ids_;  // empty: the same order
    BigVector<QuadricSlot> quadrics_;
    BigVector<BallMap> balls_;  // of slots from sphere_end_ on
    BigVector<LocalTriangle> triangles_;
    BigVector<std::uint8_t> front_only_;  // of triangles, 8 in a byte; empty: none
    CompactOctree octree_;
    double reach_ = 1;
};

}  // namespace nuvo
