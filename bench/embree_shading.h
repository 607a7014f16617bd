#pragma once

#include <algorithm>
#include <cmath>

#include "float_scene.h"
#include "nuvo/image/image.h"

// The lighting of src/render/shading.cpp in single precision, as plain scalar code.

namespace nuvo::bench {

inline Float3 unit(const Float3& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// A light as a point sees it; strength 0: not at all.
struct FloatSample {
    Float3 to_light;
    float distance = 0;
    float strength = 0;
};

inline FloatSample sample(const FloatLight& light, const Float3& point) {
    if (light.kind == Light::Kind::kDirectional)
        return {-light.direction, std::numeric_limits<float>::infinity(), 1};
    const Float3 way = light.location - point;
    const float distance = std::sqrt(dot(way, way));
    if (!(distance > 0) || distance > light.radius) return {};
    const float d = distance * light.units_per_world;
    const Float3& c = light.attenuation;
    FloatSample out{way * (1 / distance), distance,
                    1 / std::max(c.x + c.y * d + c.z * d * d, 1.0F)};
    if (light.kind == Light::Kind::kSpot) {
        const float cosine = std::clamp(-dot(out.to_light, light.direction), 0.0F, 1.0F);
        const float angle = std::acos(cosine);
        if (angle >= light.cut_off_angle) return {};
        if (angle > light.beam_width)
            out.strength *=
                (angle - light.cut_off_angle) / (light.beam_width - light.cut_off_angle);
    }
    return out;
}

/// Whether the light can add anything to a point that it reaches, its cosine to the normal given.
inline bool adds_light(const FloatLight& light, const FloatMaterial& material, float cosine) {
    return cosine > 0 || light.ambient_intensity * material.ambient_intensity > 0 ||
           material.has_specular;
}

inline Float3 contribution(const FloatLight& light, const FloatMaterial& material,
                           const Float3& normal, const Float3& to_light, const Float3& to_viewer,
                           float strength) {
    const float cosine = std::max(0.0F, dot(normal, to_light));
    const float ambient = light.ambient_intensity * material.ambient_intensity;
    Float3 reflected = material.diffuse * (ambient + light.intensity * cosine);
    if (material.has_specular) {
        const Float3 halfway = unit(to_light + to_viewer);
        const float lobe = std::pow(std::max(0.0F, dot(normal, halfway)), material.exponent);
        reflected += material.specular * (light.intensity * lobe);
    }
    return light.color * reflected * strength;
}

inline std::uint8_t to_byte(float channel) {
    return static_cast<std::uint8_t>(std::clamp(channel, 0.0F, 1.0F) * 255 + 0.5F);
}

inline Rgb8 to_bytes(const Float3& color) {
    return {to_byte(color.x), to_byte(color.y), to_byte(color.z)};
}

inline Float3 background(const FloatScene& scene, float unit_y) {
    return scene.sky * ((unit_y + 1) / 2) + scene.ground * ((1 - unit_y) / 2);
}

}  // namespace nuvo::bench
