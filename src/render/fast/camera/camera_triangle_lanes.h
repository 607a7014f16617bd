// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#undef NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#else
#define NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#endif

#include <limits>

#include "fast/camera/camera_tables.h"
#include "fast/scene/triangle_chunk.h"
#include "fast/simd/wide_vectors.h"
#include "nuvo/math/error_bounds.h"

// Against one triangle the edge functions of all pixels are affine in the pixel's coordinates
// (Olano and Greer 1997, "Triangle scan conversion using 2D homogeneous coordinates"), and so is
// the inverse of t: a test of 16 rays is a handful of multiply-adds.
//
// u, v, w are the triple products of the ray's direction with the planes through the eye and an
// edge, turned so that they are positive where the line enters at t > 0; with K = n.(a - eye),
// t = K / (u + v + w) and u + v + w = n.d. Eight triangles at a time, in double.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class TriangleMaker {
  public:
    explicit TriangleMaker(const CameraRays& camera)
        : right_(wide(camera.right)),
          down_(wide(camera.down)),
          forward_(wide(camera.forward)),
          eye_(wide(camera.eye)),
          scale_(camera.scale),
          extent_(camera) {}

    /// Which of a batch's triangles double arithmetic cannot tell, and which of the others turn a
    /// back to the eye that nobody sees; where all do so nothing is made of them.
    struct Found {
        std::uint32_t unknown;
        std::uint32_t back_facing;
    };
    HWY_INLINE Found make(const TriangleBatch& batch, CameraTriangle* out, std::size_t count) {
        const Wide3 p = load_wide(batch.corner);
        const Wide3 q = load_wide(batch.corner + 3);
        const Wide3 r = load_wide(batch.corner + 6);
        const Wide3 a = (p - eye_) * scale_;
        const Wide3 b = (q - eye_) * scale_;
        const Wide3 c = (r - eye_) * scale_;
        const Wide3 bc = (r - q) * scale_;
        const Wide3 ca = (p - r) * scale_;
        const Wide3 ab = (q - p) * scale_;
        const Wide3 normal = cross(ca, ab);
        const Wide constant = dot(normal, a);
        const Wide edge = max(max_norm(ab), max_norm(ca)) + max_norm(bc);
        const Wide reach = max(max_norm(a), max(max_norm(b), max_norm(c)));
        // Each component of an edge plane has two products of three roundings and a difference; the
        // direction's own roundings and its unit length in the exact ray add 12 more.
        const Wide direction(extent_.direction);
        const Wide relative(2 * gamma(32));
        // And what its products lose below the normal range.
        const Wide normal_error = relative * edge * edge + Wide(8 * kUnderflow);
        const Wide inverse = Wide(1.0) / constant;
        const Wide sign = select(constant > Wide(0.0), Wide(1.0), Wide(-1.0));
        const Wide edge_error = relative * edge * reach * direction;
        // The relative error of K.
        const Wide share = Wide(3.0) * normal_error * reach * abs(inverse);
        const Wide3 inverse_plane = normal * inverse;
        const Wide size = bound(inverse_plane);
        // Infinite or NaN: floats cannot tell.
        known_ = (share < Wide(0.25)) & (size < Wide(kLargest)) & (edge_error < Wide(kLargest));
        const std::uint32_t there = (1U << count) - 1;
        // Where K is known it has the sign of the exact one.
        const Found found{~known_.bits() & there,
                          (known_ & (constant > Wide(0.0))).bits() & batch.front_only & there};
        if (found.back_facing == there) return found;
        put_edge(0, cross(b, bc) * sign, edge_error);
        put_edge(1, cross(c, ca) * sign, edge_error);
        put_edge(2, cross(a, ab) * sign, edge_error);
        put(3, inverse_plane, normal_error * direction * abs(inverse), Wide(2.0) * share);
        static_assert(sizeof(CameraTriangle) == 16 * sizeof(float));
        columns_.write(out->a, count);
        return found;
    }

  private:
    static constexpr double kLargest = 0x1p120;

    // Bounds the function over the picture.
    HWY_INLINE Wide bound(const Wide3& plane) const {
        return abs(dot(plane, right_)) * Wide(extent_.x) +
               abs(dot(plane, down_)) * Wide(extent_.y) + abs(dot(plane, forward_));
    }
    // An edge's function is made about 1 at most in the picture: the three share one bound, which
    // would else be that of the farthest edge.
    HWY_INLINE void put_edge(std::size_t i, const Wide3& plane, const Wide& error) {
        constexpr double kSmallest = 0x1p-500;
        const Wide size = bound(plane);
        const Wide factor = select(size > Wide(kSmallest), Wide(1.0) / size, Wide(1.0));
        put(i, plane * factor, error * factor, Wide(0.0));
    }
    // One function with its bound: `error` is that of the double stage.
    HWY_INLINE void put(std::size_t i, const Wide3& plane, const Wide& error,
                        const Wide& relative) {
        const Wide zero(0.0);
        store_rounded(select(known_, dot(plane, right_), zero), columns_.at[0][i]);
        store_rounded(select(known_, dot(plane, down_), zero), columns_.at[1][i]);
        store_rounded(select(known_, dot(plane, forward_), zero), columns_.at[2][i]);
        const Wide whole = error + bound(plane) * (relative + Wide(roundings(kCameraRoundings)));
        const Wide up = whole * Wide(1 + roundings(2)) + Wide(kFloatUnderflow);
        store_rounded(select(known_, up, Wide(std::numeric_limits<double>::infinity())),
                      columns_.at[3][i]);
    }

    Wide3 right_, down_, forward_, eye_;
    Wide scale_;
    CameraExtent extent_;
    Wide::Mask known_;
    RecordColumns columns_;  // a, b, c, e of u, v, w, q
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
