#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast/camera/camera_tables.h"
#include "fast/scene/fast_scene.h"
#include "fast/scene/triangle_chunk.h"
#include "fast/shading/shading_rays.h"
#include "fast/tile/tile.h"
#include "fast/tile/triangle_set.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/error_bounds.h"

// What shading knows of a picture before its first pixel: materials, lights and background in float
// with bounds on their errors, and for each triangle and light one number. On a flat triangle n.l
// of a directional light is constant, and that of a point light is n.(L - a) / |L - P| with a
// constant numerator: so most pixels need neither their normal nor a product with it.

namespace nuvo {

/// Bounds |n - n'| of a triangle's normals as a table and as surface_point() compute them (see
/// shading_cosines.cpp).
inline constexpr double kTriangleNormalError = 0x1p-34;
/// Bounds how far off its plane a triangle's points may lie by such a normal's error, unless half a
/// float's roundoff of the light's distance from the plane allows more; in the local frame.
/// [numerics: light on flat triangles]
inline double plane_error(const LocalFrame& frame) {
    constexpr double kShare = 0x1p-29;  // of the dense place, or of what counts as one
    constexpr double kLeastPlace = 0x1p-12;
    return kShare * std::fmax(4 * frame.dense, kLeastPlace);
}
/// Outweighs second-order terms and the roundings of a bound's own computation.
inline constexpr float kSlack = 1.02F;
/// 1 / (1 - x) <= 1 + kSecondOrder x for x < kSmall.
inline constexpr float kSmall = 1.0F / 16;
inline constexpr float kSecondOrder = 1.07F;

/// A material, its colors times 255.
struct ShadingMaterial {
    float diffuse[3];
    float emissive[3];  ///< alone it rounds to the right byte, surely
    float specular[3];
    float diffuse_most;   ///< the largest channel
    float emissive_most;  ///< its units also cover what `emissive` is off to be sure
    float specular_most;
    float ambient;
    float exponent;  ///< of the specular lobe
    float padding[2];
};
static_assert(sizeof(ShadingMaterial) == 64);

/// What a lane shows: index of a material (low bits) and flags.
using SurfaceWord = std::uint32_t;
inline constexpr SurfaceWord kMaterialMask = (1U << 24) - 1;
inline constexpr SurfaceWord kUnlitFlag = 1U << 24;
inline constexpr SurfaceWord kSmoothFlag = 1U << 25;   ///< has interpolated normals
inline constexpr SurfaceWord kColoredFlag = 1U << 26;  ///< has interpolated colors
inline constexpr SurfaceWord kSpecularFlag = 1U << 27;

/// A light in the local frame. Its gain holds its intensity, and its color if that is gray.
struct ShadingLight {
    bool directional = false;
    bool spot = false;
    bool attenuated = false;  ///< anywhere in the scene
    bool ranged = false;      ///< its radius ends within the scene
    bool scoped = false;      ///< not all objects are in its scope
    bool dead = false;        ///< lights nothing
    float location[3] = {};
    float location_error = 0;  ///< bounds |location - true location|
    float toward[3] = {};      ///< directional: unit vector to the light
    float axis[3] = {};        ///< spot: unit vector along its beam
    double exact_gain = 0;
    float gain = 0;
    float ambient = 0;                 ///< ambient intensity, times its color if that is gray
    float tint[3] = {1, 1, 1};         ///< its color, unless it is gray
    float tint_most = 1;               ///< the largest channel
    float attenuation[3] = {1, 0, 0};  ///< in local lengths
    float radius = 0;                  ///< local
    float cut_off = 0;
    float inverse_width = 0;  ///< 1 / (cut_off - the beam's width); infinite: a sharp edge
    float cosine_error = 0;   ///< of ShadingTriangles::cosines: absolute, beside one rounding;
                              ///< not directional: once divided by |L - P|
    float plane_error = 0;    ///< not directional: before that, and half a rounding
};

/// The interpolated normal of a triangle as a function of the pixel, but for its length: in the
/// pixel coordinates X, Y of CameraRays it is along at + right * (X - x) + down * (Y - y), because
/// the weights of its corners are quotients of affine functions with one denominator. Turned as
/// shading_normal() turns it; NaN where double is not enough to know. x, y is near the triangle.
struct alignas(64) SmoothTriangle {
    static constexpr std::size_t kNumbers = 14;

