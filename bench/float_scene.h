#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "nuvo/render/primitives.h"
#include "nuvo/scene/scene.h"

namespace nuvo::bench {

using Float3 = Vec3<float>;

/// A light in single precision; its constants are those of nuvo::Light.
struct FloatLight {
    Light::Kind kind = Light::Kind::kDirectional;
    Float3 color;  ///< times nothing
    float intensity = 1;
    float ambient_intensity = 0;
    Float3 direction;
    Float3 location;
    Float3 attenuation;
    float radius = 0;
    float units_per_world = 1;
    float beam_width = 0;
    float cut_off_angle = 0;
    bool casts_shadow = true;
};

/// A material in single precision.
struct FloatMaterial {
    Float3 diffuse;
    Float3 specular;
    Float3 emissive;
    float ambient_intensity = 0;
    float exponent = 0;  ///< of the specular lobe
    bool has_specular = false;
};

/// The scene in single precision, as a user of Embree would hold it: one mesh, one list of spheres.
struct FloatScene {
    std::vector<Float3> positions;  ///< one more than used, for loads of 16 bytes
    std::vector<IndexTriple> triangles;
    std::vector<Float3> normals;                ///< unit; empty: every triangle is flat
    std::vector<IndexTriple> normal_triangles;  ///< kFlat in the first: this triangle is flat
    std::vector<std::uint32_t> triangle_material;
    std::vector<std::array<float, 4>> spheres;  ///< centre and radius
    std::vector<std::uint32_t> sphere_material;
    std::vector<FloatMaterial> materials;
    std::vector<FloatLight> lights;
    Float3 sky;
    Float3 ground;
    Camera camera;
    float largest_coordinate = 0;  ///< of primitives and camera

    static constexpr std::uint32_t kFlat = ~std::uint32_t{0};
};

/// Converts what nuvo has read. Triangles keep the order of `primitives`, spheres theirs. Throws
/// std::invalid_argument for what this comparison does not draw: ellipsoids, vertex colors, unlit
/// materials, shapes that are not solid, scoped lights and gradients of several colors.
FloatScene to_float(const Scene& scene, const Primitives& primitives);

}  // namespace nuvo::bench
