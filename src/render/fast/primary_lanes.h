// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_PRIMARY_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_PRIMARY_LANES_H_
#undef NUVO_RENDER_FAST_PRIMARY_LANES_H_
#else
#define NUVO_RENDER_FAST_PRIMARY_LANES_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "beam_box.h"
#include "camera_tables.h"
#include "lanes.h"
#include "tile.h"

// The rays of a tile in registers, and spheres against them. Directions are affine in the pixel, so
// what is linear in the direction (f x d, f . d) is computed at the tile's centre in double,
// rounded once, and carried to blocks and lanes by additions: its error is in proportion to the
// tile, not to the distance.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Offsets of blocks and lanes in pixels; the tile's beam; directions for scenes with spheres.
struct TileRays {
    static constexpr float kHalfBlock = 0.5F * (kBlockSide - 1);
    static constexpr float kHalfTile = 0.5F * (kTileSide - 1);

    TileRays(const CameraRays& rays, const Tile& tile) : camera(rays) {
        const double x = rays.center_x(tile.x) + kHalfTile;
        const double y = rays.center_y(tile.y) + kHalfTile;
        center = rays.direction(x, y);
        center_x = static_cast<float>(x);
        center_y = static_cast<float>(y);
        // Of |d| over the tile, from above.
        longest = static_cast<float>(
            (length(center) + (kHalfTile + 1) * (length(rays.right) + length(rays.down))) *
            (1 + 0x1p-20));
        fill_beam();
    }

    static HWY_INLINE Floats block_x() {
        alignas(64) static constexpr float kAt[16] = {-6, -2, 2, 6, -6, -2, 2, 6,
                                                      -6, -2, 2, 6, -6, -2, 2, 6};
        return Floats::load(kAt);
    }
    static HWY_INLINE Floats block_y() {
        alignas(64) static constexpr float kAt[16] = {-6, -6, -6, -6, -2, -2, -2, -2,
                                                      2,  2,  2,  2,  6,  6,  6,  6};
        return Floats::load(kAt);
    }
    static HWY_INLINE Floats lane_x() { return block_x() * Floats(0.25F); }
    static HWY_INLINE Floats lane_y() { return block_y() * Floats(0.25F); }

    /// One component of the directions of a block's rays: two roundings of each term.
    HWY_INLINE Floats direction(int axis, int block) const {
        const float x = 4.0F * static_cast<float>(block % 4) - 6.0F;
        const float y = 4.0F * static_cast<float>(block / 4) - 6.0F;
        const auto right = static_cast<float>(camera.right[axis]);
        const auto down = static_cast<float>(camera.down[axis]);
        const Floats at(static_cast<float>(center[axis]));
        return mul_add(lane_x() + Floats(x), Floats(right),
                       mul_add(lane_y() + Floats(y), Floats(down), at));
    }
    const CameraRays& camera;
    Vector3 center;  ///< the direction through the middle of the tile
    float center_x;  ///< that middle's pixel coordinates
    float center_y;
    float longest;  ///< bounds |d| over the tile
    BeamBox beam;

  private:
    // Directions are extreme at the corners; floats next to the rounded ones enclose them.
    void fill_beam() {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double reach =
                kHalfTile * (std::fabs(camera.right[axis]) + std::fabs(camera.down[axis]));
            const auto origin = static_cast<float>(camera.origin[axis]);
            beam.origin_low[axis] = std::nextafter(origin, -kFar);
            beam.origin_high[axis] = std::nextafter(origin, kFar);
            const double slack = reach * 0x1p-24 + 0x1p-40;
            beam.direction_low[axis] =
                std::nextafter(static_cast<float>(center[axis] - reach - slack), -kFar);
            beam.direction_high[axis] =
                std::nextafter(static_cast<float>(center[axis] + reach + slack), kFar);
        }
        beam.t_end = kLargestT;
        beam.keep_off_zero();
    }
    static constexpr float kLargestT = 0x1p100F;
};

/// Bounds on 1 / t of a candidate against those of the nearest so far.
struct Candidates {
    HWY_INLINE Candidates(const Tile& tile, int block, const Floats& low_q, const Floats& high_q)
        : low(low_q),
          high(high_q),
          surely_nearer(low_q > Floats::load(tile.near_high + block * kBlockLanes)),
          perhaps_nearer(high_q >= Floats::load(tile.near_low + block * kBlockLanes)) {}

    HWY_INLINE void store(Tile& tile, int block, const RayMask& mask, Slot slot) const {
        low.store(tile.near_low + block * kBlockLanes, mask);
        high.store(tile.near_high + block * kBlockLanes, mask);
        Ints(static_cast<std::int32_t>(slot))
            .store(reinterpret_cast<std::int32_t*>(tile.slot) + block * kBlockLanes,
                   mask_for<std::int32_t>(mask));
    }

    Floats low;
    Floats high;
    RayMask surely_nearer;
    RayMask perhaps_nearer;
};

/// A sphere's linear functions over one tile.
struct SphereOverTile {
    static constexpr float kRoundoff = 0x1p-24F;
    static constexpr float kRootOf3 = 1.7320509F;  // rounded up

