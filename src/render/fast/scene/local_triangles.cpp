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

class LocalMaker {
  public:
    explicit LocalMaker(const LocalTrianglesJob& job)
        : job_(job), center_(wide(job.frame.center)), scale_(job.frame.scale) {}

    HWY_INLINE void make(const TriangleBatch& batch, Slot first, std::size_t count) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Wide3 local = (load_wide(batch.corner + 3 * i) - center_) * scale_;
            store_rounded(local.x, corners_[3 * i]);
            store_rounded(local.y, corners_[3 * i + 1]);
            store_rounded(local.z, corners_[3 * i + 2]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Column a = Column::load(corners_[axis]);
            const Column b = Column::load(corners_[axis + 3]);
            const Column c = Column::load(corners_[axis + 6]);
            const Column low = min(a, min(b, c));
            const Column high = max(a, max(b, c));
            (low - margin(low)).store(sides_[axis]);
            (high + margin(high)).store(sides_[axis + 3]);
        }
        job_.front_only[first / kBatch] =
            static_cast<std::uint8_t>(batch.front_only & ((1U << count) - 1));
        for (std::size_t i = 0; i < count; ++i) {
            LocalTriangle& triangle = job_.triangles[first + i];
            for (std::size_t k = 0; k < 9; ++k) triangle.corner[k] = corners_[k][i];
            job_.boxes[first + i] = {{sides_[0][i], sides_[1][i], sides_[2][i]},
                                     {sides_[3][i], sides_[4][i], sides_[5][i]}};
        }
    }

  private:
    static HWY_INLINE Column margin(const Column& v) {
        return abs(v) * Column(roundings(2)) + Column(std::numeric_limits<float>::min());
    }

    const LocalTrianglesJob& job_;
    Wide3 center_;
    Wide scale_;
    alignas(64) float corners_[9][kBatch];
    alignas(64) float sides_[6][kBatch];
};

void make_local(const LocalTrianglesJob& job, const TriangleChunk& chunk) {
    LocalMaker maker(job);
    chunk.for_each_batch([&](const TriangleBatch& batch, Slot first, std::size_t count)
                             HWY_ATTR { maker.make(batch, first, count); });
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void make_local_triangles(const LocalTrianglesJob& job, const TriangleChunk& chunk,
                          InstructionSet isa) {
    (NUVO_FOR_ISA(isa, make_local))(job, chunk);
}

}  // namespace nuvo
#endif
