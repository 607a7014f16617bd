#include "fast/camera/camera_tables.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/camera/pixel_boxes.cpp"
#include <hwy/foreach_target.h>

#include "fast/camera/pixel_box_lanes.h"

// The boxes of spheres, from their camera tables; those of triangles are made with their tables.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void make_boxes(const CameraRays& camera, const CameraSphere* spheres, std::size_t count,
                PixelBox* out) {
    const PixelBoxMaker maker(camera);
    for (std::size_t first = 0; first < count; first += PixelBoxMaker::kGroup)
        maker.spheres(spheres + first, out + first, std::min(PixelBoxMaker::kGroup, count - first));
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void make_sphere_boxes(InstructionSet isa, const CameraRays& camera, const CameraSphere* spheres,
                       std::size_t count, PixelBox* out) {
    (NUVO_FOR_ISA(isa, make_boxes))(camera, spheres, count, out);
}

}  // namespace nuvo
#endif
