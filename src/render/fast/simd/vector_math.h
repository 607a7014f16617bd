// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_VECTOR_MATH_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_VECTOR_MATH_H_
#undef NUVO_RENDER_FAST_VECTOR_MATH_H_
#else
#define NUVO_RENDER_FAST_VECTOR_MATH_H_
#endif

#include "fast/simd/estimate_error.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Roots, powers and arcs of 16 floats at a time: range reduction by bits, then a polynomial (Muller
// 2016, "Elementary Functions", chapters 3 and 11). The coefficients are near-minimax, by
// interpolation in Chebyshev nodes. u is 2^-24, half the distance of 1 to the next float.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// 1 / sqrt(v) within kInverseSqrtError, relatively, of normal floats; of 0 and of infinity NaN, so
/// that nothing counts as known by a sum of squares beyond floats.
/// AVX-512's estimate e is within 2^-14: one Newton step leaves 1.5 * 2^-28, and the residual
/// 1 - v e e, whose two roundings count by half, and the last sum 2 u. Elsewhere: a root and a
/// quotient by v, each correctly rounded.
HWY_INLINE Floats inverse_sqrt(const Floats& v) {
#if HWY_TARGET == HWY_AVX3
    Floats out;
    for (std::size_t i = 0; i < Floats::Shape::kParts; ++i) {
        const auto e = hn::ApproximateReciprocalSqrt(v.part[i]);
        const auto half = hn::Mul(e, hn::Set(Floats::Tag(), 0.5F));
        const auto residual = hn::NegMulAdd(hn::Mul(v.part[i], e), e, hn::Set(Floats::Tag(), 1.0F));
        out.part[i] = hn::MulAdd(half, residual, e);
    }
    return out;
#else
    return sqrt(v) / v;
#endif
}

/// 1 / v within kReciprocalError, relatively, of floats with normal reciprocals, of infinity NaN:
/// the same with AVX-512's estimate of the reciprocal, whose step leaves 2^-28; elsewhere a
/// quotient.
HWY_INLINE Floats reciprocal(const Floats& v) {
#if HWY_TARGET == HWY_AVX3
    Floats out;
    for (std::size_t i = 0; i < Floats::Shape::kParts; ++i) {
        const auto e = hn::ApproximateReciprocal(v.part[i]);
        out.part[i] = hn::MulAdd(e, hn::NegMulAdd(v.part[i], e, hn::Set(Floats::Tag(), 1.0F)), e);
    }
    return out;
#else
    return Floats(1.0F) / v + (v - v);
#endif
}

template <std::size_t kCount>
HWY_INLINE Floats polynomial(const float (&coefficients)[kCount], const Floats& x) {
    Floats sum(coefficients[kCount - 1]);
    for (std::size_t i = kCount - 1; i-- > 0;) sum = mul_add(sum, x, Floats(coefficients[i]));
    return sum;
}

