#include "fast/tile/tile.h"

namespace nuvo {

CameraRays::CameraRays(const Camera& camera, Resolution size, const LocalFrame& frame)
    : resolution(size),
      rays(camera, size),
      origin(frame.local(camera.position)),
      forward(camera.forward),
      right(rays.step_right()),
      down(rays.step_down()) {}

}  // namespace nuvo