    float at[3];
    float right[3];
    float down[3];
    float x;
    float y;
    float error;  ///< of the sum: this + error_right |X - x| + error_down |Y - y|
    float error_right;
    float error_down;
    float padding[2];
};
static_assert(sizeof(SmoothTriangle) == 64);

/// What shading knows of each triangle. Of flat ones that are solid it does not depend on the
/// camera, so it is good for the next picture, too.
struct ShadingTriangles {
    TriangleSet known;             ///< filled in
    BigVector<SurfaceWord> words;  ///< by slot; empty: all are the same
    /// By light and slot of a flat triangle: gain times n.l (directional) or n.(L - a), n turned as
    /// shading_normal() turns it; NaN where double is not enough to know. Empty: use normals.
    std::vector<BigVector<float>> cosines;
    BigVector<float> normals;                   ///< x, y, z, 0 by slot; empty: never asked for
    BigVector<SmoothTriangle> smooth;           ///< of the meshes with interpolated normals
    std::vector<std::uint32_t> smooth_offsets;  ///< by object: place of a slot is slot - offset
    bool depend_on_camera = false;
    Camera camera;  ///< for which they were made
    Resolution resolution;

    std::size_t memory_bytes() const;
};

/// A gradient between two angles from the pole, times 255: color + step * (angle - lower).
struct BackgroundBand {
    float upper = 0;
    float lower = 0;
    float inverse_width = 0;
    float color[3] = {};
    float step[3] = {};
    float most = 0;  ///< bounds all channels
    float step_most = 0;
};

/// The background times 255.
struct ShadingBackground {
    enum class Kind : std::uint8_t { kConstant, kBlend, kGradient };
    Kind kind = Kind::kConstant;
    float middle[3] = {};   ///< kConstant; kBlend: at the horizon
    float slope[3] = {};    ///< kBlend: by the sine of the height
    float error = 0;        ///< bounds the errors in units of a byte
    bool in_range = false;  ///< colors surely stay below 255 and a half, and above -1 / 2
    bool has_ground = false;
    float ground_end = 0;             ///< the angle from the nadir beyond which the sky shows
    std::vector<BackgroundBand> sky;  ///< never empty for a gradient; the last has no end
    std::vector<BackgroundBand> ground;
};

/// How far floats may be off in one picture.
struct ShadingBounds {
    float point_constant = 0;  ///< |P in float - P| <= this + t (point_by_t + ...) + P's rounding;
    float point_by_t = 0;      ///< of a parallel projection with |q| for t
    float world_rounding = 0;  ///< what P itself may be off for being rounded in world space
    float color_error = 0;     ///< of interpolated colors, times 255
};

struct ShadingTables {
    /// Keeps references. What it holds for each triangle fill() or fill_all() fills in, as far as
    /// `kept`, made for the same scene and lights, does not serve.
    ShadingTables(const FastScene& scene, const CameraRays& camera, const CameraTables& quadrics,
                  InstructionSet isa, std::optional<ShadingTriangles> kept = std::nullopt);

    /// The word of that object's primitives.
    SurfaceWord word_of(const Object& object) const;

    /// What is not known yet of some triangles.
    void fill(const TriangleSet& some, int threads);

    /// Of all.
    void fill_all(int threads);

    /// Fills in those of a chunk; by several threads at a time. (shading_cosines.cpp)
    void take(const TriangleChunk& chunk);

    std::size_t memory_bytes() const;

    const FastScene& scene;
    const CameraRays& camera;
    InstructionSet isa;
    const CameraTables& quadrics;
    ShadingRays rays;
    std::vector<ShadingMaterial> materials;   ///< without repetition
    std::vector<SurfaceWord> material_words;  ///< by index into Scene::materials
    SurfaceWord common_word = 0;              ///< of all primitives, if they are the same
    bool uniform = true;                      ///< all primitives have common_word
    SurfaceWord any_flags = 0;                ///< of any primitive
    int channels = 1;                         ///< of sums of light: 1 if all lights are gray
    bool any_ambient = false;                 ///< of a light and a material
    bool sound = true;  ///< false: a number is out of range, every pixel is for the fallback
    std::vector<ShadingLight> lights;
    ShadingBackground background;
    ShadingBounds bounds;
    ShadingTriangles triangles;
};

}  // namespace nuvo
