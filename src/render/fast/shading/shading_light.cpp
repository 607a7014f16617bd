#include "fast/shading/shading.h"

#include <bit>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shading/shading_light.cpp"
#include <hwy/foreach_target.h>

#include "fast/shading/light_lanes.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"

// One light at the surfaces of a tile, [eq. 37-44] term by term as shading.cpp has them, each with
// a bound on its error. Flat triangles take n.l from their table.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// One kind of light: directional or not.
template <bool kDirectional>
class LightSampler {
  public:
    LightSampler(const ShadingTables& tables, const Tile& tile, std::size_t light,
                 ShadingScratch& scratch)
        : tables_(tables),
          light_(tables.lights[light]),
          cosines_(tables.triangles.cosines[light]),
          exact_(tables.scene.scene().lights[light]),
          tile_(tile),
          scratch_(scratch),
          tint_rounding_(tables.channels == 1 ? 0 : roundings(2)) {}

    void run(TileMask& wanted) {
        for (int b = 0; b < kTileBlocks; ++b) {
            std::uint32_t lanes = light_.dead ? 0 : scratch_.lit_material[b];
            if (light_.scoped) lanes = in_scope(b, lanes);
            wanted[b] = static_cast<std::uint16_t>(lanes == 0 ? 0 : sample(b, lanes) & lanes);
        }
    }

  private:
    using Toward = std::conditional_t<kDirectional, NoToLight, ToLight>;

    std::uint32_t in_scope(int b, std::uint32_t lanes) const {
        for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
            const int lane = std::countr_zero(rest);
            const Slot slot = tile_.slot[b * kBlockLanes + lane];
            if (!exact_.scope.includes(tables_.scene.source(slot).object)) lanes ^= 1U << lane;
        }
        return lanes;
    }

    HWY_INLINE std::uint32_t sample(int b, std::uint32_t lanes) {
        const int first = b * kBlockLanes;
        const Toward toward(light_, tile_, first);
        const std::uint32_t smooth = cosines_.empty() ? 0xffff : scratch_.smooth[b];
        Lit lit{Floats(0.0F), Floats(0.0F)};
        if ((lanes & ~smooth) != 0) lit = flat(first, toward);
        if ((lanes & smooth) != 0) {
            const Lit other = by_normal(b, toward);
            const RayMask mask = RayMask::from_bits(smooth);
            lit = {select(mask, other.value, lit.value), select(mask, other.error, lit.error)};
        }
        // NaN is wanted; the sum has its sign exactly, and is NaN where both are infinite.
        RayMask wanted = ~(lit.value + lit.error <= Floats(0.0F));
        lit.value = max(lit.value, Floats(0.0F));
        if (light_.ambient > 0 && tables_.any_ambient) add_ambient(first, lit, wanted);
        Factor factor;
        bool weaker = false;
        if constexpr (!kDirectional) {
            weaker = light_.ranged || light_.attenuated || light_.spot;
            if (weaker) {
                factor = strength(light_, toward);
                lit.error = mul_add(lit.value, factor.error, lit.error);
                lit.value = lit.value * factor.value;
            }
        }
        if ((tables_.any_flags & kSpecularFlag) != 0)
            add_lobe(first, toward, weaker ? &factor : nullptr, wanted);
        if (weaker) wanted = wanted & factor.perhaps;
        lit.value.store(scratch_.shine + first);
        lit.error.store(scratch_.shine_error + first);
        return wanted.bits();
    }

    struct Lit {
        Floats value;
        Floats error;
    };

    // gain n.l of flat triangles. Directional: the table's rounding. Else the table's n.(L - a)
    // over |L - P|: also half a rounding for the triangle's plane, that of the product and those of
    // the inverse length.
    HWY_INLINE Lit flat(int first, const Toward& toward) const {
        const Ints slot = Ints::load(tile_.slot + first);
        const auto known = (slot > Ints(-1)) & (slot < Ints(tables_.scene.triangle_end()));
        const Floats cosine = Floats::gather(cosines_.data(), select(known, slot, Ints(0)));
        if constexpr (kDirectional) {
            return {cosine, mul_add(abs(cosine), Floats(roundings(1) + tint_rounding_),
                                    Floats(light_.cosine_error))};
        } else {
            const Floats value = cosine * toward.inverse;
            const Floats relative = toward.relative + Floats(roundings(3) + tint_rounding_);
            return {value, mul_add(abs(value), relative,
                                   mul_add(toward.inverse, Floats(light_.plane_error),
                                           Floats(light_.cosine_error)))};
        }
    }

    // Unit vectors n and l with their errors; n.l has 3 roundings of at most 1 each; the gain and
    // the product two more, relative to n.l (which also hands on a NaN).
    HWY_INLINE Lit by_normal(int b, const Toward& toward) const {
        const int first = b * kBlockLanes;
        Floats dot(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats n = Floats::load(tile_.normal[axis] + first);
            dot = mul_add(n, toward.unit(light_, axis), dot);
        }
        const Floats gain(light_.gain);
        const Floats error =
            normal_error(b) + direction_error(toward) + Floats(roundings(3) + tint_rounding_);
        return {dot * gain, mul_add(abs(dot), Floats(roundings(3)), error) * gain};
    }
    HWY_INLINE Floats normal_error(int b) const {
        constexpr float kTableError = roundings(1) + static_cast<float>(kTriangleNormalError);
        return select(RayMask::from_bits(scratch_.smooth[b]),
                      Floats::load(scratch_.normal_error + b * kBlockLanes), Floats(kTableError));
    }
    // Of the unit vector to the light.
    HWY_INLINE Floats direction_error(const Toward& toward) const {
        if constexpr (kDirectional)
            return Floats(roundings(1));
        else
            return toward.relative + Floats(roundings(1));
    }

    HWY_INLINE void add_ambient(int first, Lit& lit, RayMask& wanted) const {
        const Floats ambient =
            of_materials(first, &ShadingMaterial::ambient) * Floats(light_.ambient);
        wanted = wanted | (ambient > Floats(0.0F));
        lit.value = lit.value + ambient;
        lit.error = mul_add(lit.value, Floats(roundings(4) + tint_rounding_), lit.error);
    }
    HWY_INLINE Floats of_materials(int first, float ShadingMaterial::*member) const {
        if (tables_.uniform) return Floats(tables_.materials[0].*member);
        const Ints word = Ints::load(scratch_.word + first);
        constexpr int kFloatsLog2 = 4;
        static_assert(sizeof(ShadingMaterial) == sizeof(float) << kFloatsLog2);
        return Floats::gather(&(tables_.materials[0].*member),
                              shift_left<kFloatsLog2>(word & Ints(kMaterialMask)));
    }

    HWY_INLINE void add_lobe(int first, const Toward& toward, const Factor* factor,
                             RayMask& wanted) const {
        RayMask shiny = RayMask::from_bits((tables_.common_word & kSpecularFlag) ? 0xffff : 0);
        if (!tables_.uniform) {
            const Ints word = Ints::load(scratch_.word + first);
            shiny = mask_for<float>((word & Ints(kSpecularFlag)) != Ints(0));
        }
        Lobe lobe{Floats(0.0F), Floats(0.0F), shiny};
        if (shiny.any()) {
            Floats normal[3];
            Floats to_light[3];
            Floats to_viewer[3];
            for (int axis = 0; axis < 3; ++axis) {
                normal[axis] = Floats::load(tile_.normal[axis] + first);
                to_viewer[axis] = Floats::load(scratch_.view[axis] + first);
                to_light[axis] = toward.unit(light_, axis);
            }
            // The view's: d's own, 2 halves of |d|^2, the root's and the product's.
            const Floats directions_error =
                direction_error(toward) +
                Floats(tables_.rays.relative + roundings(1 + 1) + kInverseSqrtError);
            lobe = specular_lobe(normal, to_light, to_viewer, normal_error(first / kBlockLanes),
                                 directions_error, of_materials(first, &ShadingMaterial::exponent));
            lobe.perhaps = lobe.perhaps & shiny;
            const Floats gain(light_.gain);
            lobe.error =
                mul_add(lobe.value, Floats(roundings(3) + tint_rounding_), lobe.error) * gain;
            lobe.value = lobe.value * gain;
            if (factor != nullptr) {
                lobe.error = mul_add(lobe.value, factor->error, lobe.error);
                lobe.value = lobe.value * factor->value;
            }
        }
        wanted = wanted | lobe.perhaps;
        select(shiny, lobe.value, Floats(0.0F)).store(scratch_.lobe + first);
        select(shiny, lobe.error, Floats(0.0F)).store(scratch_.lobe_error + first);
    }

    const ShadingTables& tables_;
    const ShadingLight& light_;
    const BigVector<float>& cosines_;
    const Light& exact_;
    const Tile& tile_;
    ShadingScratch& scratch_;
    float tint_rounding_;
};

