// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_BACKGROUND_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_BACKGROUND_LANES_H_
#undef NUVO_RENDER_FAST_BACKGROUND_LANES_H_
#else
#define NUVO_RENDER_FAST_BACKGROUND_LANES_H_
#endif

#include "fast/shading/block_directions.h"
#include "fast/shading/shading.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"
#include "nuvo/math/error_bounds.h"

// The background along 16 rays, as background.cpp has it: one color, the blend of eq. 36, or the
// bands of the standard's gradients.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Colors times 255, and a bound on the error of all three.
struct PixelColors {
    Floats channel[3];
    Floats error;

    /// Takes another's in the lanes of the mask.
    HWY_INLINE void take(const RayMask& mask, const PixelColors& other) {
        for (int c = 0; c < 3; ++c) channel[c] = select(mask, other.channel[c], channel[c]);
        error = select(mask, other.error, error);
    }
};

/// The sine of the rays' height, d.z / |d| for the zenith z, within ShadingRays::sine_error.
HWY_INLINE Floats sine_of_height(const BlockDirections& directions) {
    return directions.height() * inverse_sqrt(directions.square());
}

/// The colors of one list of bands, `angle` from its pole within `angle_error`. A lane whose bounds
/// lie in two bands is unknown.
HWY_INLINE PixelColors banded(const std::vector<BackgroundBand>& bands, const Floats& angle,
                              const Floats& angle_error) {
    const Floats least = angle - angle_error;
    const Floats most = angle + angle_error;
    PixelColors out;
    for (Floats& c : out.channel) c = Floats(0.0F);
    out.error = Floats(kFloatInfinity);
    RayMask open = RayMask::from_bits(0xffff);  // beyond all bands so far
    for (const BackgroundBand& band : bands) {
        const RayMask here = open & (most <= Floats(band.upper));
        const Floats width(band.inverse_width);
        const Floats part = (angle - Floats(band.lower)) * width;
        for (int c = 0; c < 3; ++c)
            out.channel[c] = select(
                here, mul_add(part, Floats(band.step[c]), Floats(band.color[c])), out.channel[c]);
        const Floats error =
            mul_add(angle_error * width, Floats(kSlack * band.step_most),
                    Floats(roundings(4) * band.most + roundings(4) * band.step_most));
        out.error = select(here, error, out.error);
        open = without(open, here) & (least > Floats(band.upper));
    }
    return out;
}

HWY_INLINE PixelColors gradient(const ShadingBackground& background, const Floats& y,
                                float sine_error) {
    const Floats one(1.0F);
    const Floats error(sine_error);  // then those of angles up to pi
    const Floats margin(kArcError + roundings(8));
    const Floats least = arc_cosine(min(y + error, one)) - margin;
    const Floats most = arc_cosine(max(y - error, -one)) + margin;
    const Floats half = (most - least) * Floats(0.5F) + Floats(roundings(4));
    const Floats from_zenith = (most + least) * Floats(0.5F);
    PixelColors out = banded(background.sky, from_zenith, half);
    if (!background.has_ground) return out;
    const Floats from_nadir = Floats(kPi) - from_zenith;
    const Floats margin_of_ground = half + Floats(roundings(8));
    const Floats end(background.ground_end);
    const RayMask may_be_ground = (y < Floats(0.0F)) & (from_nadir - margin_of_ground <= end);
    out.take(may_be_ground, banded(background.ground, from_nadir, margin_of_ground));
    const RayMask known =  // not at the horizon, nor where the ground ends
        without(abs(y) > error, may_be_ground & (from_nadir + margin_of_ground > end));
    out.error = select(known, out.error, Floats(kFloatInfinity));
    return out;
}

HWY_INLINE PixelColors background_colors(const ShadingTables& tables,
                                         const BlockDirections& directions) {
    const ShadingBackground& background = tables.background;
    if (background.kind == ShadingBackground::Kind::kGradient)
        return gradient(background, sine_of_height(directions), tables.rays.sine_error);
    PixelColors out;
    out.error = Floats(background.error);
    const bool blend = background.kind == ShadingBackground::Kind::kBlend;
    const Floats y = blend ? sine_of_height(directions) : Floats(0.0F);
    for (std::size_t c = 0; c < 3; ++c)
        out.channel[c] = blend
                             ? mul_add(y, Floats(background.slope[c]), Floats(background.middle[c]))
                             : Floats(background.middle[c]);
    return out;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_BACKGROUND_LANES_H_
