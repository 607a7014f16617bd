#include "fast/shading/shading.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shading/shading_finish.cpp"
#include <hwy/foreach_target.h>

#include "fast/shading/background_lanes.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"

// From sums of light to bytes. Adding 1.5 * 2^23 rounds a float to an integer and leaves it in the
// lowest bits; what the sum has lost is the distance from the byte, and the byte is certain where
// that is less than 1/2 by more than the pixel's error.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class TileFinisher {
  public:
    TileFinisher(const ShadingTables& tables, const Tile& tile, const ShadingScratch& scratch)
        : tables_(tables), tile_(tile), scratch_(scratch) {}

    /// False: all lanes are certain.
    bool run(Image& image, TileMask& uncertain) {
        std::uint32_t any = 0;
        const bool in_range = tables_.background.in_range && tables_.sound;
        for (int b = 0; b < kTileBlocks; ++b) {
            const std::uint32_t inside = tile_.inside[b];
            const std::uint32_t hit = tile_.hit[b] & inside;
            std::uint32_t open = 0;
            if (inside != 0 && hit == 0 && in_range) {
                open = quantize<false>(
                    b, background_colors(tables_, BlockDirections(tables_, tile_, b)));
            } else if (inside != 0) {
                PixelColors pixels;
                if (hit != 0) pixels = surface_colors(b, hit);
                if (hit != inside) {
                    PixelColors behind =
                        background_colors(tables_, BlockDirections(tables_, tile_, b));
                    if (hit != 0) behind.take(RayMask::from_bits(hit), pixels);
                    pixels = behind;
                }
                open = quantize<true>(b, pixels) | (tables_.sound ? 0U : ~0U);
            }
            uncertain[b] = static_cast<std::uint16_t>(open & inside);
            any |= open & inside;
        }
        write(image);
        return any != 0;
    }

  private:
    // A row of the table of materials, or a different one in each lane.
    struct MaterialLanes {
        Floats diffuse[3];
        Floats emissive[3];
        Floats specular[3];
        Floats diffuse_most;
        Floats emissive_most;
        Floats specular_most;
    };

    /// `put(lanes, number)`: gives lanes the material's number.
    template <typename Put>
    HWY_INLINE static void take(const ShadingMaterial& m, MaterialLanes& out, const Put& put) {
        for (int c = 0; c < 3; ++c) {
            put(out.diffuse[c], m.diffuse[c]);
            put(out.emissive[c], m.emissive[c]);
            put(out.specular[c], m.specular[c]);
        }
        put(out.diffuse_most, m.diffuse_most);
        put(out.emissive_most, m.emissive_most);
        put(out.specular_most, m.specular_most);
    }
    HWY_INLINE static void take(const ShadingMaterial& m, MaterialLanes& out) {
        take(m, out, [](Floats& lanes, float number) HWY_ATTR { lanes = Floats(number); });
    }
    HWY_INLINE static void take(const ShadingMaterial& m, const RayMask& some, MaterialLanes& out) {
        take(m, out, [&](Floats& lanes, float number) HWY_ATTR {
            lanes = select(some, Floats(number), lanes);
        });
    }

    HWY_INLINE void find_materials(int b, std::uint32_t hit, MaterialLanes& out) const {
        if (tables_.uniform) {
            take(tables_.materials[0], out);
            return;
        }
        const SurfaceWord* words = scratch_.word + b * kBlockLanes;
        const Ints mine = Ints::load(words) & Ints(kMaterialMask);
        bool first = true;
        for (std::uint32_t rest = hit; rest != 0;) {
            const SurfaceWord material = words[std::countr_zero(rest)] & kMaterialMask;
            const auto same = mine == Ints(material);
            if (first)
                take(tables_.materials[material], out);
            else
                take(tables_.materials[material], mask_for<float>(same), out);
            first = false;
            rest &= ~same.bits();
        }
        if (scratch_.colored[b] != 0) take_colors(b, out);
    }

    // The interpolated color is the diffuse one, or if unlit the emissive one.
    HWY_INLINE void take_colors(int b, MaterialLanes& out) const {
        const int first = b * kBlockLanes;
        const RayMask colored = RayMask::from_bits(scratch_.colored[b]);
        const RayMask lit = RayMask::from_bits(scratch_.colored[b] & scratch_.lit_material[b]);
        const RayMask unlit =
            RayMask::from_bits(scratch_.colored[b] & ~scratch_.lit_material[b] & 0xffffU);
        Floats most(0.0F);
        for (int c = 0; c < 3; ++c) {
            const Floats color = Floats::load(scratch_.color[c] + first, colored);
            out.diffuse[c] = select(lit, color, out.diffuse[c]);
            out.emissive[c] = select(unlit, color, out.emissive[c]);
            most = max(most, color);
        }
        out.diffuse_most = select(lit, most, out.diffuse_most);
        out.emissive_most = select(unlit, most, out.emissive_most);
    }

    // [eq. 37] The color: emissive + diffuse x sum + specular x sum. To each channel's error the
    // roundings of the material's constants (1), of each sum of lights (one a light), products
    // and sums (2, or 3 with a specular part) add at most that many units of the color.
    HWY_INLINE PixelColors surface_colors(int b, std::uint32_t hit) const {
        const int first = b * kBlockLanes;
        MaterialLanes material;
        find_materials(b, hit, material);
        const bool specular = (tables_.any_flags & kSpecularFlag) != 0;
        const float rounding = kSlack * roundings(3 + static_cast<double>(tables_.lights.size()));
        PixelColors out;
        Floats brightest;
        sum(scratch_.diffuse, first, material.emissive, material.diffuse, out, brightest);
        Floats most = mul_add(material.diffuse_most, brightest, material.emissive_most);
        Floats light = brightest;
        Floats light_error = Floats::load(scratch_.diffuse_error + first);
        Floats error = material.diffuse_most * light_error;
        if (specular) {
            const Floats base[3] = {out.channel[0], out.channel[1], out.channel[2]};
            Floats highlight;
            sum(scratch_.specular, first, base, material.specular, out, highlight);
            most = mul_add(material.specular_most, highlight, most);
            error = mul_add(material.specular_most, Floats::load(scratch_.specular_error + first),
                            error);
        }
        out.error = mul_add(most, Floats(rounding), error * Floats(kSlack));
        if (scratch_.colored[b] != 0)
            out.error = mul_add(brightest + Floats(1.0F),
                                Floats(tables_.bounds.color_error * kSlack), out.error);
        else  // Without light the color is the table's, whose byte is certain.
            out.error = select(light_error + light == Floats(0.0F), Floats(0.0F), out.error);
        return out;
    }

    // base + factor x light by channel.
    HWY_INLINE void sum(const float (&light)[3][kTileLanes], int first, const Floats (&base)[3],
                        const Floats (&factor)[3], PixelColors& out, Floats& brightest) const {
        brightest = Floats::load(light[0] + first);
        Floats channel = brightest;
        for (int c = 0; c < 3; ++c) {
            if (c != 0 && tables_.channels == 3) {
                channel = Floats::load(light[c] + first);
                brightest = max(brightest, channel);
            }
            out.channel[c] = mul_add(factor[c], channel, base[c]);
        }
    }

    // Fills the block's bytes; returns the lanes that are not certain. Colors that may leave 0..255
    // have to be clamped. A pixel's three bytes are one integer below 2^24, exact in float.
    template <bool kClamped>
    HWY_INLINE std::uint32_t quantize(int b, const PixelColors& pixels) {
        constexpr float kToInteger = 0x1.8p23F;
        const Floats to_integer(kToInteger);
        Floats byte[3];
        Floats off[3];
        for (int c = 0; c < 3; ++c) {
            Floats v = pixels.channel[c];
            if constexpr (kClamped) v = min(max(v, Floats(0.0F)), Floats(255.0F));
            byte[c] = (v + to_integer) - to_integer;
            off[c] = abs(v - byte[c]);
        }
        const Floats packed =
            mul_add(mul_add(byte[2], Floats(256.0F), byte[1]), Floats(256.0F), byte[0]);
        store_packed(integers_from(packed), bytes_ + b * kBlockBytes);
        const Floats farthest = max(max(off[0], off[1]), off[2]);
        return (~(farthest < Floats(0.5F - kFloatRoundoff) - pixels.error)).bits();
    }

    static constexpr int kRowBytes = 3 * kBlockSide;  // of a block
    static constexpr int kPaddedRow = 16;
    static constexpr int kBlockBytes = kPaddedRow * kBlockSide;

    // Each row of 4 pixels to 12 bytes, padded to 16.
    static HWY_INLINE void store_packed(const Ints& packed, std::uint8_t* to) {
#if HWY_TARGET == HWY_SCALAR
        for (int lane = 0; lane < kBlockLanes; ++lane) {
            const auto pixel = static_cast<std::uint32_t>(hn::GetLane(packed.part[lane]));
            std::uint8_t* at = to + lane / kBlockSide * kPaddedRow + lane % kBlockSide * 3;
            for (int c = 0; c < 3; ++c) at[c] = static_cast<std::uint8_t>(pixel >> 8 * c);
        }
#else
        alignas(16) static constexpr std::uint8_t kOrder[16] = {0,  1,  2,  4,  5,  6,  8,  9,
                                                                10, 12, 13, 14, 15, 15, 15, 15};
        const hn::Repartition<std::uint8_t, Ints::Tag> bytes;
        const auto order = hn::LoadDup128(bytes, kOrder);
        for (std::size_t i = 0; i < Ints::Shape::kParts; ++i)
            hn::StoreU(hn::TableLookupBytes(hn::BitCast(bytes, packed.part[i]), order), bytes,
                       to + i * Ints::Shape::kPart * sizeof(std::int32_t));
#endif
    }

    void write(Image& image) const {
        const int width = image.width() - tile_.x;
        const int height = image.height() - tile_.y;
        const int rows = height < kTileSide ? height : kTileSide;
        for (int row = 0; row < rows; ++row) {
            auto* to = reinterpret_cast<std::uint8_t*>(&image.at(tile_.x, tile_.y + row));
            const std::uint8_t* from = bytes_ + row / kBlockSide * kBlockSide * kBlockBytes +
                                       row % kBlockSide * kPaddedRow;
            if (width >= kTileSide) {
                // The padding of one block's row is overwritten by the next.
                for (int i = 0; i < 3; ++i)
                    std::memcpy(to + i * kRowBytes, from + i * kBlockBytes, kPaddedRow);
                std::memcpy(to + 3 * kRowBytes, from + 3 * kBlockBytes, kRowBytes);
            } else {
                for (int x = 0; x < width; ++x)
                    std::memcpy(to + 3 * x,
                                from + x / kBlockSide * kBlockBytes + x % kBlockSide * 3, 3);
            }
        }
    }

    const ShadingTables& tables_;
    const Tile& tile_;
    const ShadingScratch& scratch_;
    alignas(64) std::uint8_t bytes_[kTileBlocks * kBlockBytes];
};

bool finish_tile_in(const ShadingTables& tables, const Tile& tile, const ShadingScratch& scratch,
                    Image& image, TileMask& uncertain) {
    return TileFinisher(tables, tile, scratch).run(image, uncertain);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void pick_finish_kernel(InstructionSet isa, ShadingKernels& kernels) {
    kernels.finish = NUVO_FOR_ISA(isa, finish_tile_in);
}

}  // namespace nuvo
#endif
