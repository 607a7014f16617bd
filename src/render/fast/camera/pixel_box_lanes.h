// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_PIXEL_BOX_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_PIXEL_BOX_LANES_H_
#undef NUVO_RENDER_FAST_PIXEL_BOX_LANES_H_
#else
#define NUVO_RENDER_FAST_PIXEL_BOX_LANES_H_
#endif

#include <algorithm>

#include "fast/camera/camera_tables.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Pixel boxes of 8 primitives at a time. The camera's axes are perpendicular and the view's has
// length 1, so a point p seen from the eye lies at t = p.forward on the ray of the pixel
// coordinates p.right / (|right|^2 t), p.down / (|down|^2 t); in a parallel projection, p counted
// from the anchor, on that of p.right / |right|^2, p.down / |down|^2. For a sphere the extreme
// slopes are those of the two planes through the eye that touch it (Mara and McGuire 2013, "2D
// polyhedral bounds of a clipped, perspective-projected 3D sphere"). Dot products are taken in
// double and rounded; the rest is float.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class PixelBoxMaker {
  public:
    static constexpr std::size_t kGroup = 8;
    using Numbers = Lanes<double, kGroup>;
    using Singles = Lanes<float, kGroup>;

    explicit PixelBoxMaker(const CameraRays& camera)
        : axis_{camera.right * (1 / dot(camera.right, camera.right)),
                camera.down * (1 / dot(camera.down, camera.down)), camera.forward},
          focal_{static_cast<float>(length(axis_[0])), static_cast<float>(length(axis_[1]))},
          first_{static_cast<float>(camera.center_x(0)), static_cast<float>(camera.center_y(0))},
          parallel_(camera.parallel),
          starts_at_(start_range(camera).high),
          start_slack_(rounded_up(CameraExtent(camera).starts * gamma(8))),
          usable_(std::max(camera.resolution.width, camera.resolution.height) <= kMostBoxPixels &&
                  std::max(focal_[0], focal_[1]) < (parallel_ ? kLargest : kLongestFocal)) {}

    /// Of triangles, from the coordinates of their corners in world space (a.x, a.y, a.z, b.x ...
    /// c.z).
    HWY_INLINE void triangles(const double (&corners)[9][kGroup], const Point3& anchor,
                              double scale, PixelBox* out, std::size_t count) const {
        Singles low[3];
        Singles high[3];
        Numbers reach(0.0);
        Singles column[3][3];
        for (std::size_t i = 0; i < 3; ++i) {
            Numbers p[3];
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = (Numbers::load(corners[3 * i + static_cast<std::size_t>(axis)]) -
                           Numbers(anchor[axis])) *
                          Numbers(scale);
                reach = reach + abs(p[axis]);
            }
            for (int k = 0; k < 3; ++k) column[i][k] = along(k, p);
        }
        low[2] = min(column[0][2], min(column[1][2], column[2][2]));
        high[2] = max(column[0][2], max(column[1][2], column[2][2]));
        const Singles least = floats_from(reach) * Singles(kLeastDepth);
        for (int k = 0; k < 2; ++k) {
            low[k] = Singles(kFloatInfinity);
            high[k] = -low[k];
            for (const auto& p : column) {
                const Singles at = parallel_ ? p[k] : p[k] / p[2];
                low[k] = min(low[k], at);
                high[k] = max(high[k], at);
            }
        }
        if (parallel_) return write_parallel(low, high, floats_from(reach), out, count);
        // Comparisons with NaN or infinity are false.
        const auto known = (low[2] > max(least, Singles(kLeast))) & (least < Singles(kLargest));
        write(low, high, known, high[2] < -least, Singles(1.0F) / low[2], out, count);
    }

    HWY_INLINE void spheres(const CameraSphere* spheres, PixelBox* out, std::size_t count) const {
        alignas(64) double column[4][kGroup];
        for (std::size_t i = 0; i < kGroup; ++i) {
            const CameraSphere& s = spheres[std::min(i, count - 1)];
            for (int axis = 0; axis < 3; ++axis) column[axis][i] = -s.from[axis];
            column[3][i] = s.exact_radius;
        }
        const Numbers p[3] = {Numbers::load(column[0]), Numbers::load(column[1]),
                              Numbers::load(column[2])};
        const Singles r = floats_from(Numbers::load(column[3]));
        const Singles z = along(2, p);
        const Singles reach = floats_from(abs(p[0]) + abs(p[1]) + abs(p[2])) + r;
        if (parallel_) {
            const Singles rounded = reach * Singles(roundings(8));
            const Singles slack = r + rounded;
            Singles low[3] = {Singles(0.0F), Singles(0.0F), z - slack};
            Singles high[3] = {Singles(0.0F), Singles(0.0F), z + slack};
            for (int k = 0; k < 2; ++k) {
                const Singles x = along(k, p);
                const Singles spread = mul_add(r, Singles(focal_[k] * (1 + roundings(4))),
                                               abs(x) * Singles(roundings(4)));
                low[k] = x - spread;
                high[k] = x + spread;
            }
            return write_parallel(low, high, reach, out, count);
        }
        // (z - r)(z + r), where z > 2 r within 8 roundings.
        const Singles inverse = Singles(1.0F) / ((z - r) * (z + r));
        Singles low[2];
        Singles high[2];
        for (int k = 0; k < 2; ++k) {
            const Singles focal(focal_[k]);
            const Singles x = along(k, p);  // pixels
            const Singles across = x / focal;
            const Singles spread =
                r * focal * sqrt(mul_add(across, across, (z - r) * (z + r))) * inverse;
            const Singles middle = x * z * inverse;
            // z - r carries 4 roundings, `inverse` 8, the terms, which may cancel, 18 at most.
            const Singles slack = (abs(middle) + spread) * Singles(roundings(24));
            low[k] = middle - spread - slack;
            high[k] = middle + spread + slack;
        }
        const Singles least = reach * Singles(kLeastDepth);
        const auto known =
            (z > r + r) & (z > max(least, Singles(kLeast))) & (least < Singles(kLargest));
        write(low, high, known, z + r < -least, Singles(1.0F) / (z - r), out, count);
    }

  private:
    // Depths that are smaller in proportion to the point's distance are not used: so the rounding
    // of the dot products in double is at most 2^-50 2^16 of a depth.
    static constexpr float kLeastDepth = 0x1p-16F;
    static constexpr float kLargest = 0x1p60F;
    // Nor are those whose square's inverse is beyond floats, or so that roundings below the normal
    // range could matter.
    static constexpr float kLeast = 0x1p-40F;
    // In pixels: more than the rounding of a coordinate up to kMostBoxPixels, and that of the dot
    // products, which is 2^-34 of the view's depth.
    static constexpr float kMargin = 0x1p-6F;
    static constexpr float kLongestFocal = 0x1p24F;
    // Of a parallel projection: dot products in double are off by less than 2^-50 of their terms.
    static constexpr float kDoubleRoundings = 0x1p-50F;
    static constexpr float kMostPixels = 0x1p40F;

    HWY_INLINE Singles along(int k, const Numbers (&p)[3]) const {
        return floats_from(mul_add(p[0], Numbers(axis_[k].x),
                                   mul_add(p[1], Numbers(axis_[k].y), p[2] * Numbers(axis_[k].z))));
    }

    // By the depths low[2] to high[2] from the anchor on, which is at most `reach` away.
    HWY_INLINE void write_parallel(const Singles (&low)[3], const Singles (&high)[3],
                                   const Singles& reach, PixelBox* out, std::size_t count) const {
        const Singles slack = mul_add(reach, Singles(kDoubleRoundings), Singles(start_slack_));
        const auto known = reach * Singles(std::max(focal_[0], focal_[1])) < Singles(kMostPixels);
        const Singles farthest = -high[2] - abs(high[2]) * Singles(roundings(4)) - slack;
        const auto behind = farthest > Singles(starts_at_);
        write(low, high, known & ~behind, known & behind, slack - low[2], out, count);
    }

    // The pixels from low to high (in pixel coordinates), or none behind, or else all.
    HWY_INLINE void write(const Singles* low, const Singles* high, const Singles::Mask& known,
                          const Singles::Mask& behind, const Singles& nearest, PixelBox* out,
                          std::size_t count) const {
        constexpr float kMost = kMostBoxPixels;
        alignas(64) float first[2][kGroup];
        alignas(64) float end[2][kGroup];
        alignas(64) float near[kGroup];
        const std::uint32_t sure = usable_ ? known.bits() : 0;
        const std::uint32_t surely_behind = behind.bits() & ~sure & (usable_ ? ~0U : 0U);
        const auto all = Singles::Mask::from_bits(~(sure | surely_behind));
        const auto none = Singles::Mask::from_bits(surely_behind);
        for (int k = 0; k < 2; ++k) {
            const Singles least = low[k] - abs(low[k]) * Singles(roundings(8));
            const Singles most = high[k] + abs(high[k]) * Singles(roundings(8));
            // The least whole number from x on is -floor(-x).
            const Singles from = -floor(Singles(first_[k] + kMargin) - least);
            const Singles to = floor(most - Singles(first_[k] - kMargin)) + Singles(1.0F);
            const Singles zero(0.0F);
            select(all | none, zero, min(max(from, zero), Singles(kMost))).store(first[k]);
            select(all, Singles(kMost), select(none, zero, min(max(to, zero), Singles(kMost))))
                .store(end[k]);
        }
        select(all, Singles(kFloatInfinity), mul_add(abs(nearest), Singles(roundings(16)), nearest))
            .store(near);
        for (std::size_t i = 0; i < count; ++i) {
            const auto pack = [&](int k) {
                return static_cast<std::uint32_t>(static_cast<std::int32_t>(first[k][i])) |
                       static_cast<std::uint32_t>(static_cast<std::int32_t>(end[k][i])) << 16;
            };
            out[i] = {pack(0), pack(1), near[i], 0};
        }
    }

    Vector3 axis_[3];  // p.axis[0 .. 1] / p.axis[2] is in pixels
    float focal_[2];   // the view's depth in pixels
    float first_[2];   // pixel coordinates of pixel 0
    bool parallel_;
    float starts_at_;
    float start_slack_;
    bool usable_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_PIXEL_BOX_LANES_H_
