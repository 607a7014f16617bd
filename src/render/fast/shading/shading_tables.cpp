#include "fast/shading/shading_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "fast/simd/estimate_error.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/render/shading.h"

namespace nuvo {
namespace {

constexpr double kFullByte = 255;
// More lights use normals: their tables would outgrow the caches.
constexpr std::size_t kLightsWithCosines = 8;

float rounded(double value) { return static_cast<float>(value); }
// Never 0 unless it is.
float rounded_off_zero(double value) {
    return value > 0 ? std::max(rounded(value), std::numeric_limits<float>::min()) : rounded(value);
}
double largest(const Color& c) { return std::max(c.x, std::max(c.y, c.z)); }
bool is_gray(const Color& c) { return c.x == c.y && c.y == c.z; }

// Colors are bounded by sums of terms that are not negative, and not too large for float.
bool is_sound(double value) { return value >= 0 && value < 0x1p60; }
bool is_sound(const Color& c) { return is_sound(c.x) && is_sound(c.y) && is_sound(c.z); }

void put(const Color& color, double factor, float (&out)[3]) {
    for (int c = 0; c < 3; ++c) out[c] = rounded(color[c] * factor);
}

// A color whose bytes are those of the exact one if nothing is added: where it is halfway between
// two bytes it is moved up a little, as ties go; floats up to 255 are multiples of half of that.
constexpr float kOffTie = 0x1p-15F;
bool put_surely(const Color& color, float (&out)[3]) {
    bool moved = false;
    const Rgb8 bytes = quantized(color);
    for (int c = 0; c < 3; ++c) {
        const int byte = c == 0 ? bytes.r : c == 1 ? bytes.g : bytes.b;
        out[c] = rounded(color[c] * kFullByte);
        const float off = out[c] - static_cast<float>(byte);
        if (out[c] > 255 || std::fabs(off) < 0.5F - kOffTie) continue;
        out[c] = static_cast<float>(byte) + (off < 0 ? kOffTie - 0.5F : 0.5F - kOffTie);
        moved = true;
    }
    return moved;
}

ShadingMaterial shading_material(const Material& m) {
    ShadingMaterial out{};
    out.emissive_most = rounded_up(largest(m.emissive_color) * kFullByte);
    // The error counts at least 3 units of emissive_most.
    if (put_surely(m.emissive_color, out.emissive))
        out.emissive_most += kOffTie / (3 * kFloatRoundoff);
    if (!m.lit) return out;
    put(m.diffuse_color, kFullByte, out.diffuse);
    put(m.specular_color, kFullByte, out.specular);
    out.diffuse_most = rounded_up(largest(m.diffuse_color) * kFullByte);
    out.specular_most = rounded_up(largest(m.specular_color) * kFullByte);
    out.ambient = rounded(m.ambient_intensity);
    // 0^0 is 1, and 0 to any other power 0. All exponents below the least normal number give 1 to
    // the last bit where the cosine is surely positive.
    out.exponent = rounded_off_zero(128 * m.shininess);
    return out;
}

using MaterialKey = std::array<double, 12>;
struct MaterialHash {
    std::size_t operator()(const MaterialKey& key) const {
        return std::hash<std::string_view>()(
            {reinterpret_cast<const char*>(key.data()), sizeof(key)});
    }
};

void add_materials(ShadingTables& tables) {
    std::unordered_map<MaterialKey, SurfaceWord, MaterialHash> known;
    for (const Material& m : tables.scene.scene().materials) {
        const bool specular = m.lit && m.specular_color != Color{};
        tables.sound = tables.sound && is_sound(m.diffuse_color) && is_sound(m.emissive_color) &&
                       is_sound(m.specular_color) && is_sound(m.ambient_intensity) &&
                       is_sound(m.shininess);
        const Color d = m.lit ? m.diffuse_color : Color{};
        const Color s = specular ? m.specular_color : Color{};
        const Color e = m.emissive_color;
        const MaterialKey key{d.x,
                              d.y,
                              d.z,
                              s.x,
                              s.y,
                              s.z,
                              e.x,
                              e.y,
                              e.z,
                              m.lit ? m.ambient_intensity : 0,
                              specular ? m.shininess : 0,
                              m.lit ? 1.0 : 0.0};
        const auto next = static_cast<SurfaceWord>(tables.materials.size());
        const auto [place, is_new] = known.try_emplace(key, next);
        if (is_new) tables.materials.push_back(shading_material(m));
        SurfaceWord word = place->second;
        if (!m.lit) word |= kUnlitFlag;
        if (specular) word |= kSpecularFlag;
        tables.any_flags |= word & ~kMaterialMask;
        tables.material_words.push_back(word);
    }
    tables.uniform = tables.materials.size() <= 1;
    if (tables.uniform && !tables.material_words.empty())
        tables.common_word = tables.material_words[0];
}

void place_smooth_triangles(const FastScene& scene, ShadingTriangles& triangles) {
    triangles.smooth_offsets.resize(scene.scene().objects.size());
    std::uint32_t object = ~0U;
    bool smooth = false;
    std::uint32_t count = 0;
    for (Slot slot = 0; slot < scene.triangle_end(); ++slot) {
        if (scene.source(slot).object != object) {
            object = scene.source(slot).object;
            smooth = !scene.mesh(scene.source(slot)).normals.empty();
            triangles.smooth_offsets[object] = slot - count;
        }
        if (smooth) ++count;
    }
    triangles.smooth.resize(count);
}

// Flags that only meshes have.
void add_mesh_flags(ShadingTables& tables) {
    if (tables.scene.triangle_end() == 0) return;
    double most = 0;
    for (const Object& object : tables.scene.scene().objects) {
        const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        if (!mesh) continue;
        if (!mesh->normals.empty()) tables.any_flags |= kSmoothFlag;
        if (mesh->colors.empty()) continue;
        tables.any_flags |= kColoredFlag;
        for (const Color& c : mesh->colors) {
            tables.sound = tables.sound && is_sound(c);
            most = std::max(most, largest(c));
        }
    }
    if ((tables.any_flags & (kSmoothFlag | kColoredFlag)) != 0) tables.uniform = false;
    // Weights in double, then one rounding of each sum.
    tables.bounds.color_error = rounded_up(roundings(2) * most * kFullByte);
}

// The farthest that a point of the scene is from `p`, in the local frame.
double farthest(const FastScene& scene, const Point3& p) {
    const Bounds3T<float>& box = scene.octree().bounds;
    if (box.empty()) return 0;
    Vector3 way;
    for (int axis = 0; axis < 3; ++axis)
        way[axis] = std::max(std::fabs(p[axis] - static_cast<double>(box.min[axis])),
                             std::fabs(static_cast<double>(box.max[axis]) - p[axis]));
    return length(way) * kSlack;
}

// What positions in the local frame may be off for being rounded in world space: those of
// surface_point(), which are within surface_tolerance(), and of `p`.
double world_rounding(const FastScene& scene, const Point3& p) {
    const LocalFrame& frame = scene.frame();
    const double world = max_norm(frame.center) * frame.scale;
    return std::sqrt(3.0) * kSlack *
           (surface_tolerance() * (world + 2) +
            4 * kUnitRoundoff * (world + max_norm(p) * frame.scale));
}

void place_light(const ShadingTables& tables, const Light& exact, ShadingLight& light) {
    const FastScene& scene = tables.scene;
    const double scale = scene.frame().scale;
    const Point3 location = scene.frame().local(exact.location);
    for (int axis = 0; axis < 3; ++axis) light.location[axis] = rounded(location[axis]);
    // Where floats can square the way.
    constexpr double kFarthest = 0x1p60;
    light.location_error = max_norm(location) < kFarthest
                               ? rounded_up(kSlack * (roundings(1) * length(location) +
                                                      world_rounding(scene, exact.location)))
                               : kFloatInfinity;
    const Vector3& a = exact.attenuation;
    light.attenuated = a.x > 1 || a.y != 0 || a.z != 0;
    const double unit = exact.units_per_world / scale;
    light.attenuation[0] = rounded(a.x);
    light.attenuation[1] = rounded(a.y * unit);
    light.attenuation[2] = rounded(a.z * unit * unit);
    const double reach = farthest(scene, location);
    light.ranged = !(exact.radius * scale > reach * kSlack);
    light.radius = rounded(exact.radius * scale);
    // What n.(L - a) is off by beside the normal's error times |L - P|.
    light.plane_error =
        rounded_up(light.exact_gain *
                   (plane_error(scene.frame()) + world_rounding(scene, exact.location)) * kSlack);
}

void aim_spot(const Light& exact, ShadingLight& light) {
    if (exact.direction == Vector3{}) light.dead = true;
    for (int axis = 0; axis < 3; ++axis) light.axis[axis] = rounded(exact.direction[axis]);
    light.cut_off = rounded_off_zero(exact.cut_off_angle);  // above 0 there is an inside
    light.inverse_width = exact.beam_width < exact.cut_off_angle
                              ? rounded(1 / (exact.cut_off_angle - exact.beam_width))
                              : kFloatInfinity;
}

ShadingLight shading_light(const ShadingTables& tables, const Light& exact) {
    ShadingLight light;
    const bool gray = is_gray(exact.color);
    const double factor = gray ? exact.color.x : 1;
    light.exact_gain = exact.intensity * factor;
    light.gain = rounded(light.exact_gain);
    light.ambient = rounded(exact.ambient_intensity * factor);
    if (!gray)
        for (int c = 0; c < 3; ++c) light.tint[c] = rounded(exact.color[c]);
    light.tint_most = gray ? 1 : rounded_up(largest(exact.color));
    light.dead = exact.color == Color{} || (exact.intensity == 0 && exact.ambient_intensity == 0);
    const std::size_t objects = tables.scene.scene().objects.size();
    light.scoped = exact.scope.first > 0 || exact.scope.last < objects;
    light.directional = exact.kind == Light::Kind::kDirectional;
    light.cosine_error = rounded_up(light.exact_gain * 2 * kTriangleNormalError);
    light.spot = exact.kind == Light::Kind::kSpot;
    if (light.directional) {
        if (exact.direction == Vector3{}) light.dead = true;
        for (int axis = 0; axis < 3; ++axis) light.toward[axis] = rounded(-exact.direction[axis]);
    } else {
        place_light(tables, exact, light);
    }
    if (light.spot) aim_spot(exact, light);
    return light;
}

void add_lights(ShadingTables& tables) {
    const Scene& scene = tables.scene.scene();
    bool ambient = false;
    for (const Light& exact : scene.lights) {
        tables.sound = tables.sound && is_sound(exact.color) && is_sound(exact.intensity) &&
                       is_sound(exact.ambient_intensity) && is_sound(exact.attenuation) &&
                       is_sound(exact.units_per_world / tables.scene.frame().scale);
        tables.lights.push_back(shading_light(tables, exact));
        if (!is_gray(exact.color)) tables.channels = 3;
        ambient = ambient || exact.ambient_intensity != 0;
    }
    for (const Material& m : scene.materials)
        tables.any_ambient = tables.any_ambient || (ambient && m.lit && m.ambient_intensity != 0);
}

void bound_points(ShadingTables& tables) {
    const ShadingRays& rays = tables.rays;
    ShadingBounds& bounds = tables.bounds;
    // P = o + t d: the rounding of o, and of the sum, which is added with P [fill_points]; of
    // 1 / q, the mean that is q (2 u) and the product. In a parallel projection o is off as rays'
    // starts are, and q is the mean itself.
    const CameraRays& camera = tables.camera;
    const double world = world_rounding(tables.scene, camera.anchor);
    const double origin = camera.parallel ? static_cast<double>(rays.start_error)
                                          : roundings(1) * length(camera.origin);
    bounds.point_constant = rounded_up(kSlack * (origin + world));
    const float estimate = camera.parallel ? 0 : kReciprocalError;
    bounds.point_by_t = rounded_up(kSlack * (static_cast<double>(roundings(2 + 1) + estimate) *
                                                 static_cast<double>(rays.longest) +
                                             static_cast<double>(rays.error)));
    bounds.world_rounding = rounded_up(kSlack * world);
}

// Room for all triangles, of which nothing is known.
ShadingTriangles unknown_triangles(const ShadingTables& tables) {
    const FastScene& scene = tables.scene;
    const std::size_t count = scene.triangle_end();
    ShadingTriangles triangles;
    triangles.known = TriangleSet(scene);
    if (!tables.uniform) triangles.words.resize(count);
    const bool few_lights = tables.lights.size() <= kLightsWithCosines;
    triangles.cosines.resize(tables.lights.size());
    for (std::size_t i = 0; i < tables.lights.size(); ++i)
        if (few_lights && !tables.lights[i].dead) triangles.cosines[i].resize(count);
    if ((tables.any_flags & kSpecularFlag) != 0 || !few_lights) triangles.normals.resize(4 * count);
    const bool smooth = count > 0 && (tables.any_flags & kSmoothFlag) != 0;
    if (smooth) place_smooth_triangles(scene, triangles);
    const std::vector<Object>& objects = scene.scene().objects;
    triangles.depend_on_camera =
        smooth || std::any_of(objects.begin(), objects.end(),
                              [](const Object& object) { return !object.solid; });
    triangles.camera = scene.scene().camera;
    triangles.resolution = tables.camera.resolution;
    return triangles;
}

std::vector<BackgroundBand> bands(const std::vector<Color>& colors,
                                  const std::vector<double>& angles) {
    std::vector<BackgroundBand> out;
    if (colors.empty()) return out;
    const std::size_t count = std::min(angles.size(), colors.size() - 1);
    double lower = 0;
    for (std::size_t i = 0; i <= count; ++i) {
        const bool last = i == count;
        const double upper = last ? kInfinity : angles[i];
        const bool flat = last || !(upper > lower);
        const Color& from = colors[last ? count : flat ? i + 1 : i];
        const Vector3 step = flat ? Vector3{} : colors[i + 1] - from;
        BackgroundBand band;
        band.upper = rounded(upper);
        band.lower = rounded(lower);
        band.inverse_width = flat ? 0 : rounded(1 / (upper - lower));
        put(from, kFullByte, band.color);
        put(step, kFullByte, band.step);
        band.step_most = rounded_up(max_norm(step) * kFullByte);
        band.most = rounded_up(max_norm(from) * kFullByte) + band.step_most;
        out.push_back(band);
        lower = upper;
    }
    return out;
}

void add_background(ShadingTables& tables) {
    const Background& exact = tables.scene.scene().background;
    ShadingBackground& out = tables.background;
    out.in_range = true;
    for (const std::vector<Color>* colors : {&exact.sky_color, &exact.ground_color})
        for (const Color& c : *colors) {
            tables.sound = tables.sound && is_sound(c);
            out.in_range = out.in_range && is_sound(c) && largest(c) <= 1;
        }
    if (exact.ground_color.empty() && exact.sky_color.size() <= 1) {
        const Color color = exact.sky_color.empty() ? Color{} : exact.sky_color[0];
        put_surely(color, out.middle);
    } else if (exact.sky_color.size() == 1 && exact.ground_color.size() == 1 &&
               exact.sky_angle.empty() && exact.ground_angle.empty()) {
        out.kind = ShadingBackground::Kind::kBlend;
        const Color middle = (exact.sky_color[0] + exact.ground_color[0]) * 0.5;
        const Color slope = (exact.sky_color[0] - exact.ground_color[0]) * 0.5;
        put(middle, kFullByte, out.middle);
        put(slope, kFullByte, out.slope);
        // Those of y, of both constants, of the product and of the sum.
        const double most = max_norm(slope);
        const auto y = static_cast<double>(tables.rays.sine_error);
        out.error = rounded_up(kSlack * kFullByte *
                               (most * y + roundings(1) * (2 * max_norm(middle) + 3 * most)));
    } else {
        out.kind = ShadingBackground::Kind::kGradient;
        out.in_range = false;  // where bounds lie in two bands
        out.has_ground = !exact.ground_color.empty();
        out.sky = bands(exact.sky_color, exact.sky_angle);
        if (out.sky.empty()) out.sky = bands({Color{}}, {});
        out.ground = bands(exact.ground_color, exact.ground_angle);
        out.ground_end =
            rounded(exact.ground_angle.empty() ? kInfinity : exact.ground_angle.back());
    }
}

}  // namespace

SurfaceWord ShadingTables::word_of(const Object& object) const {
    SurfaceWord word = material_words[object.material];
    if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
        if (!mesh->normals.empty()) word |= kSmoothFlag;
        if (!mesh->colors.empty()) word |= kColoredFlag;
    }
    return word;
}

