// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SPHERE_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SPHERE_LANES_H_
#undef NUVO_RENDER_FAST_SPHERE_LANES_H_
#else
#define NUVO_RENDER_FAST_SPHERE_LANES_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "fast/camera/camera_tables.h"
#include "fast/primary/primary_lanes.h"
#include "fast/simd/vector_lanes.h"
#include "nuvo/math/error_bounds.h"

// Spheres against the rays of a tile. Seen from the eye a sphere is a conic (Pharr, Jakob and
// Humphreys 2016, section 3.2; Haines et al. 2019 for the form): with f from its centre to where
// the rays come from the discriminant |d|^2 r^2 - |f x d|^2 is a quadratic function of the pixel's
// offset from the tile's middle, f . d an affine one, for d is affine, or in a parallel projection
// f. Their coefficients are computed in double, for 16 spheres at a time, and rounded once: so the
// error is in proportion to the tile, not to the distance.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The functions of up to 16 spheres over one tile, by sphere.
class SphereConics {
  public:
    static constexpr std::size_t kMost = 16;

    HWY_NOINLINE void fill(const SeenQuadric* seen, std::size_t count, const TileRays& rays) {
        alignas(64) double column[5][kMost];
        bool mapped = false;
        for (std::size_t i = 0; i < kMost; ++i) {
            const SeenQuadric& quadric = seen[std::min(i, count - 1)];
            const CameraSphere& s = *quadric.sphere;
            for (int axis = 0; axis < 3; ++axis) column[axis][i] = s.from[axis];
            column[3][i] = s.exact_radius;
            column[4][i] = s.cross_error;
            mapped |= quadric.map != nullptr;
        }
        const auto seen_vector = [&](const Vector3& v) HWY_ATTR {
            return mapped ? as_seen(seen, count, v) : Triple::all(v);
        };
        const auto from = Triple::load(column);
        const Triple center = seen_vector(rays.center);
        const Triple right = seen_vector(rays.camera.right);
        const Triple down = seen_vector(rays.camera.down);
        const Doubles r = Doubles::load(column[3]);
        const Floats cross_error = floats_from(Doubles::load(column[4]));
        if (rays.camera.parallel) {
            const Triple f = from + seen_vector(rays.start);
            const Triple zero = Triple::all({});
            set({center, zero, zero}, {cross(f, center), cross(right, center), cross(down, center)},
                r, cross_error);
            set_toward(-fused_dot(f, center), -fused_dot(right, center), -fused_dot(down, center),
                       cross_error);
        } else {
            set({center, right, down}, {cross(from, center), cross(from, right), cross(from, down)},
                r, cross_error);
            set_toward(fused_dot(from, center), fused_dot(from, right), fused_dot(from, down),
                       cross_error);
        }
    }

    /// The blocks of `blocks` in which the discriminant of sphere i is not surely negative.
    HWY_INLINE std::uint32_t met(std::size_t i, std::uint32_t blocks) const {
        const Floats x = Floats::load(kOffsets.block_x);
        const Floats y = Floats::load(kOffsets.block_y);
        const Floats xx(xx_[i]);
        const Floats xy(xy_[i]);
        const Floats yy(yy_[i]);
        // Half a block away the function is more by its slopes' half a block and its bends'.
        const Floats slope = abs(mul_add(xx + xx, x, mul_add(xy, y, Floats(x_[i])))) +
                             abs(mul_add(yy + yy, y, mul_add(xy, x, Floats(y_[i]))));
        const Floats bend = (abs(xx) + abs(xy) + abs(yy)) * Floats(kHalfBlock);
        const Floats most = mul_add((slope + bend) * Floats(1 + roundings(16)), Floats(kHalfBlock),
                                    discriminant(i, x, y));
        return (most >= Floats(-error_[i])).bits() & blocks;
    }

    HWY_INLINE Floats discriminant(std::size_t i, const Floats& x, const Floats& y) const {
        const Floats by_x = mul_add(Floats(xx_[i]), x, mul_add(Floats(xy_[i]), y, Floats(x_[i])));
        const Floats by_y = mul_add(Floats(yy_[i]), y, Floats(y_[i]));
        return mul_add(x, by_x, mul_add(y, by_y, Floats(constant_[i])));
    }
    /// Of the discriminant.
    float error(std::size_t i) const { return error_[i]; }
    /// Whether floats hold the numbers of sphere i.
    bool known(std::size_t i) const { return error_[i] <= std::numeric_limits<float>::max(); }
    /// Of its root, at most.
    float root_error(std::size_t i) const { return root_error_[i]; }

    /// f . d, in a parallel projection -f . d: q = (+-root - toward) inverse_power
    HWY_INLINE Floats toward(std::size_t i, const Floats& x, const Floats& y) const {
        return mul_add(Floats(b_x_[i]), x, mul_add(Floats(b_y_[i]), y, Floats(b_[i])));
    }
    float toward_error(std::size_t i) const { return b_error_[i]; }

  private:
    using Triple = VectorLanes<double, kMost>;

    // A direction as each sphere or ball sees it.
    static HWY_NOINLINE Triple as_seen(const SeenQuadric* seen, std::size_t count,
                                       const Vector3& d) {
        alignas(64) double column[3][kMost];
        for (std::size_t i = 0; i < kMost; ++i) {
            const BallMap* const map = seen[std::min(i, count - 1)].map;
            const Vector3 v = map == nullptr ? d : map->to_ball * d;
            for (int axis = 0; axis < 3; ++axis) column[axis][i] = v[axis];
        }
        return Triple::load(column);
    }

