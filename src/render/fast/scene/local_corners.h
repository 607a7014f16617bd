// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_LOCAL_CORNERS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_LOCAL_CORNERS_H_
#undef NUVO_RENDER_FAST_LOCAL_CORNERS_H_
#else
#define NUVO_RENDER_FAST_LOCAL_CORNERS_H_
#endif

#include <cstring>

#include "fast/scene/fast_scene.h"
#include "fast/simd/four_columns.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Asks for what load_corners() reads of a triangle.
HWY_INLINE void prefetch_corners(const LocalTriangle& triangle) {
    __builtin_prefetch(&triangle.corner[0]);
    __builtin_prefetch(&triangle.corner[8]);
}

/// The corners of 16 triangles by corner and axis; triangle_at(i) is the i-th one's LocalTriangle.
template <typename TriangleAt>
HWY_INLINE void load_corners(const TriangleAt& triangle_at, Floats (&at)[3][3]) {
    static_assert(sizeof(LocalTriangle) == sizeof(float[9]));
    // Numbers 0 to 3, 4 to 7 and 5 to 8 of each.
    constexpr std::size_t kFirst[3] = {0, 4, 5};
    alignas(64) std::int32_t fours[3][4 * FourColumns::kRecords];
    for (std::size_t i = 0; i < FourColumns::kRecords; ++i) {
        const LocalTriangle& triangle = triangle_at(i);
        for (int k = 0; k < 3; ++k)
            std::memcpy(fours[k] + 4 * FourColumns::place(i), triangle.corner + kFirst[k],
                        4 * sizeof(float));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const FourColumns columns(fours[k]);
        for (std::size_t c = k < 2 ? 0 : 3; c < 4; ++c)
            at[(kFirst[k] + c) / 3][(kFirst[k] + c) % 3] = floats_of(columns.column[c]);
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_LOCAL_CORNERS_H_
