#pragma once

#include <cstdint>
#include <vector>

#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "fast/shadow/light_buffer.h"
#include "fast/shadow/shadow_geometry.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// The sign of n.P + w is sure beyond so many roundings of P, and beyond P's own error.
/// [numerics: shadow planes]
inline constexpr float kPlaneError = 24 * kFloatRoundoff;

/// In units of |P|, or of a quadric's |centre| or radius: center and point rounded and subtracted
/// (6), the vector to the nearest point of the line (12) at a parameter that is itself rounded
/// (20), its square and the radius (13), the direction to the light, which carries the roundings of
/// both its ends (35).
inline constexpr float kQuadricError = 128 * kFloatRoundoff;

struct ShadowTable {
    explicit ShadowTable(const LightPoint& from) : light(from) {}

    LightPoint light;
    std::size_t first_plane = 0;         ///< where its planes begin among those of all lights
    BigVector<std::uint8_t> hides;       ///< which triangles may hide something: 8 in a byte
    BigVector<LightSide> quadric_sides;  ///< of slots from triangle_end on; empty: all outside
    LightBuffer buffer;
};

/// What the shadow stage needs of scene and lights, shared by all threads.
class ShadowTables {
  public:
    ShadowTables(const FastScene& scene, InstructionSet isa, int threads = 1,
                 TableFilling filling = TableFilling::kNow);

    /// For fill_tables(); by several threads at a time.
    void take(const TriangleChunk& chunk);
    void take_quadrics(QuadricSpan quadrics);
    void finish();

    /// Whether the item may hide something from light i. The planes of others are not there.
    bool hides(std::size_t light, Slot slot) const {
        return slot >= scene_.triangle_end() ||
               (tables_[light].hides[slot / 8] >> slot % 8 & 1) != 0;
    }

    const FastScene& scene() const { return scene_; }
    /// Of light i; empty where it casts no shadow.
    const ShadowTable& table(std::size_t light) const { return tables_[light]; }
    /// Of light i, by slot; none where it casts no shadow.
    const ShadowPlanes* planes(std::size_t light) const {
        return planes_.data() + tables_[light].first_plane;
    }
    const Quadric& quadric(Slot slot) const { return quadrics_[slot - scene_.triangle_end()]; }
    bool has_rounds() const { return !quadrics_.empty(); }

    /// Bounds |n.P + w - the true function at SurfacePoint::point|, evaluated in float, but for
    /// what P's own error (on each axis) and kPlaneError times |P| or `dense`, whichever is larger,
    /// add; and a lit point's SurfacePoint::error.
    float plane_error() const { return plane_error_; }
    /// LocalFrame::dense.
    float dense() const { return dense_; }
    /// Within this of a quadric the exact test may count it as touched.
    float quadric_touch() const { return quadric_touch_; }
    /// Bounds how far a float segment from point to light lies from the true one within the scene,
    /// but for twice P's own error; with that margin.
    float quadric_error() const { return quadric_error_; }

    std::size_t memory_bytes() const;

  private:
    /// Whether the light is a direction or stands where the scene surely does not reach.
    bool outside_of_all(const LightPoint& light) const;
    Quadric quadric_of(const Shape& shape) const;
    LightSide side(const LightPoint& light, const Quadric& shape, const Object& object) const;

    const FastScene& scene_;
    InstructionSet isa_;
    int threads_;
    double reach_;  // largest |coordinate| of the scene's box in the local frame
    double touch_;  // bounds SurfacePoint::error, in the local frame
    float dense_;
    float plane_error_;
    float quadric_touch_;
    float quadric_error_;
    BigVector<Quadric> quadrics_;
    std::vector<ShadowTable> tables_;
    BigVector<ShadowPlanes> planes_;
};

}  // namespace nuvo
