// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_LIGHT_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_LIGHT_LANES_H_
#undef NUVO_RENDER_FAST_LIGHT_LANES_H_
#else
#define NUVO_RENDER_FAST_LIGHT_LANES_H_
#endif

#include "fast/shading/shading.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"
#include "nuvo/math/error_bounds.h"

// Geometry of one light at 16 points: direction, attenuation, spot and specular lobe [eq. 38-44].
// In the comments u is 2^-24, and numbers of u count roundings.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The relative error that an error of `x` of a vector of length 1 gives its direction and, the
/// inverse of, its length; infinite where that is not small.
HWY_INLINE Floats small_error(const Floats& x) {
    return select(x < Floats(kSmall), x * Floats(kSecondOrder), Floats(kFloatInfinity));
}

/// To a directional light: the same from everywhere.
struct NoToLight {
    HWY_INLINE NoToLight(const ShadingLight&, const Tile&, int) {}
    HWY_INLINE Floats unit(const ShadingLight& light, int axis) const {
        return Floats(light.toward[axis]);
    }
};

/// From points to a point or spot light.
struct ToLight {
    HWY_INLINE ToLight(const ShadingLight& light, const Tile& tile, int first) {
        square = Floats(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            to[axis] = Floats(light.location[axis]) - Floats::load(tile.point[axis] + first);
            square = mul_add(to[axis], to[axis], square);
        }
        inverse = inverse_sqrt(square);
        const Floats error = Floats::load(tile.point_error + first) + Floats(light.location_error);
        // The difference 1 u, 3 u of the square by half, and the root.
        relative = small_error(error * inverse) + Floats(roundings(1 + 1.5) + kInverseSqrtError);
    }

    /// The unit vector to the light.
    HWY_INLINE Floats unit(const ShadingLight&, int axis) const { return to[axis] * inverse; }

    Floats to[3];
    Floats square;
    Floats inverse;   ///< 1 / length
    Floats relative;  ///< bounds the relative error of `inverse`, and that of `to` as a direction
};

/// What weakens a light, in 0..1.
struct Factor {
    Floats value;
    Floats error;
    RayMask perhaps;  ///< false: surely beyond the radius or outside of the cone
};

/// [eq. 40, 41] The factor falls with the angle, so its ends are those of the angle's bounds. The
/// angle is twice the arc sine of half the chord between the unit vectors, which near the axis
/// keeps its digits. [numerics: angles]
HWY_INLINE void weaken_by_cone(const ShadingLight& light, const ToLight& toward, Factor& factor) {
    Floats square(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        const Floats chord = mul_add(toward.to[axis], toward.inverse, Floats(light.axis[axis]));
        square = mul_add(chord, chord, square);
    }
    const Floats chord = sqrt(square);
    // Of a length up to 1.42: the way's, those of the axis and the product (1 each), of the
    // difference (1.42), of the square by half and of the root (2.5 x 1.42).
    const Floats error = toward.relative + Floats(roundings(7));
    // Behind the light it is a right angle.
    const auto angle = [](const Floats& c) HWY_ATTR {
        constexpr float kRootOfHalf = 0.70710678F;
        const Floats half = min(max(c * Floats(0.5F), Floats(0.0F)), Floats(kRootOfHalf));
        const Floats arc = arc_sine(half);
        return arc + arc;
    };
    // The limit's rounding, and those of differences from it.
    const Floats margin(roundings(3) * light.cut_off);
    // Bounds of arcs that round a little more than arc_sine() does.
    const Floats least = angle(chord - error) * Floats(1 - 2 * kArcSineError) - margin;
    const Floats most = angle(chord + error) * Floats(1 + 2 * kArcSineError) + margin;
    const Floats one(1.0F);
    Floats high;
    Floats low;
    if (light.inverse_width < kFloatInfinity) {
        const auto part = [&](const Floats& a) HWY_ATTR {
            const Floats inside = (Floats(light.cut_off) - a) * Floats(light.inverse_width);
            return min(max(inside, Floats(0.0F)), one);
        };
        high = part(least);
        low = part(most);
    } else {
        high = select(least < Floats(light.cut_off), one, Floats(0.0F));
        low = select(most < Floats(light.cut_off), one, Floats(0.0F));
    }
    const Floats middle = (high + low) * Floats(0.5F);
    const Floats half = (high - low) * Floats(0.5F) + Floats(roundings(4));
    factor.error = factor.error + half;
    factor.value = factor.value * middle;
    // NaN ends where nothing is known.
    const RayMask known = toward.relative < one;
    factor.error = select(known, factor.error, Floats(kFloatInfinity));
    factor.perhaps = factor.perhaps & (~known | (high > Floats(0.0F)));
}

