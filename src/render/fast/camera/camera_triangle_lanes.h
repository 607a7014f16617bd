// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#undef NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#else
#define NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
#endif

#include "fast/camera/camera_tables.h"
#include "fast/scene/triangle_chunk.h"
#include "fast/simd/wide_vectors.h"
#include "nuvo/math/error_bounds.h"

// Against one triangle the edge functions of all pixels are affine in the pixel's coordinates
// (Olano and Greer 1997, "Triangle scan conversion using 2D homogeneous coordinates"), and so is q:
// a test of 16 rays is a handful of multiply-adds.
//
// u, v, w are those of the planes through the eye and an edge, turned so that they are positive
// where the line enters. In perspective they are triple products of the ray's direction; with K =
// n.(a - eye), t = K / (u + v + w) and u + v + w = n.d. In a parallel projection the way from the
// eye to every corner is forward, K = n.forward, and a plane's function is n.(P - p) at the points
// P = anchor + offset and p of the plane; n.(P - a) / K is q. Eight triangles at a time, in double.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class TriangleMaker {
  public:
    explicit TriangleMaker(const CameraRays& camera)
        : right_(Wide3::all(camera.right)),
          down_(Wide3::all(camera.down)),
          forward_(Wide3::all(camera.forward)),
          anchor_(Wide3::all(camera.anchor)),
          scale_(camera.scale),
          extent_(camera),
          parallel_(camera.parallel) {}

    /// Which of a batch's triangles double arithmetic cannot tell, and which of the others turn a
    /// back to the eye that nobody sees; where all do so nothing is made of them.
    struct Found {
        std::uint32_t unknown;
        std::uint32_t back_facing;
    };
    HWY_INLINE Found make(const TriangleBatch& batch, CameraTriangle* out, std::size_t count) {
        const Wide3 p = Wide3::load(batch.corner);
        const Wide3 q = Wide3::load(batch.corner + 3);
        const Wide3 r = Wide3::load(batch.corner + 6);
        const Wide3 at[3] = {(p - anchor_) * scale_, (q - anchor_) * scale_,
                             (r - anchor_) * scale_};
        const Wide3& a = parallel_ ? forward_ : at[0];
        const Wide3& b = parallel_ ? forward_ : at[1];
        const Wide3& c = parallel_ ? forward_ : at[2];
        const Wide3 bc = (r - q) * scale_;
        const Wide3 ca = (p - r) * scale_;
        const Wide3 ab = (q - p) * scale_;
        const Wide3 normal = cross(ca, ab);
        const Wide constant = dot(normal, a);
        const Wide edge = max(max_norm(ab), max_norm(ca)) + max_norm(bc);
        const Wide far =
            max(max_norm(at[0]), max(max_norm(at[1]), max_norm(at[2]))) + Wide(extent_.starts);
        // Each component of an edge plane has two products of three roundings and a difference; the
        // direction's own roundings and its unit length in the exact ray add 12 more.
        const Wide direction(extent_.direction);
        // What planes are made of, and what their functions are taken of.
        const Wide& reach = parallel_ ? direction : far;
        const Wide along = parallel_ ? far * Wide(3.0) : direction;
        const Wide relative(2 * gamma(32));
        // And what its products lose below the normal range.
        const Wide normal_error = relative * edge * edge + Wide(8 * kUnderflow);
        const Wide inverse = Wide(1.0) / constant;
        const Wide sign = select(constant > Wide(0.0), Wide(1.0), Wide(-1.0));
        const Wide edge_error = relative * edge * reach * along;
        // The relative error of K.
        const Wide share = Wide(3.0) * normal_error * reach * abs(inverse);
        const PlaneFunction inverse_plane(*this, normal * inverse, at[0]);
        // Infinite or NaN: floats cannot tell.
        known_ = (share < Wide(0.25)) & (inverse_plane.most < Wide(kLargest)) &
                 (edge_error < Wide(kLargest));
        const std::uint32_t there = (1U << count) - 1;
        // Where K is known it has the sign of the exact one.
        const Found found{~known_.bits() & there,
                          (known_ & (constant > Wide(0.0))).bits() & batch.front_only & there};
        if (found.back_facing == there) return found;
        put_edge(0, {*this, cross(b, bc) * sign, at[1]}, edge_error);
        put_edge(1, {*this, cross(c, ca) * sign, at[2]}, edge_error);
        put_edge(2, {*this, cross(a, ab) * sign, at[0]}, edge_error);
        put(3, inverse_plane, Wide(1.0), normal_error * along * abs(inverse), Wide(2.0) * share);
        static_assert(sizeof(CameraTriangle) == 16 * sizeof(float));
        columns_.write(out->a, count);
        return found;
    }

  private:
    static constexpr double kLargest = 0x1p120;

    // A plane's function of the pixel, and what bounds it over the picture.
    struct PlaneFunction {
        // Through a point, which counts from the anchor.
        HWY_INLINE PlaneFunction(const TriangleMaker& maker, const Wide3& normal,
                                 const Wide3& point)
            : right(dot(normal, maker.right_)),
              down(dot(normal, maker.down_)),
              constant(maker.parallel_ ? -dot(normal, point) : dot(normal, maker.forward_)),
              most(abs(right) * Wide(maker.extent_.x) + abs(down) * Wide(maker.extent_.y) +
                   abs(constant)) {}

        Wide right;
        Wide down;
        Wide constant;
        Wide most;
    };

    // An edge's function is made about 1 at most in the picture: the three share one bound, which
    // would else be that of the farthest edge.
    HWY_INLINE void put_edge(std::size_t i, const PlaneFunction& f, const Wide& error) {
        constexpr double kSmallest = 0x1p-500;
        const Wide factor = select(f.most > Wide(kSmallest), Wide(1.0) / f.most, Wide(1.0));
        put(i, f, factor, error * factor, Wide(0.0));
    }
    // One function times a factor with its bound: `error` is that of the double stage.
    HWY_INLINE void put(std::size_t i, const PlaneFunction& f, const Wide& factor,
                        const Wide& error, const Wide& relative) {
        const Wide zero(0.0);
        store_rounded(select(known_, f.right * factor, zero), columns_.at[0][i]);
        store_rounded(select(known_, f.down * factor, zero), columns_.at[1][i]);
        store_rounded(select(known_, f.constant * factor, zero), columns_.at[2][i]);
        const Wide whole = error + f.most * factor * (relative + Wide(roundings(kCameraRoundings)));
        const Wide up = whole * Wide(1 + roundings(2)) + Wide(kFloatUnderflow);
        store_rounded(select(known_, up, Wide(kInfinity)), columns_.at[3][i]);
    }

    Wide3 right_, down_, forward_, anchor_;
    Wide scale_;
    CameraExtent extent_;
    bool parallel_;
    Wide::Mask known_;
    RecordColumns columns_;  // a, b, c, e of u, v, w, q
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_CAMERA_TRIANGLE_LANES_H_
