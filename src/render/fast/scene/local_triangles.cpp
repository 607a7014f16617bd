#include "fast/scene/local_triangles.h"

#include <limits>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/scene/local_triangles.cpp"
#include <hwy/foreach_target.h>

#include "fast/simd/wide_vectors.h"

// Eight triangles at a time: moved and scaled in double, rounded to float, and boxes around what
// that gives, wider by one unit in the last place and more, at least by the smallest normal number.
// Local coordinates in double are off by a relative 2^-53 or an absolute 2^-1074, of which nothing
// matters here.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Column = Lanes<float, kBatch>;

HWY_INLINE Column margin(const Column& v) {
    return abs(v) * Column(roundings(2)) + Column(std::numeric_limits<float>::min());
}

void make_local(const LocalTrianglesJob& job, const TriangleChunk& chunk) {
    const Wide3 center = Wide3::all(job.frame.center);
    const Wide scale(job.frame.scale);
    alignas(64) float corners[9][kBatch];
    alignas(64) float sides[6][kBatch];
    chunk.for_each_batch([&](const TriangleBatch& batch, Slot first, std::size_t count) HWY_ATTR {
        for (std::size_t i = 0; i < 9; i += 3)
            store_rounded((Wide3::load(batch.corner + i) - center) * scale, corners + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Column a = Column::load(corners[axis]);
            const Column b = Column::load(corners[axis + 3]);
            const Column c = Column::load(corners[axis + 6]);
            const Column low = min(a, min(b, c));
            const Column high = max(a, max(b, c));
            (low - margin(low)).store(sides[axis]);
            (high + margin(high)).store(sides[axis + 3]);
        }
        job.front_only[first / kBatch] =
            static_cast<std::uint8_t>(batch.front_only & ((1U << count) - 1));
        for (std::size_t i = 0; i < count; ++i) {
            LocalTriangle& triangle = job.triangles[first + i];
            for (std::size_t k = 0; k < 9; ++k) triangle.corner[k] = corners[k][i];
            job.boxes[first + i] = {{sides[0][i], sides[1][i], sides[2][i]},
                                    {sides[3][i], sides[4][i], sides[5][i]}};
        }
    });
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void make_local_triangles(const LocalTrianglesJob& job, const TriangleChunk& chunk) {
    static const auto kernel = NUVO_FOR_ISA(resolved(InstructionSet::kBest), make_local);
    kernel(job, chunk);
}

}  // namespace nuvo
#endif