/// (1 - z)^exponent for 0 <= z < 1, exponent >= 0, within kPowerError (absolutely; 1.8 u measured
/// over 4 * 10^6 pairs). It is asked for the complement because a specular lobe is steep where 1 -
/// z would lose z's digits. log2(m 2^k) = k + f P(f), f = m - 1 = -z if k = 0, is within 3 u
/// relatively, the product y with the exponent 4 u; 2^y sees it times y ln 2, and 2^y |y| ln 2 <=
/// 0.37: 1.5 u; its own polynomial and scaling add 3 u. Below 2^-60 the result stays there:
/// subnormal numbers are slow.
inline constexpr float kPowerError = roundings(6);
HWY_INLINE Floats power_of_complement(const Floats& z, const Floats& exponent) {
    // log2(1 + f) / f on sqrt(1/2) - 1 .. sqrt(2) - 1, within 2^-27.6
    static constexpr float kLog[] = {
        1.44269504F,     -0.721347354479F, 0.480898520324F,  -0.360696541808F, 0.288552561437F,
        -0.23960812191F, 0.204857647786F,  -0.191388376567F, 0.184760333652F,  -0.107497894181F};
    // 2^x on -1/2 .. 1/2, within 2^-28.5
    static constexpr float kExp[] = {1.0F,
                                     0.693147206703F,
                                     0.240226509223F,
                                     0.0555032722667F,
                                     0.00961805667852F,
                                     0.00134004281776F,
                                     0.000154614446986F};
    constexpr std::int32_t kRootOfHalf = 0x3f3504f3;  // sqrt(1/2) as a float's bits
    constexpr std::int32_t kExponentBits = ~0x7fffff;
    constexpr float kSmallest = -60;
    constexpr float kToInteger = 0x1.8p23F;  // a float plus this has no fraction left

    const Ints bits = bits_of(Floats(1.0F) - z);
    const Ints power = (bits - Ints(kRootOfHalf)) & Ints(kExponentBits);
    const Floats k = floats_from(shift_right<23>(power));
    const Floats m = floats_of(bits - power);
    const Floats f = select(k == Floats(0.0F), -z, m - Floats(1.0F));
    const Floats log2 = mul_add(f, polynomial(kLog, f), k);

    const Floats y = max(log2 * exponent, Floats(kSmallest));
    const Floats shifted = y + Floats(kToInteger);
    const Floats whole = shifted - Floats(kToInteger);
    const Ints scale = shift_left<23>(bits_of(shifted));  // the low bits hold the integer
    return floats_of(bits_of(polynomial(kExp, y - whole)) + scale);
}

inline constexpr float kPi = 3.14159265F;

/// asin(s) / s as a polynomial in s^2 <= 1/4, within 2^-27.6.
inline constexpr float kArcSineByItsSine[] = {0.999999995984F,  0.166667820058F,  0.0749469668742F,
                                              0.0455206356317F, 0.0239939996536F, 0.0424173737598F};

/// The arc sine of 0 <= x <= 1/2, and of larger x <= 1 that of sqrt((1 - x) / 2), where 1 - x is
/// exact: asin(x) = pi / 2 - 2 asin(sqrt((1 - x) / 2)).
struct ReducedArc {
    RayMask is_rest;  ///< x > 1/2
    Floats arc;
};
HWY_INLINE ReducedArc reduced_arc(const Floats& x) {
    const RayMask upper = x > Floats(0.5F);
    const Floats square = select(upper, (Floats(1.0F) - x) * Floats(0.5F), x * x);
    const Floats s = select(upper, sqrt(square), x);
    return {upper, s * polynomial(kArcSineByItsSine, square)};
}

/// The arc sine of 0 <= x <= sqrt(1/2), within kArcSineError, relatively: above 1/2 it is at least
/// 0.52, off by pi's rounding, a difference and twice the arc's, of which the root has one
/// rounding, the polynomial and its product three.
inline constexpr float kArcSineError = roundings(16);
HWY_INLINE Floats arc_sine(const Floats& x) {
    const auto [is_rest, arc] = reduced_arc(x);
    return select(is_rest, Floats(kPi / 2) - arc - arc, arc);
}

/// The angle in 0..pi whose cosine is x, |x| <= 1, within kArcError (absolutely; 6.4 u measured
/// over 4 * 10^6 numbers): pi / 2 - asin(x). Of results near pi: pi's rounding 1.5 u, two
/// differences of 2 u, and twice the arc's.
inline constexpr float kArcError = roundings(8);
HWY_INLINE Floats arc_cosine(const Floats& x) {
    const auto [near_end, arc] = reduced_arc(abs(x));
    const RayMask negative = x < Floats(0.0F);
    const Floats inner = Floats(kPi / 2) - select(negative, -arc, arc);
    const Floats outer = select(negative, Floats(kPi) - arc - arc, arc + arc);
    return select(near_end, outer, inner);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_VECTOR_MATH_H_