    // at + x right + y down.
    struct OfPixel {
        Triple at, right, down;
    };
    // The discriminant of directions d and m = f x d.
    HWY_INLINE void set(const OfPixel& d, const OfPixel& m, const Doubles& r,
                        const Floats& cross_error) {
        const Doubles r_square = r * r;
        const auto gap =
            [&](const Triple& a, const Triple& b, const Triple& ma, const Triple& mb)
                HWY_ATTR { return floats_from(r_square * fused_dot(a, b) - fused_dot(ma, mb)); };
        const Floats two(2.0F);
        const Floats constant = gap(d.at, d.at, m.at, m.at);
        const Floats x = two * gap(d.at, d.right, m.at, m.right);
        const Floats y = two * gap(d.at, d.down, m.at, m.down);
        const Floats xx = gap(d.right, d.right, m.right, m.right);
        const Floats xy = two * gap(d.right, d.down, m.right, m.down);
        const Floats yy = gap(d.down, d.down, m.down, m.down);
        const Floats half(kHalfTile);
        const Floats size = mul_add(mul_add(abs(xx) + abs(xy) + abs(yy), half, abs(x) + abs(y)),
                                    half, abs(constant));
        const Doubles longest =
            length(d.at) + Doubles(kHalfTile) * (length(d.right) + length(d.down));
        const Floats error =
            error_of(floats_from(longest * longest), size, floats_from(r_square), cross_error);
        // Beyond floats no sum of the terms, at most 2^21 errors, means anything; nor of NaN.
        const RayMask known = error < Floats(kLargest);
        const Floats zero(0.0F);
        select(known, constant, zero).store(constant_);
        select(known, x, zero).store(x_);
        select(known, y, zero).store(y_);
        select(known, xx, zero).store(xx_);
        select(known, xy, zero).store(xy_);
        select(known, yy, zero).store(yy_);
        const Floats bound = select(known, error, Floats(kFloatInfinity));
        bound.store(error_);
        (sqrt(bound + bound) * Floats(1 + roundings(4))).store(root_error_);
    }
    HWY_INLINE void set_toward(const Doubles& constant, const Doubles& by_x, const Doubles& by_y,
                               const Floats& cross_error) {
        const Floats b = floats_from(constant);
        const Floats b_x = floats_from(by_x);
        const Floats b_y = floats_from(by_y);
        b.store(b_);
        b_x.store(b_x_);
        b_y.store(b_y_);
        const Floats size = mul_add(abs(b_x) + abs(b_y), Floats(kHalfTile), abs(b));
        mul_add(size, Floats(roundings(8)), cross_error).store(b_error_);
    }

    static HWY_INLINE Doubles length(const Triple& v) { return sqrt(fused_dot(v, v)); }

    // `size` bounds the terms of the discriminant: 8 roundings of them. |f x d|^2 is less than
    // size + |d|^2 r^2 =: s; an error c of f x d on each axis adds at most 3.5 c |f x d| + 3 c^2
    // <= 2 u s + c^2 (1 / u + 3) for any u; and the double stage some 2^-47 of both, a ball's map
    // 2^-30. `square` bounds |d|^2.
    static HWY_INLINE Floats error_of(const Floats& square, const Floats& size,
                                      const Floats& r_square, const Floats& cross_error) {
        const Floats s = mul_add(r_square, square, size);
        const Floats c = cross_error * Floats(2 / kRootOfRoundoff);
        return mul_add(s, Floats(roundings(4)), c * c) +
               mul_add(size, Floats(roundings(9)), Floats(static_cast<float>(kFloatUnderflow)));
    }
    static constexpr float kRootOfRoundoff = 0x1p-12F;
    static constexpr float kLargest = 0x1p96F;

    alignas(64) float constant_[kMost];
    alignas(64) float x_[kMost];
    alignas(64) float y_[kMost];
    alignas(64) float xx_[kMost];
    alignas(64) float xy_[kMost];
    alignas(64) float yy_[kMost];
    alignas(64) float error_[kMost];
    alignas(64) float root_error_[kMost];
    alignas(64) float b_[kMost];
    alignas(64) float b_x_[kMost];
    alignas(64) float b_y_[kMost];
    alignas(64) float b_error_[kMost];
};

/// Where 16 rays meet a sphere: in perspective q = (-f.d +- root) / (f.f - r^2), in a parallel
/// projection q = (f.d + root) / d.d.
struct SphereHits {
    HWY_INLINE SphereHits(const CameraSphere& s, const SphereConics& conics, std::size_t i,
                          const Floats& discriminant, const Floats& x, const Floats& y) {
        const Floats positive = max(discriminant, Floats(0.0F));
        Floats root = sqrt(positive);
        if (s.inverse_power < 0) root = -root;  // from inside the far one
        const Floats root_error = min(Floats(conics.error(i)) * above_inverse_sqrt(positive),
                                      Floats(conics.root_error(i)));
        const Floats q = (root - conics.toward(i, x, y)) * Floats(s.inverse_power);
        const Floats q_error = (root_error + Floats(conics.toward_error(i))) *
                                   Floats(std::fabs(s.inverse_power) * (1 + roundings(8))) +
                               abs(q) * Floats(s.power_error + roundings(8));
        low = q - q_error;
        high = q + q_error;
    }

    Floats low;
    Floats high;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SPHERE_LANES_H_