/// Radius, attenuation and cone.
HWY_INLINE Factor strength(const ShadingLight& light, const ToLight& toward) {
    Factor factor{Floats(1.0F), Floats(0.0F), RayMask::from_bits(0xffff)};
    const Floats distance = toward.square * toward.inverse;
    const Floats relative = toward.relative + Floats(roundings(2));
    if (light.ranged) {
        const Floats slack = distance * (relative + Floats(roundings(2)));
        factor.perhaps = ~(distance - slack > Floats(light.radius));
        factor.error =
            select(distance + slack < Floats(light.radius), Floats(0.0F), Floats(kFloatInfinity));
    }
    if (light.attenuated) {  // [eq. 38, 39]
        const Floats loss =
            mul_add(mul_add(Floats(light.attenuation[2]), distance, Floats(light.attenuation[1])),
                    distance, Floats(light.attenuation[0]));
        factor.value = reciprocal(max(loss, Floats(1.0F)));
        // At most quadratic in the distance; 5 roundings of the polynomial, 2 of the inverse; all
        // less than 3 kSmall, or not small.
        constexpr float kInverseSlope = 1 / (1 - 3 * kSmall);
        const Floats error = mul_add(relative, Floats(2.0F), Floats(roundings(8)));
        factor.error = mul_add(factor.value * Floats(kInverseSlope), error, factor.error);
    }
    if (light.spot) weaken_by_cone(light, toward, factor);
    return factor;
}

/// max(0, n.h)^exponent. [eq. 44]
struct Lobe {
    Floats value;
    Floats error;
    RayMask perhaps;  ///< false: surely zero
};

/// n.h of unit vectors is 1 - z, z = |n - h|^2 / 2: near the highlight's middle, where the power is
/// steep, the error of z is that of n - h times |n - h|, many times less than that of a product.
/// `directions_error` is the sum of those of toward and to_viewer.
HWY_INLINE Lobe specular_lobe(const Floats (&normal)[3], const Floats (&toward)[3],
                              const Floats (&to_viewer)[3], const Floats& normal_error,
                              const Floats& directions_error, const Floats& exponent) {
    constexpr float kBelowOne = 1 - kFloatRoundoff;
    constexpr float kTiny = 0x1p-100F;  // keeps the root of 0 finite
    const Floats one(1.0F);
    Floats sum[3];
    Floats square(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        sum[axis] = toward[axis] + to_viewer[axis];
        square = mul_add(sum[axis], sum[axis], square);
    }
    const Floats inverse = inverse_sqrt(square);
    // The sum's rounding (of a length up to 2); the square's 3 u by half, the root, the product.
    const Floats halfway_error = small_error((directions_error + Floats(roundings(2))) * inverse) +
                                 Floats(roundings(1.5 + 1) + kInverseSqrtError);
    Floats between(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        const Floats difference = neg_mul_add(sum[axis], inverse, normal[axis]);
        between = mul_add(difference, difference, between);
    }
    const Floats z = between * Floats(0.5F);
    const Floats length = between * above_inverse_sqrt(between + Floats(kTiny));
    const Floats error = normal_error + halfway_error;
    const Floats z_error =
        mul_add(length, error, mul_add(error, error, z * Floats(roundings(6)))) * Floats(kSlack);

    const Floats cosine = one - z;
    const Floats power = power_of_complement(min(z, Floats(kBelowOne)), exponent);
    const Floats steep = exponent * z_error;
    const RayMask regular = (steep < cosine * Floats(kSmall)) & (z_error < cosine * Floats(kSmall));
    // Where the cosine is not far above its error: max(0, x)^e on x <= 1 has no slope above e >= 1.
    const Floats lipschitz = select(exponent >= one, steep, Floats(kFloatInfinity));
    Lobe lobe;
    lobe.value = power;
    lobe.error = select(regular, power * (steep / cosine) * Floats(kSecondOrder), lipschitz) +
                 Floats(kPowerError + roundings(1));
    lobe.perhaps = ~(z - z_error > one);
    const RayMask even = exponent == Floats(0.0F);  // x^0 is 1
    lobe.value = select(even, one, lobe.value);
    lobe.error = select(even, Floats(0.0F), lobe.error);
    lobe.perhaps = lobe.perhaps | even;
    return lobe;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_LIGHT_LANES_H_
