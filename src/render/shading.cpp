#include "nuvo/render/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nuvo {
namespace {

// [eq. 38, 39]
double attenuation(const Light& light, double distance) {
    const double d = distance * light.units_per_world;
    const Vector3& c = light.attenuation;
    return 1 / std::max(c.x + c.y * d + c.z * d * d, 1.0);
}

// [eq. 40, 41] The cut-off is tested first, so that equal angles divide nothing by zero. The angle
// as its cosine alone would give it is off by 1e-8 near the axis: narrow cones came out in steps.
// Behind the light it counts as a right one. [numerics: angles]
double spot_factor(const Light& light, const Vector3& to_light) {
    const Vector3 from_light = -to_light;
    const double along = dot(from_light, light.direction);
    const double angle = along > 0 ? std::atan2(length(cross(from_light, light.direction)), along)
                                   : std::numbers::pi / 2;
    if (angle >= light.cut_off_angle) return 0;
    if (angle <= light.beam_width) return 1;
    return (angle - light.cut_off_angle) / (light.beam_width - light.cut_off_angle);
}

std::uint8_t quantized(double channel) {
    if (!(channel > 0)) return 0;
    return static_cast<std::uint8_t>(std::floor(std::min(channel, 1.0) * 255 + 0.5));
}

}  // namespace

std::optional<LightSample> sample_light(const Light& light, const Point3& point) {
    if (light.kind == Light::Kind::kDirectional) {
        if (light.direction == Vector3{}) return std::nullopt;
        return LightSample{-light.direction, 1};
    }
    const Vector3 way = light.location - point;
    const double distance = length(way);
    if (distance == 0 || distance > light.radius) return std::nullopt;
    LightSample sample{way / distance, attenuation(light, distance)};
    if (light.kind == Light::Kind::kSpot) {
        if (light.direction == Vector3{}) return std::nullopt;
        sample.strength *= spot_factor(light, sample.to_light);
    }
    if (!(sample.strength > 0)) return std::nullopt;
    return sample;
}

LightTerms light_terms(const Light& light, const LightSample& sample, const Material& material,
                       const Vector3& normal, const Vector3& to_viewer) {
    const double ambient = light.ambient_intensity * material.ambient_intensity;  // [eq. 42]
    const double diffuse = light.intensity * std::max(0.0, dot(normal, sample.to_light));  // [43]
    LightTerms terms{material.diffuse_color * ambient, material.diffuse_color * diffuse, {}};
    if (material.specular_color != Color{}) {  // [eq. 44]
        const Vector3 halfway = normalized(sample.to_light + to_viewer);
        const double cosine = std::max(0.0, dot(normal, halfway));
        const double lobe = std::pow(cosine, 128 * material.shininess);
        terms.specular = material.specular_color * (light.intensity * lobe);
    }
    return terms;
}

Color light_contribution(const Light& light, const LightSample& sample, const Material& material,
                         const Vector3& normal, const Vector3& to_viewer) {
    const LightTerms terms = light_terms(light, sample, material, normal, to_viewer);
    const Color reflected = terms.ambient + terms.diffuse + terms.specular;
    return light.color * reflected * sample.strength;  // [eq. 37]
}

Rgb8 quantized(const Color& color) {
    return {quantized(color.x), quantized(color.y), quantized(color.z)};
}

}  // namespace nuvo
