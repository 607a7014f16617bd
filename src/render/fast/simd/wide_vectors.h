// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_WIDE_VECTORS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_WIDE_VECTORS_H_
#undef NUVO_RENDER_FAST_WIDE_VECTORS_H_
#else
#define NUVO_RENDER_FAST_WIDE_VECTORS_H_
#endif

#include <cstddef>
#include <cstring>

#include "fast/simd/vector_lanes.h"

// Vectors of 8 doubles, one for each triangle of a TriangleBatch, and the way from such columns to
// records of 16 floats side by side.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

inline constexpr std::size_t kBatch = 8;
using Wide = Lanes<double, kBatch>;

/// Each number rounded to the nearest float.
HWY_INLINE void store_rounded(const Wide& v, float* to) { floats_from(v).store(to); }

using Wide3 = VectorLanes<double, kBatch>;
template <std::size_t kColumn>
HWY_INLINE void store_rounded(const Wide3& v, float (*columns)[kColumn]) {
    store_rounded(v.x, columns[0]);
    store_rounded(v.y, columns[1]);
    store_rounded(v.z, columns[2]);
}
/// The numbers of a batch's records, [place / 4][place % 4][triangle].
struct alignas(64) RecordColumns {
    float at[4][4][kBatch];

    /// Record i of the first `count` goes to out[16 i] and on.
    HWY_INLINE void write(float* out, std::size_t count) const {
        if (count == kBatch) return transpose(out);
        alignas(64) float records[16 * kBatch];
        transpose(records);
        std::memcpy(out, records, 16 * sizeof(float) * count);
    }

  private:
    HWY_INLINE void transpose(float* out) const {
#if HWY_TARGET == HWY_SCALAR
        for (std::size_t i = 0; i < kBatch; ++i)
            for (std::size_t k = 0; k < 16; ++k) out[16 * i + k] = at[k / 4][k % 4][i];
#else
        const hn::FixedTag<float, 4> four;
        for (std::size_t i = 0; i < kBatch; i += 4) {
            for (std::size_t group = 0; group < 4; ++group) {
                const auto a = hn::Load(four, at[group][0] + i);
                const auto b = hn::Load(four, at[group][1] + i);
                const auto c = hn::Load(four, at[group][2] + i);
                const auto d = hn::Load(four, at[group][3] + i);
                const auto low_ab = hn::InterleaveLower(four, a, b);
                const auto low_cd = hn::InterleaveLower(four, c, d);
                const auto high_ab = hn::InterleaveUpper(four, a, b);
                const auto high_cd = hn::InterleaveUpper(four, c, d);
                float* const to = out + 16 * i + 4 * group;
                hn::StoreU(hn::ConcatLowerLower(four, low_cd, low_ab), four, to);
                hn::StoreU(hn::ConcatUpperUpper(four, low_cd, low_ab), four, to + 16);
                hn::StoreU(hn::ConcatLowerLower(four, high_cd, high_ab), four, to + 32);
                hn::StoreU(hn::ConcatUpperUpper(four, high_cd, high_ab), four, to + 48);
            }
        }
#endif
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_WIDE_VECTORS_H_