void sample_light_in(const ShadingTables& tables, const Tile& tile, std::size_t light,
                     ShadingScratch& scratch, TileMask& wanted) {
    if (tables.lights[light].directional)
        LightSampler<true>(tables, tile, light, scratch).run(wanted);
    else
        LightSampler<false>(tables, tile, light, scratch).run(wanted);
}

HWY_INLINE void add_to(float* sum, const Floats& term) { (Floats::load(sum) + term).store(sum); }

// Sums are rounded once a light: finish() counts that.
void add_light_in(const ShadingTables& tables, std::size_t light_index, const TileMask& lit,
                  ShadingScratch& scratch) {
    const ShadingLight& light = tables.lights[light_index];
    const bool specular = (tables.any_flags & kSpecularFlag) != 0;
    const Floats none(0.0F);
    for (int b = 0; b < kTileBlocks; ++b) {
        if (lit[b] == 0) continue;
        const int first = b * kBlockLanes;
        const RayMask mask = RayMask::from_bits(lit[b]);
        const auto add = [&](const float* terms, const float* errors, auto& sums,
                             float* sum_errors) HWY_ATTR {
            const Floats term = select(mask, Floats::load(terms + first), none);
            const Floats error = select(mask, Floats::load(errors + first), none);
            for (int c = 0; c < tables.channels; ++c)
                add_to(sums[c] + first, tables.channels == 1 ? term : term * Floats(light.tint[c]));
            add_to(sum_errors + first, error * Floats(light.tint_most));
        };
        add(scratch.shine, scratch.shine_error, scratch.diffuse, scratch.diffuse_error);
        if (specular)
            add(scratch.lobe, scratch.lobe_error, scratch.specular, scratch.specular_error);
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void pick_light_kernels(InstructionSet isa, ShadingKernels& kernels) {
    kernels.sample = NUVO_FOR_ISA(isa, sample_light_in);
    kernels.add = NUVO_FOR_ISA(isa, add_light_in);
}

}  // namespace nuvo
#endif
