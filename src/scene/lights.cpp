#include "lights.h"

#include <limits>
#include <numbers>

namespace nuvo::x3d {

namespace {

constexpr Range kQuarterTurn = up_to_angle(std::numbers::pi / 2);

/// Before 4.0 an intensity is at most 1 (ISO/IEC 19775-1 clause 17).
Range intensity_range(Version version) { return version < Version{4, 0} ? kUnit : kNotNegative; }

/// Lights without a `global` field (before 3.1) light everything; from then on its default depends
/// on the kind.
bool is_scoped(Light::Kind kind, const Fields& fields, Version version) {
    if (version < Version{3, 1}) return false;
    return !fields.boolean("global", kind != Light::Kind::kDirectional);
}

Vector3 read_direction(const Fields& fields, const Placement& placement) {
    const Vector3 direction =
        normalized(placement.to_world.vector(fields.vector("direction", {0, 0, -1})));
    if (direction == Vector3{}) fields.warn("direction", "of length zero lighting nothing");
    return direction;
}

void read_reach(const Fields& fields, const Placement& placement, const Defaults& defaults,
                Light& light) {
    light.location = placement.to_world.point(fields.vector("location", {}));
    light.attenuation = fields.clamped_vector("attenuation", {1, 0, 0}, kNotNegative);
    double radius = fields.number("radius", light.radius);
    if (radius < 0) {
        fields.reject("radius", "is negative");
        radius = light.radius;
    }
    light.radius = defaults.has_light_radius ? radius * placement.length_scale
                                             : std::numeric_limits<double>::max();
    if (placement.length_scale > 0)
        light.units_per_world = 1 / placement.length_scale;
    else
        fields.warn("radius", "shrunk to zero by a singular transform");
}

void read_cone(const Fields& fields, Version version, const Defaults& defaults, Light& light) {
    const double beam_width = version < Version{4, 0} ? 0.785398 : 0.589049;
    light.beam_width = fields.clamped_number(
        "beamWidth", defaults.beam_width_rad.value_or(beam_width), kQuarterTurn);
    light.cut_off_angle = fields.clamped_number(
        "cutOffAngle", defaults.cut_off_angle_rad.value_or(1.570796), kQuarterTurn);
}

}  // namespace

std::optional<PlacedLight> read_light(Light::Kind kind, const Fields& fields,
                                      const Placement& placement, Version version,
                                      const Defaults& defaults) {
    const bool on = fields.boolean("on", true);
    PlacedLight placed;
    Light& light = placed.light;
    light.kind = kind;
    light.color = fields.clamped_vector("color", {1, 1, 1}, kUnit);
    light.intensity = fields.clamped_number("intensity", 1, intensity_range(version));
    light.ambient_intensity =
        fields.clamped_number("ambientIntensity", defaults.light_ambient_intensity, kUnit);
    if (kind != Light::Kind::kPoint) light.direction = read_direction(fields, placement);
    if (kind != Light::Kind::kDirectional) read_reach(fields, placement, defaults, light);
    if (kind == Light::Kind::kSpot) read_cone(fields, version, defaults, light);
    placed.scoped = is_scoped(kind, fields, version);
    if (!on) return std::nullopt;
    return placed;
}

bool may_reach(const Light& light, const Bounds3& box) {
    const Point3 nearest = min(max(light.location, box.min), box.max);
    constexpr double kRoundings = 1 + 1e-9;
    return length(nearest - light.location) <= light.radius * kRoundings;
}

}  // namespace nuvo::x3d
