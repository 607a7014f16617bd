#pragma once

#include <cstdint>
#include <limits>

#include "nuvo/math/vec.h"

namespace nuvo {

/// The objects a light may light: a half-open range of indices into Scene::objects. A group's
/// objects stand together in document order, so a scope is always one range.
struct LightScope {
    std::uint32_t first = 0;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();

    constexpr bool includes(std::uint32_t object) const { return first <= object && object < last; }
    friend bool operator==(const LightScope&, const LightScope&) = default;
};

/// An X3D light in world space (ISO/IEC 19775-1 clause 17). [thesis 4.2.1, 5.2.3]
struct Light {
    enum class Kind { kDirectional, kPoint, kSpot };

    Kind kind = Kind::kDirectional;
    Color color{1, 1, 1};
    double intensity = 1;             ///< >= 0
    double ambient_intensity = 0;     ///< 0..1
    Vector3 direction{0, 0, -1};      ///< unit, the way the light travels; zero: lights nothing
    Point3 location;                  ///< point and spot lights
    Vector3 attenuation{1, 0, 0};     ///< constant, linear, quadratic, in the light's own units
    double radius = 100;              ///< nothing is lit beyond it; world units
    double units_per_world = 1;       ///< the light's own length units in one world unit
    double beam_width = 0.785398;     ///< radians [eq. 41]
    double cut_off_angle = 1.570796;  ///< radians
    bool casts_shadow = true;         ///< false for the headlight only
    LightScope scope;

    friend bool operator==(const Light&, const Light&) = default;
};

}  // namespace nuvo
