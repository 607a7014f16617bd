#pragma once

#include <cstdint>

#include "fast/camera/camera_tables.h"

// Where in the picture a primitive can be seen, in whole pixels: most primitives of a dense scene
// show at few pixels or none, and 16 bytes tell so without the 64 of a camera table.

namespace nuvo {

/// Pictures whose sides are longer get boxes that rule nothing out.
inline constexpr int kMostBoxPixels = 65535;

/// Fills the boxes of spheres.
void make_sphere_boxes(InstructionSet isa, const CameraRays& camera, const CameraSphere* spheres,
                       std::size_t count, PixelBox* out);

}  // namespace nuvo
