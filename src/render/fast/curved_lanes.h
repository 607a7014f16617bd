// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_CURVED_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_CURVED_LANES_H_
#undef NUVO_RENDER_FAST_CURVED_LANES_H_
#else
#define NUVO_RENDER_FAST_CURVED_LANES_H_
#endif

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "fast/lanes.h"
#include "fast/shading.h"
#include "fast/vector_math.h"

// Surfaces whose normal or color varies within the primitive: for each primitive that a block
// shows, its functions of the pixel are set up once, in double, and evaluated for all 16 lanes. The
// vectors f x d (sphere) and the edge functions (triangle) are affine in the pixel, so a lane costs
// a few operations, whose errors stay far below half a unit of a float; then one rounding.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The ray directions of a block's lanes.
class BlockDirections {
  public:
    HWY_INLINE BlockDirections(const ShadingTables& tables, const Tile& tile, int b)
        : tables_(tables),
          first_(
              tables.camera.direction(tables.camera.center_x(tile.x + lane_x(b * kBlockLanes)),
                                      tables.camera.center_y(tile.y + lane_y(b * kBlockLanes)))) {}

    /// Of the block's first lane.
    const Vector3& first() const { return first_; }
    /// Within ShadingBounds::direction_error, all axes together.
    HWY_INLINE Floats at(int axis) const {
        return Floats(static_cast<float>(first_[axis])) +
               Floats::load(tables_.lane_direction[axis]);
    }

  private:
    const ShadingTables& tables_;
    Vector3 first_;
};