ShadingTables::ShadingTables(const FastScene& scene_in, const CameraRays& camera_in,
                             const CameraTables& quadrics_in, InstructionSet isa_in,
                             std::optional<ShadingTriangles> kept)
    : scene(scene_in),
      camera(camera_in),
      isa(isa_in),
      quadrics(quadrics_in),
      rays(camera_in, scene_in.scene().background.zenith) {
    bound_points(*this);
    add_materials(*this);
    add_mesh_flags(*this);
    add_lights(*this);
    add_background(*this);
    const bool serves =
        kept && (!kept->depend_on_camera ||
                 (kept->camera == scene.scene().camera && kept->resolution == camera.resolution));
    triangles = serves ? std::move(*kept) : unknown_triangles(*this);
}

void ShadingTables::fill(const TriangleSet& some, int threads) {
    const BigVector<Slot> slots = some.slots_beside(triangles.known);
    for_each_chunk(scene, {&slots}, static_cast<Slot>(slots.size()), threads,
                   [&](const TriangleChunk& chunk) { take(chunk); });
    triangles.known.add(slots);
}

void ShadingTables::fill_all(int threads) {
    if (triangles.known.has_all()) return;
    for_each_chunk(scene, {}, scene.triangle_end(), threads,
                   [&](const TriangleChunk& chunk) { take(chunk); });
    triangles.known.add_all();
}

std::size_t ShadingTriangles::memory_bytes() const {
    std::size_t bytes = known.memory_bytes() + vector_bytes(words) + vector_bytes(normals) +
                        vector_bytes(smooth) + vector_bytes(smooth_offsets);
    for (const BigVector<float>& of_light : cosines) bytes += vector_bytes(of_light);
    return bytes;
}

std::size_t ShadingTables::memory_bytes() const {
    return sizeof(*this) + rays.memory_bytes() + vector_bytes(materials) +
           vector_bytes(material_words) + vector_bytes(lights) + triangles.memory_bytes();
}

}  // namespace nuvo
