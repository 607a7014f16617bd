#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "fast/light/light_buffer.h"
#include "fast/light/light_point.h"
#include "fast/light/shadow_planes.h"
#include "fast/light/wanted_depths.h"
#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// The sign of n.P + w is sure beyond so many roundings of P, and beyond P's own error.
/// [numerics: shadow planes]
inline constexpr float kPlaneError = roundings(24);

/// In units of |P|, or of a quadric's |centre| or radius: center and point rounded and subtracted
/// (6), the vector to the nearest point of the line (12) at a parameter that is itself rounded
/// (20), its square and the radius (13), the direction to the light, which carries the roundings of
/// both its ends (35).
inline constexpr float kQuadricError = roundings(128);

/// What a light needs: of all items, each at the place of its slot, or of those that may stand
/// before a wanted point, in a list.
struct ShadowTable {
    explicit ShadowTable(const LightPoint& from) : light(from) {}

    /// Of all items.
    bool complete() const { return !wanted; }
    SlotList list() const { return complete() ? SlotList{} : SlotList{&slots}; }
    Slot slot(Slot place) const { return complete() ? place : slots[place]; }
    /// Makes room for so many; none hides anything yet.
    void hold_triangles(Slot count);

    LightPoint light;
    std::optional<WantedDepths> wanted;  ///< before whose points these may stand; none: all items
    BigVector<Slot> slots;               ///< by place, ascending; unless complete
    Slot triangles = 0;                  ///< the places of triangles end here
    BigVector<ShadowPlanes> planes;      ///< by place
    BigVector<std::uint8_t> hides;  ///< by place: which triangles may hide something, 8 in a byte;
                                    ///< the planes of others are not there
    BigVector<LightSide> quadric_sides;  ///< of slots from triangle_end on; empty: all outside
    LightBuffer buffer;
};

/// Lights [first, last) of a scene.
struct LightRange {
    std::size_t first;
    std::size_t last;

    bool has(std::size_t light) const { return first <= light && light < last; }
};

/// What the shadow stage needs of scene and lights, shared by all threads.
class ShadowTables {
  public:
    /// Of what may stand before the wanted points of each light; of all where these are not given.
    explicit ShadowTables(const FastScene& scene, InstructionSet isa, int threads = 1,
                          std::vector<std::optional<WantedDepths>> wanted = {})
        : ShadowTables(scene, isa, threads, std::move(wanted), {0, scene.scene().lights.size()}) {}
    /// Of some lights.
    ShadowTables(const FastScene& scene, InstructionSet isa, int threads,
                 std::vector<std::optional<WantedDepths>> wanted, LightRange lights);

    const FastScene& scene() const { return scene_; }
    InstructionSet isa() const { return isa_; }
    /// Of light i; empty where it casts no shadow or is none of these.
    const ShadowTable& table(std::size_t light) const { return tables_[light]; }
    const LocalSphere& quadric(Slot slot) const { return quadrics_[slot - scene_.triangle_end()]; }
    bool has_quadrics() const { return !quadrics_.empty(); }
    /// Whether points that were not wanted can be looked up, too.
    bool complete() const;

    /// Bounds |n.P + w - the true function at SurfacePoint::point|, evaluated in float, but for
    /// what P's own error (on each axis) and kPlaneError times |P| or `dense`, whichever is larger,
    /// add; and a lit point's SurfacePoint::error.
    float plane_error() const { return plane_error_; }
    /// LocalFrame::dense.
    float dense() const { return dense_; }
    /// Within this of a quadric the exact test may count it as touched.
    float quadric_touch() const { return quadric_touch_; }

    std::size_t memory_bytes() const;

  private:
    bool serves(std::size_t light) const {
        return lights_.has(light) && scene_.scene().lights[light].casts_shadow;
    }
    void make_tables();
    void take_quadrics(QuadricSpan quadrics);
    void make_planes_of_all();
    void list_wanted(ShadowTable& table, std::size_t light, WantedDepths wanted);
    void fill_buffer(ShadowTable& table) const;
    LightItems items() const { return {scene_, quadrics_, quadric_touch_}; }
    void make_planes(ShadowTable& table, std::size_t light, const TriangleChunk& chunk) const;
    static void forget_outside(ShadowTable& table);
    /// Whether the light is a direction or stands where the scene surely does not reach.
    bool outside_of_all(const LightPoint& light) const;
    LocalSphere quadric_of(const QuadricSlot& quadric) const;
    LightSide side(const LightPoint& light, const LocalSphere& shape, const Object& object) const;

    const FastScene& scene_;
    InstructionSet isa_;
    int threads_;
    LightRange lights_;
    double touch_;  // bounds SurfacePoint::error, in the local frame
    float dense_;
    float plane_error_;
    float quadric_touch_;
    BigVector<LocalSphere> quadrics_;
    std::vector<ShadowTable> tables_;
};

}  // namespace nuvo