    HWY_INLINE SphereOverTile(const CameraSphere& s, const TileRays& rays) {
        const Vector3 f{s.from[0], s.from[1], s.from[2]};
        const Vector3 at = cross(f, rays.center);
        const Vector3 right = cross(f, rays.camera.right);
        const Vector3 down = cross(f, rays.camera.down);
        for (int axis = 0; axis < 3; ++axis) {
            m[axis] = static_cast<float>(at[axis]);
            m_right[axis] = static_cast<float>(right[axis]);
            m_down[axis] = static_cast<float>(down[axis]);
        }
        const auto step = static_cast<float>(max_norm(right) + max_norm(down)) * kRootOf3;
        reach = TileRays::kHalfBlock * step;
        b = static_cast<float>(dot(f, rays.center));
        b_right = static_cast<float>(dot(f, rays.camera.right));
        b_down = static_cast<float>(dot(f, rays.camera.down));
        // |m| at the rays of a block that blocks() lets through; then the errors that follow.
        longest = rays.longest;
        const float most = (s.radius * longest + 3 * reach + s.cross_error) * (1 + 16 * kRoundoff);
        m_error = 8 * kRoundoff * (most + 8 * step) + s.cross_error;
        square_error = 32 * kRoundoff * most * most + 4 * most * m_error;
        b_error = 8 * kRoundoff * (std::fabs(b) + 8 * (std::fabs(b_right) + std::fabs(b_down))) +
                  s.cross_error;
        root_error = std::sqrt(2 * square_error) * (1 + 4 * kRoundoff);
        normal_error = 16 * kRoundoff * most + 2 * m_error;
    }

    /// The blocks that rays to the sphere may pass, where it may be nearer than what is known.
    HWY_INLINE std::uint32_t blocks(const CameraSphere& s, const float* block_near) const {
        Floats square(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats value = at_blocks(m[axis], m_right[axis], m_down[axis]);
            square = mul_add(value, value, square);
        }
        const float bound = (s.radius * longest + reach + 2 * m_error) * (1 + 16 * kRoundoff);
        return ((square <= Floats(bound * bound * (1 + 16 * kRoundoff))) &
                (Floats(s.nearest * longest) >= Floats::load(block_near)))
            .bits();
    }

    static HWY_INLINE Floats at_blocks(float at, float right, float down) {
        return mul_add(TileRays::block_x(), Floats(right),
                       mul_add(TileRays::block_y(), Floats(down), Floats(at)));
    }

    float m[3];  ///< f x d at the tile's centre
    float m_right[3];
    float m_down[3];
    float b;  ///< f . d
    float b_right;
    float b_down;
    float reach;         ///< how much |m| varies from a block's centre
    float longest;       ///< bounds |d|
    float normal_error;  ///< of d x m - root d in units of |d|, without root_error
    float m_error;       ///< of m on each axis
    float square_error;  ///< of the discriminant
    float b_error;
    float root_error;  ///< of the discriminant's square root, at most
};

/// 16 rays against a sphere: a r^2 - |f x d|^2 is the discriminant, 1 / t = (-b +- root) / (f.f -
/// r^2).
struct SphereHits {
    HWY_INLINE SphereHits(const CameraSphere& s, const SphereOverTile& over, const TileRays& rays,
                          int block) {
        const Floats x = TileRays::lane_x() + Floats(4.0F * static_cast<float>(block % 4) - 6.0F);
        const Floats y = TileRays::lane_y() + Floats(4.0F * static_cast<float>(block / 4) - 6.0F);
        Floats mm(0.0F);
        square = Floats(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            d[axis] = rays.direction(axis, block);
            m[axis] = mul_add(x, Floats(over.m_right[axis]),
                              mul_add(y, Floats(over.m_down[axis]), Floats(over.m[axis])));
            square = mul_add(d[axis], d[axis], square);
            mm = mul_add(m[axis], m[axis], mm);
        }
        discriminant = square * Floats(s.radius * s.radius) - mm;
        const Floats error(over.square_error);
        meets = discriminant > error;
        perhaps = discriminant >= -error;
        const Floats positive = max(discriminant, Floats(0.0F));
        root = sqrt(positive);
        if (s.inverse_power < 0) root = -root;  // from inside the far one
        root_error = min(error * above_inverse_sqrt(positive), Floats(over.root_error));
        const Floats b =
            mul_add(x, Floats(over.b_right), mul_add(y, Floats(over.b_down), Floats(over.b)));
        const Floats q = (root - b) * Floats(s.inverse_power);
        const Floats q_error =
            (root_error + Floats(over.b_error)) *
                Floats(std::fabs(s.inverse_power) * (1 + 8 * SphereOverTile::kRoundoff)) +
            abs(q) * Floats(s.power_error + 8 * SphereOverTile::kRoundoff);
        low = q - q_error;
        high = q + q_error;
    }

    /// (f + t d) / r = (d x m - root d) / (a r).
    HWY_INLINE void store_normal(const CameraSphere& s, const SphereOverTile& over, Tile& tile,
                                 int block, const RayMask& mask) const {
        const Floats inverse = Floats(1.0F) / (square * Floats(s.radius));
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3;
            const int last = (axis + 2) % 3;
            const Floats across = neg_mul_add(d[last], m[next], d[next] * m[last]);
            const Floats n = neg_mul_add(root, d[axis], across) * inverse;
            n.store(tile.round_normal[axis] + block * kBlockLanes, mask);
        }
        const Floats error = mul_add((root_error + Floats(over.normal_error)) * sqrt(square),
                                     inverse, Floats(16 * SphereOverTile::kRoundoff));
        error.store(tile.round_error + block * kBlockLanes, mask);
    }

    Floats d[3];
    Floats m[3];
    Floats square;  ///< |d|^2
    Floats discriminant;
    Floats root;
    Floats root_error;
    Floats low;
    Floats high;
    RayMask meets;
    RayMask perhaps;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_PRIMARY_LANES_H_