/// The steps of a block's lanes to the right and down.
inline constexpr std::array<double, 16> kStepsRight{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
inline constexpr std::array<double, 16> kStepsDown{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// first + right * (steps right) + down * (steps down).
HWY_INLINE Doubles affine(double first, double right, double down) {
    return mul_add(Doubles::load(kStepsRight.data()), Doubles(right),
                   mul_add(Doubles::load(kStepsDown.data()), Doubles(down), Doubles(first)));
}

struct Doubles3 {
    HWY_INLINE Doubles dot(const Doubles3& other) const {
        return mul_add(axis[0], other.axis[0],
                       mul_add(axis[1], other.axis[1], axis[2] * other.axis[2]));
    }
    Doubles axis[3];
};

// From an estimate in float one step of Newton's, which squares its error and adds a few
// roundings: within kNewtonError.
inline constexpr double kNewtonError = 0x1p-40;
HWY_INLINE Doubles precise_reciprocal(const Doubles& v) {
    const Doubles e = doubles_from(reciprocal(floats_from(v)));
    return e * neg_mul_add(v, e, Doubles(2.0));
}
HWY_INLINE Doubles precise_inverse_sqrt(const Doubles& v) {
    const Doubles e = doubles_from(inverse_sqrt(floats_from(v)));
    return e * neg_mul_add(v * Doubles(0.5), e * e, Doubles(1.5));
}

/// Bounds the error of normals of unit length that leave less than half a unit before their only
/// rounding.
inline constexpr float kCurvedNormalError = 2 * kUnit;

/// Fills lanes of one block.
class CurvedLanes {
  public:
    CurvedLanes(const ShadingTables& tables, Tile& tile, ShadingScratch& scratch,
                const BlockDirections& directions, int b)
        : tables_(tables),
          scene_(tables.scene),
          tile_(tile),
          scratch_(scratch),
          first_(b * kBlockLanes),
          directions_(directions),
          block_(b) {}

    HWY_NOINLINE void fill(std::uint32_t lanes) {
        const Ints slots = Ints::load(reinterpret_cast<const std::int32_t*>(tile_.slot) + first_);
        while (lanes != 0) {
            const Slot slot = tile_.slot[first_ + std::countr_zero(lanes)];
            const std::uint32_t same =
                (slots == Ints(static_cast<std::int32_t>(slot))).bits() & lanes;
            lanes &= ~same;
            const PrimitiveSource& source = scene_.source(slot);
            const Object& object = scene_.scene().objects[source.object];
            lanes_ = RayMask::from_bits(same);
            bits_ = same;
            if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
                fill_triangle(*mesh, source.triangle, object.solid);
                continue;
            }
            if (!tables_.uniform) {
                const SurfaceWord word = tables_.material_words[object.material];
                Ints(static_cast<std::int32_t>(word))
                    .store(reinterpret_cast<std::int32_t*>(scratch_.word) + first_,
                           mask_for<std::int32_t>(lanes_));
            }
            if (const auto* sphere = std::get_if<Sphere>(&object.shape))
                fill_sphere(*sphere, object.solid);
            else
                fill_ellipsoid(object.solid);
        }
    }

  private:
    static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    static double norm1(const Vector3& v) {
        return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
    }
    HWY_INLINE Doubles affine_dot(const Vector3& v) const {
        return affine(dot(v, directions_.first()), dot(v, tables_.camera.right),
                      dot(v, tables_.camera.down));
    }
    HWY_INLINE Doubles3 affine_cross(const Vector3& v) const {
        const Vector3 first = cross(v, directions_.first());
        const Vector3 right = cross(v, tables_.camera.right);
        const Vector3 down = cross(v, tables_.camera.down);
        Doubles3 out;
        for (int i = 0; i < 3; ++i) out.axis[i] = affine(first[i], right[i], down[i]);
        return out;
    }
    HWY_INLINE Doubles3 direction() const {
        const Vector3& first = directions_.first();
        Doubles3 out;
        for (int i = 0; i < 3; ++i)
            out.axis[i] = affine(first[i], tables_.camera.right[i], tables_.camera.down[i]);
        return out;
    }

    // The lanes that are not `known` get NaN, and the referee.
    HWY_INLINE void store_normal(const Floats (&n)[3], const RayMask& known, const Floats& error) {
        for (int i = 0; i < 3; ++i)
            select(known, n[i], Floats(kNan)).store(tile_.normal[i] + first_, lanes_);
        error.store(scratch_.normal_error + first_, lanes_);
        give_up(without(lanes_, known));
        scratch_.curved[block_] = static_cast<std::uint16_t>(scratch_.curved[block_] | bits_);
    }
    HWY_INLINE void give_up(const RayMask& lanes) {
        Floats(kInfinity).store(scratch_.diffuse_error + first_, lanes);
    }
    HWY_INLINE void store_point(const Floats (&p)[3], const RayMask& known) {
        const RayMask stored = lanes_ & known;
        for (int i = 0; i < 3; ++i) p[i].store(tile_.point[i] + first_, stored);
        Floats(tables_.bounds.curved_point_error).store(tile_.point_error + first_, stored);
    }

    // m = f x d / r with f from the centre to the camera; the unit normal is (d x m -+ s d) / d.d
    // with s^2 = d.d - m.m. (Haines et al. 2019, "Precision improvements for ray/sphere
    // intersection".) The error of m is below q |d|, that of s below 2 q d.d / s; the normal's is
    // small enough where s > 2^28 q |d|.
    HWY_INLINE void fill_sphere(const Sphere& sphere, bool solid) {
        constexpr double kCrossError = 0x1p-49;  // 8 roundings of f x d
        constexpr double kMostOfHalfUnit = 0x1p28;
        constexpr double kSideError = 0x1p-48;
        const Vector3 f = (scene_.scene().camera.position - sphere.center) / sphere.radius;
        const double square = dot(f, f);
        const bool inside = square < 1;
        const bool sure = std::fabs(square - 1) > kSideError * (square + 1);
        const double q = kCrossError * (1 + norm1(f));
        const Doubles3 d = direction();
        const Doubles3 m = affine_cross(f);
        const Doubles dd = d.dot(d);
        const Doubles rest = dd - m.dot(m);
        const Floats estimate = sqrt(floats_from(rest));
        const Doubles e = doubles_from(estimate);
        const Doubles half = doubles_from(Floats(0.5F) / estimate);
        Doubles s = mul_add(neg_mul_add(e, e, rest), half, e);
        const float least = static_cast<float>(
            kMostOfHalfUnit * q * static_cast<double>(tables_.bounds.direction_longest));
        const RayMask known = estimate > Floats(sure ? least : kInfinity);
        if (inside) s = -s;
        Doubles scale = precise_reciprocal(dd);
        const LocalFrame& frame = scene_.frame();
        const Point3 center = frame.local(sphere.center);
        const double radius = sphere.radius * frame.scale;
        Floats normal[3];
        Floats point[3];
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            const int last = (i + 2) % 3;
            const Doubles across =
                neg_mul_add(d.axis[last], m.axis[next], d.axis[next] * m.axis[last]);
            const Doubles n = neg_mul_add(s, d.axis[i], across) * scale;
            point[i] = floats_from(mul_add(n, Doubles(radius), Doubles(center[i])));
            normal[i] = floats_from(n);
            if (inside && !solid) normal[i] = -normal[i];
        }
        store_normal(normal, known, Floats(kCurvedNormalError));
        store_point(point, known);
    }

    // The primary stage has its normal from the referee.
    HWY_INLINE void fill_ellipsoid(bool solid) {
        constexpr float kRootOf3 = 1.7320509F;  // rounded up
        Floats normal[3];
        Floats along(0.0F);
        for (int i = 0; i < 3; ++i) {
            normal[i] = Floats::load(tile_.round_normal[i] + first_);
            along = mul_add(normal[i], directions_.at(i), along);
        }
        const Floats error = Floats::load(tile_.round_error + first_) * Floats(kRootOf3);
        RayMask known = lanes_;
        if (!solid) {
            const float longest = tables_.bounds.direction_longest;
            known = abs(along) > mul_add(error, Floats(longest), Floats(8 * kUnit * longest));
            for (Floats& n : normal) n = select(along > Floats(0.0F), -n, n);
        }
        store_normal(normal, known, error);
    }

    // Weights V / S and W / S as surface_point() has them. Below 2^-49 of its magnitudes a triple
    // product is noise; where S is 2^29 times that, the weights are within 2^-29.
    HWY_INLINE void fill_triangle(const TriangleMesh& mesh, std::uint32_t index, bool solid) {
        constexpr double kTripleError = 0x1p-49;
        constexpr double kWeightDigits = 0x1p29;
        const Triangle t = mesh.triangle(index);
        const double scale = scene_.frame().scale;
        const Vector3 from = (t.a - scene_.scene().camera.position) * scale;
        const Vector3 e1 = (t.b - t.a) * scale;
        const Vector3 e2 = (t.c - t.a) * scale;
        const Doubles s = affine_dot(cross(e2, e1));
        const Doubles inverse = precise_reciprocal(s);
        const Doubles x = affine_dot(cross(from, e2)) * inverse;
        const Doubles y = affine_dot(cross(e1, from)) * inverse;
        const double edges = norm1(e1) + norm1(e2);
        const double noise = kTripleError * (norm1(from) + edges) * edges *
                             static_cast<double>(tables_.bounds.direction_longest);
        const Floats determinant = floats_from(s);
        const RayMask known = abs(determinant) > Floats(static_cast<float>(kWeightDigits * noise) +
                                                        std::numeric_limits<float>::min());
        if (!mesh.colors.empty()) fill_color(mesh, index, x, y, known);
        if (mesh.normals.empty()) return;
        const Point3 a = scene_.frame().local(t.a);
        Floats point[3];
        for (int i = 0; i < 3; ++i)
            point[i] =
                floats_from(mul_add(x, Doubles(e1[i]), mul_add(y, Doubles(e2[i]), Doubles(a[i]))));
        store_point(point, known);
        fill_smooth_normal(mesh, index, x, y, known, solid ? Floats(1.0F) : determinant);
    }

    // Normals at the corners are at most 1 long on each axis here; from their blend's length
    // upwards of 1/4 its error stays small. `facing` is negative where the normal has to turn.
    HWY_INLINE void fill_smooth_normal(const TriangleMesh& mesh, std::uint32_t index,
                                       const Doubles& x, const Doubles& y, const RayMask& known,
                                       const Floats& facing) {
        constexpr float kLeastSquare = 0x1p-4F;
        const IndexTriple& corner =
            (mesh.normal_triangles.empty() ? mesh.triangles : mesh.normal_triangles)[index];
        const Vector3& n0 = mesh.normals[corner[0]];
        const Vector3& n1 = mesh.normals[corner[1]];
        const Vector3& n2 = mesh.normals[corner[2]];
        const double longest = std::fmax(max_norm(n0), std::fmax(max_norm(n1), max_norm(n2)));
        const double factor = 1 / longest;  // NaN ends where floats give up, too
        const Doubles3 n = blend(n0 * factor, n1 * factor, n2 * factor, x, y);
        const Doubles square = n.dot(n);
        const Doubles inverse = precise_inverse_sqrt(square);
        Floats normal[3];
        for (int i = 0; i < 3; ++i) {
            const Floats unit = floats_from(n.axis[i] * inverse);
            normal[i] = select(facing < Floats(0.0F), -unit, unit);
        }
        store_normal(normal, known & (floats_from(square) > Floats(kLeastSquare)),
                     Floats(kCurvedNormalError));
    }

    HWY_INLINE void fill_color(const TriangleMesh& mesh, std::uint32_t index, const Doubles& x,
                               const Doubles& y, const RayMask& known) {
        constexpr double kFullByte = 255;
        const IndexTriple& corner =
            (mesh.color_triangles.empty() ? mesh.triangles : mesh.color_triangles)[index];
        const Doubles3 color =
            blend(mesh.colors[corner[0]] * kFullByte, mesh.colors[corner[1]] * kFullByte,
                  mesh.colors[corner[2]] * kFullByte, x, y);
        for (int c = 0; c < 3; ++c)
            floats_from(color.axis[c]).store(scratch_.color[c] + first_, lanes_);
        give_up(without(lanes_, known));
        scratch_.colored[block_] = static_cast<std::uint16_t>(scratch_.colored[block_] | bits_);
    }

    static HWY_INLINE Doubles3 blend(const Vector3& v0, const Vector3& v1, const Vector3& v2,
                                     const Doubles& x, const Doubles& y) {
        Doubles3 out;
        for (int i = 0; i < 3; ++i)
            out.axis[i] = mul_add(x, Doubles(v1[i] - v0[i]),
                                  mul_add(y, Doubles(v2[i] - v0[i]), Doubles(v0[i])));
        return out;
    }

    const ShadingTables& tables_;
    const FastScene& scene_;
    Tile& tile_;
    ShadingScratch& scratch_;
    int first_;
    const BlockDirections& directions_;
    int block_;
    RayMask lanes_;
    std::uint32_t bits_ = 0;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_CURVED_LANES_H_
