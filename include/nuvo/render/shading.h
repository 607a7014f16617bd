#pragma once

#include <optional>

#include "nuvo/image/image.h"
#include "nuvo/scene/light.h"
#include "nuvo/scene/material.h"

namespace nuvo {

/// A light as a lit point sees it.
struct LightSample {
    Vector3 to_light;     ///< unit
    double strength = 0;  ///< attenuation times spot factor, > 0 [eq. 38-41]
};

/// The light's reach at `point`; none where it gives nothing there: beyond its radius, outside its
/// cone, without a direction, or exactly at the point.
std::optional<LightSample> sample_light(const Light& light, const Point3& point);

/// What a material makes of a light of strength 1 and color 1. [eq. 42-44]
struct LightTerms {
    Color ambient;
    Color diffuse;
    Color specular;
};
/// `normal` and `to_viewer` are unit vectors.
LightTerms light_terms(const Light& light, const LightSample& sample, const Material& material,
                       const Vector3& normal, const Vector3& to_viewer);

/// What an unblocked light adds: strength x color x (ambient + diffuse + specular). `normal` and
/// `to_viewer` are unit vectors. [eq. 37, 42-44; ISO/IEC 19775-1 17.2.2.4]
Color light_contribution(const Light& light, const LightSample& sample, const Material& material,
                         const Vector3& normal, const Vector3& to_viewer);

/// Clamped to 0..1 and rounded to the nearest of 0..255, ties up.
Rgb8 quantized(const Color& color);

}  // namespace nuvo
