#include "compact_cut.h"

#include <algorithm>

#include "compact_sweep.h"

// Where to cut: through the centre [thesis 4.4.1] or by the sweep, where the axis is wide enough.

namespace nuvo {
namespace {

// An axis narrower than this part of the widest is cut only if the others part nothing, so that
// voxels stay about as wide as they are deep: slices of a flat scene's height would list all that
// stands upright in it again and again.
constexpr float kFlattest = 0.5F;

}  // namespace

std::optional<CutVoxel> choose_cut(CutRule rule, CutAxes axes, const Bounds3T<float>& voxel,
                                   ItemSpan items, BoxSpan boxes) {
    const Vec3<float> planes =
        rule == CutRule::kSweep ? sweep_planes(voxel, items, boxes) : voxel.center();
    const Vec3<float> widths = voxel.widths();
    const float narrowest = max_norm(widths) * kFlattest;
    float next = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (!(widths[axis] > narrowest)) next = std::max(next, widths[axis]);
    CutVoxel cut{voxel, voxel.max};
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
        const float plane = planes[axis];
        const bool chosen =
            axes == CutAxes::kWide ? widths[axis] > narrowest : widths[axis] == next;
        if (!(chosen && voxel.min[axis] < plane && plane < voxel.max[axis])) continue;
        cut.cut[axis] = plane;
        any = true;
    }
    if (!any) return std::nullopt;
    return cut;
}

}  // namespace nuvo
