#pragma once

#include <cstdint>
#include <optional>

#include "nuvo/scene/camera.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// How a camera shows the whole of a scene.
enum class Framing : std::uint8_t {
    kGood,
    kNothing,  ///< no part of any shape may be in the picture
    kCut,      ///< the picture's border, or the camera itself, cuts some shape
    kTiny,     ///< both ways the shapes' boxes fill less than a tenth of the shorter side
};

/// Of a perspective camera. A scene without shapes is framed well.
Framing framing(const Scene& scene, const Camera& camera, Resolution resolution);

/// A camera that shows the whole scene in the middle of nine tenths of any picture, as near as
/// that allows: along -z, or where the scene is less than a quarter as high as it is deep (a
/// ground, a plan) 30 degrees downwards. The field of view is the standard's. None where there is
/// nothing to show, or doubles do not reach.
std::optional<Camera> fitted_camera(const Scene& scene);

/// `camera` moved to `from` and turned so that `at` lies in the middle of the picture, +y upwards;
/// looking straight down -z is upwards, looking straight up +z. None where the points are one, or
/// doubles do not reach.
std::optional<Camera> aimed_camera(const Camera& camera, const Point3& from, const Point3& at);

}  // namespace nuvo
