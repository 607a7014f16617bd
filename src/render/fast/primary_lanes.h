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
        half_width = static_cast<float>(kHalfTile * (length(rays.right) + length(rays.down))) *
                         (1 + 0x1p-20F) +
                     longest * 0x1p-20F;
        for (int axis = 0; axis < 3; ++axis) center_float[axis] = static_cast<float>(center[axis]);
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

    const CameraRays& camera;
    Vector3 center;  ///< the direction through the middle of the tile
    float center_x;  ///< that middle's pixel coordinates
    float center_y;
    float longest;     ///< bounds |d| over the tile
    float half_width;  ///< bounds |d - center| over the tile, with 16 roundings of d to spare
    float center_float[3];
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

/// The directions of all rays of a tile: two roundings of each term.
struct TileDirections {
    void fill(const TileRays& rays) {
        for (int b = 0; b < kTileBlocks; ++b) {
            const Floats x = TileRays::lane_x() + Floats(4.0F * static_cast<float>(b % 4) - 6.0F);
            const Floats y = TileRays::lane_y() + Floats(4.0F * static_cast<float>(b / 4) - 6.0F);
            Floats sum(0.0F);
            for (int axis = 0; axis < 3; ++axis) {
                const auto right = static_cast<float>(rays.camera.right[axis]);
                const auto down = static_cast<float>(rays.camera.down[axis]);
                const Floats at(static_cast<float>(rays.center[axis]));
                const Floats value = mul_add(x, Floats(right), mul_add(y, Floats(down), at));
                value.store(d[axis] + b * kBlockLanes);
                sum = mul_add(value, value, sum);
            }
            sum.store(square + b * kBlockLanes);
        }
    }

    alignas(64) float d[3][kTileLanes];
    alignas(64) float square[kTileLanes];  ///< |d|^2
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

/// Whether no ray of the tile comes near the sphere, or it is surely not nearer than `near`: cheap.
HWY_INLINE bool surely_passed(const CameraSphere& s, const TileRays& rays, float near) {
    if (s.nearest * rays.longest < near) return true;
    float f[3];
    for (int axis = 0; axis < 3; ++axis) f[axis] = static_cast<float>(s.from[axis]);
    const float x = f[1] * rays.center_float[2] - f[2] * rays.center_float[1];
    const float y = f[2] * rays.center_float[0] - f[0] * rays.center_float[2];
    const float z = f[0] * rays.center_float[1] - f[1] * rays.center_float[0];
    // |f x d| varies by at most |f| times the tile's half width; its error is 4 roundings a term.
    const float bound = s.radius * rays.longest + s.distance * rays.half_width;
    return x * x + y * y + z * z > bound * bound * (1 + 8 * SphereOverTile::kRoundoff);
}

/// f x d and f . d at the centres of the blocks, and what a lane adds to them.
struct SphereOffsets {
    explicit HWY_INLINE SphereOffsets(const SphereOverTile& over) {
        for (int i = 0; i < 3; ++i) {
            SphereOverTile::at_blocks(over.m[i], over.m_right[i], over.m_down[i]).store(block[i]);
            lane[i] = at_lanes(over.m_right[i], over.m_down[i]);
        }
        SphereOverTile::at_blocks(over.b, over.b_right, over.b_down).store(block[3]);
        lane[3] = at_lanes(over.b_right, over.b_down);
    }
    static HWY_INLINE Floats at_lanes(float right, float down) {
        return mul_add(TileRays::lane_x(), Floats(right), TileRays::lane_y() * Floats(down));
    }
    HWY_INLINE Floats value(int i, int b) const { return Floats(block[i][b]) + lane[i]; }

    alignas(64) float block[4][kTileBlocks];
    Floats lane[4];
};

/// Whether 16 rays' lines meet a sphere: the discriminant is |d|^2 r^2 - |f x d|^2.
struct SphereDiscriminant {
    HWY_INLINE SphereDiscriminant(const CameraSphere& s, const SphereOverTile& over,
                                  const SphereOffsets& offsets, const TileDirections& directions,
                                  int b) {
        const Floats x = offsets.value(0, b);
        const Floats y = offsets.value(1, b);
        const Floats z = offsets.value(2, b);
        const Floats square = Floats::load(directions.square + b * kBlockLanes);
        value = neg_mul_add(
            x, x, neg_mul_add(y, y, neg_mul_add(z, z, square * Floats(s.radius * s.radius))));
        meets = value > Floats(over.square_error);
        perhaps = value >= Floats(-over.square_error);
    }

    Floats value;
    RayMask meets;
    RayMask perhaps;
};

/// Where they do: 1 / t = (-b +- root) / (f.f - r^2).
struct SphereHits {
    HWY_INLINE SphereHits(const CameraSphere& s, const SphereOverTile& over,
                          const SphereOffsets& offsets, const SphereDiscriminant& line, int b) {
        const Floats positive = max(line.value, Floats(0.0F));
        root = sqrt(positive);
        if (s.inverse_power < 0) root = -root;  // from inside the far one
        root_error =
            min(Floats(over.square_error) * above_inverse_sqrt(positive), Floats(over.root_error));
        const Floats q = (root - offsets.value(3, b)) * Floats(s.inverse_power);
        const Floats q_error =
            (root_error + Floats(over.b_error)) *
                Floats(std::fabs(s.inverse_power) * (1 + 8 * SphereOverTile::kRoundoff)) +
            abs(q) * Floats(s.power_error + 8 * SphereOverTile::kRoundoff);
        low = q - q_error;
        high = q + q_error;
    }

    /// The unit normal (f + t d) / r = (d x m - root d) / (|d|^2 r) with m = f x d.
    HWY_INLINE void store_normal(const CameraSphere& s, const SphereOverTile& over,
                                 const SphereOffsets& offsets, const TileDirections& directions,
                                 Tile& tile, int b, const RayMask& mask) const {
        const Floats square = Floats::load(directions.square + b * kBlockLanes);
        const Floats inverse = Floats(1.0F) / (square * Floats(s.radius));
        Floats d[3];
        Floats m[3];
        for (int axis = 0; axis < 3; ++axis) {
            d[axis] = Floats::load(directions.d[axis] + b * kBlockLanes);
            m[axis] = offsets.value(axis, b);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3;
            const int last = (axis + 2) % 3;
            const Floats across = neg_mul_add(d[last], m[next], d[next] * m[last]);
            const Floats n = neg_mul_add(root, d[axis], across) * inverse;
            n.store(tile.round_normal[axis] + b * kBlockLanes, mask);
        }
        const Floats error = mul_add((root_error + Floats(over.normal_error)) * sqrt(square),
                                     inverse, Floats(16 * SphereOverTile::kRoundoff));
        error.store(tile.round_error + b * kBlockLanes, mask);
    }

    Floats root;
    Floats root_error;
    Floats low;
    Floats high;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_PRIMARY_LANES_H_
