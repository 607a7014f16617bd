#include "compact_cut.h"

// Where to cut. Spatial: the centre. [thesis 4.4.1]

namespace nuvo {
namespace {

// Strictly inside, or the upper face for "not cut".
float inside_or_uncut(float plane, float low, float high) {
    return low < plane && plane < high ? plane : high;
}

}  // namespace

std::optional<CutVoxel> choose_cut(CutRule, const Bounds3T<float>& voxel, ItemSpan, BoxSpan) {
    CutVoxel cut{voxel, voxel.center()};
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
        cut.cut[axis] = inside_or_uncut(cut.cut[axis], voxel.min[axis], voxel.max[axis]);
        any |= cut.cut[axis] < voxel.max[axis];
    }
    if (!any) return std::nullopt;
    return cut;
}

}  // namespace nuvo
