#pragma once

#include <optional>

#include "fields.h"
#include "nuvo/math/bounds.h"
#include "nuvo/scene/defaults.h"
#include "nuvo/scene/light.h"
#include "placement.h"
#include "version.h"

namespace nuvo::x3d {

struct PlacedLight {
    Light light;
    bool scoped = false;  ///< lights only its own group and what is below it
};

/// Reads a DirectionalLight, PointLight or SpotLight in world space, its scope still open; nothing
/// when it is off.
std::optional<PlacedLight> read_light(Light::Kind kind, const Fields& fields,
                                      const Placement& placement, Version version,
                                      const Defaults& defaults);

/// False where the radius of a light with a location surely ends before the box.
bool may_reach(const Light& light, const Bounds3& box);

}  // namespace nuvo::x3d
