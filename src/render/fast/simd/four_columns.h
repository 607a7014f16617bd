// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_FOUR_COLUMNS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_FOUR_COLUMNS_H_
#undef NUVO_RENDER_FAST_FOUR_COLUMNS_H_
#else
#define NUVO_RENDER_FAST_FOUR_COLUMNS_H_
#endif

#include <cstddef>
#include <cstdint>

#include "fast/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The numbers of 16 records of 4 by column. Squares of 4 x 4 are transposed within 128 bits
/// each; so record i has to stand at place(i).
struct FourColumns {
    static constexpr std::size_t kRecords = 16;
    static constexpr std::size_t place(std::size_t i) { return i % 4 * 4 + i / 4; }

    explicit HWY_INLINE FourColumns(const std::int32_t* numbers) {
#if HWY_TARGET == HWY_SCALAR
        for (std::size_t i = 0; i < kRecords; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                column[k].part[i] = hn::Set(Ints::Tag(), numbers[4 * place(i) + k]);
#else
        const Ints row[4] = {Ints::load(numbers), Ints::load(numbers + kRecords),
                             Ints::load(numbers + 2 * kRecords),
                             Ints::load(numbers + 3 * kRecords)};
        const Ints::Tag tag;
        const hn::Repartition<std::int64_t, Ints::Tag> pairs;
        const auto lower = [&](const auto& a, const auto& b) HWY_ATTR {
            return hn::BitCast(
                tag, hn::InterleaveLower(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
        };
        const auto upper = [&](const auto& a, const auto& b) HWY_ATTR {
            return hn::BitCast(
                tag, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
        };
        for (std::size_t i = 0; i < Ints::Shape::kParts; ++i) {
            const auto low_01 = hn::InterleaveLower(tag, row[0].part[i], row[1].part[i]);
            const auto low_23 = hn::InterleaveLower(tag, row[2].part[i], row[3].part[i]);
            const auto high_01 = hn::InterleaveUpper(tag, row[0].part[i], row[1].part[i]);
            const auto high_23 = hn::InterleaveUpper(tag, row[2].part[i], row[3].part[i]);
            column[0].part[i] = lower(low_01, low_23);
            column[1].part[i] = upper(low_01, low_23);
            column[2].part[i] = lower(high_01, high_23);
            column[3].part[i] = upper(high_01, high_23);
        }
#endif
    }

    Ints column[4];
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_FOUR_COLUMNS_H_
