#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "fast/frame/frame.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"
#include "property/test_scenes.h"

// Scenes and cameras for the comparison of the fast tracer with the serial one.

namespace nuvo::testing {

/// The serial exact tracer's picture: the truth.
inline Image exact_picture(const Scene& scene, const Primitives& primitives,
                           Resolution resolution) {
    Profile profile = exact_profile();
    profile.walk = WalkChoice::kDescent;
    return render(scene, primitives, build_tree(scene, primitives, profile), profile, resolution);
}

/// How `found` differs from `expected`, in words; empty: not at all.
inline std::string difference(const Image& expected, const Image& found) {
    if (expected == found) return {};
    int count = 0;
    std::ostringstream first;
    for (int y = 0; y < expected.height(); ++y)
        for (int x = 0; x < expected.width(); ++x) {
            const Rgb8 a = expected.at(x, y);
            const Rgb8 b = found.at(x, y);
            if (a == b || ++count > 1) continue;
            first << x << "," << y << ": " << +b.r << "," << +b.g << "," << +b.b << " instead of "
                  << +a.r << "," << +a.g << "," << +a.b;
        }
    return std::to_string(count) + " pixels differ, the first at " + first.str();
}

inline constexpr OctreeType kTypes[] = {OctreeType::kUniform, OctreeType::kNonuniform};

inline std::string text(const FastOptions& options, Resolution size) {
    std::ostringstream out;
    out << (options.type == OctreeType::kUniform ? "uniform" : "nonuniform") << ", instruction set "
        << static_cast<int>(options.isa) << ", " << options.threads << " threads, " << size.width
        << " x " << size.height;
    return out.str();
}

/// All pictures of `sizes` by tracers of each kind; those of several threads of the first size.
// Shadows are listed in every way.
inline void expect_identical(const Scene& scene, const std::vector<Resolution>& sizes,
                             const std::vector<int>& threads = {1}) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    std::vector<Image> expected;
    for (const Resolution& size : sizes) expected.push_back(exact_picture(scene, primitives, size));
    for (const OctreeType type : kTypes)
        for (const InstructionSet isa : supported_instruction_sets())
            for (const int count : threads) {
                const FastOptions options{type, count, isa};
                FastTracer tracer(scene, primitives, options);
                const FastScene fast(scene, primitives, type, count);
                SerialTree serial(fast);
                KeptTables kept[4];
                for (std::size_t i = 0; i < (count == 1 ? sizes.size() : 1); ++i) {
                    EXPECT_EQ(difference(expected[i], tracer.render(sizes[i])), "")
                        << text(options, sizes[i]);
                    if (!Frame::can_show(fast, sizes[i])) continue;
                    for (const ShadowListing listing :
                         {ShadowListing::kAll, ShadowListing::kWanted, ShadowListing::kKept,
                          ShadowListing::kByLight})
                        EXPECT_EQ(difference(expected[i],
                                             Frame(serial, options, sizes[i], nullptr,
                                                   kept[static_cast<int>(listing) - 1], listing)
                                                 .render()),
                                  "")
                            << text(options, sizes[i]) << ", listing " << static_cast<int>(listing);
                }
            }
}

/// A camera at `eye` that looks along `forward`, which need not be unit, rolled anyhow.
inline Camera camera_along(const Point3& eye, const Vector3& forward) {
    Camera camera;
    camera.position = eye;
    camera.forward = normalized(forward);
    const Vector3 up = std::abs(camera.forward.y) < 0.9 ? Vector3{0, 1, 0} : Vector3{1, 0, 0};
    camera.right = normalized(cross(camera.forward, up));
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

/// The same view by parallel rays, as wide as it is at that distance.
inline Camera parallel_camera(Camera camera, double distance) {
    const double half = std::tan(camera.field_of_view_rad / 2) * distance;
    camera.window = OrthoWindow{{-half, -half}, {half, half}};
    return camera;
}

/// A point within the shape, for a mesh that of its box.
inline Point3 middle_of(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->center;
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape)) return ellipsoid->center;
    const Bounds3 box = std::get<TriangleMesh>(shape).bounds();
    return box.min + (box.max - box.min) * 0.5;
}

/// A point on the shape, for a mesh a corner.
inline Point3 surface_of(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return sphere->center + Vector3{0, 0, sphere->radius};
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape)) return ellipsoid->center;
    const TriangleMesh& mesh = std::get<TriangleMesh>(shape);
    return mesh.positions[mesh.triangles.front()[0]];
}

/// Places from which a picture is hard: within and upon shapes, straight along axes, far off.
inline std::vector<Camera> odd_cameras(const Scene& scene) {
    std::vector<Camera> cameras;
    if (scene.objects.empty()) return cameras;
    Bounds3 box;
    for (const Object& object : scene.objects)
        box = box.extended(std::visit([](const auto& s) { return s.bounds(); }, object.shape));
    const Vector3 size = box.max - box.min;
    const double width = std::max({size.x, size.y, size.z});
    const Point3 center = box.min + size * 0.5;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vector3 direction;
            direction[axis] = side;
            cameras.push_back(camera_along(center - direction * (1.5 * width), direction));
        }
    const Object& first = scene.objects.front();
    const Object& last = scene.objects.back();
    cameras.push_back(camera_along(center, {1, 0.25, -0.5}));
    cameras.push_back(camera_along(middle_of(first.shape), {0, 0, -1}));
    cameras.push_back(camera_along(middle_of(last.shape), {0.3, -1, 0.2}));
    cameras.push_back(camera_along(surface_of(first.shape), {-1, 0, 0}));
    cameras.push_back(camera_along(surface_of(last.shape), {0.6, 0.5, 0.4}));
    Camera telescope = camera_along(center + Vector3{3, 2, 1} * (1000 * width), {-3, -2, -1});
    telescope.field_of_view_rad = 0.0005;
    cameras.push_back(telescope);
    Camera fish = scene.camera;
    fish.field_of_view_rad = 3;
    cameras.push_back(fish);
    // Along an axis, from within, so far off that rays are told apart by little, and so near that a
    // pixel is as wide as the floats of the scene are apart.
    cameras.push_back(parallel_camera(cameras.front(), 1.5 * width));
    cameras.push_back(parallel_camera(camera_along(center, {1, 0.25, -0.5}), width));
    cameras.push_back(parallel_camera(telescope, 4000 * width));
    cameras.push_back(parallel_camera(
        camera_along(surface_of(first.shape) - Vector3{3, 2, 1} * width, {3, 2, 1}), 1e-6 * width));
    return cameras;
}

/// p -> p * scale + offset for all that stands in the scene.
inline void transform(Scene& scene, double scale, const Vector3& offset) {
    const auto moved = [&](Point3& p) { p = p * scale + offset; };
    moved(scene.camera.position);
    for (Light& light : scene.lights) {
        moved(light.location);
        light.radius *= scale;
        light.units_per_world /= scale;
    }
    for (Object& object : scene.objects) {
        if (auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            for (Point3& p : mesh->positions) moved(p);
        } else if (auto* sphere = std::get_if<Sphere>(&object.shape)) {
            moved(sphere->center);
            sphere->radius *= scale;
        } else {
            auto& ellipsoid = std::get<Ellipsoid>(object.shape);
            moved(ellipsoid.center);
            ellipsoid.radius *= scale;
        }
    }
}

/// Random scenes of all that the fast tracer knows, of any size and place.
class SceneMaker {
  public:
    explicit SceneMaker(std::uint64_t seed) : random_(seed) {}

    Scene scene() {
        Scene made;
        made.materials.resize(4);
        for (Material& material : made.materials) material = any_material();
        const int objects = 1 + below(40);
        for (int i = 0; i < objects; ++i) made.objects.push_back(any_object());
        for (std::uint32_t i = 0; i < made.objects.size(); ++i) made.objects[i].shape_index = i;
        made.shape_count = made.objects.size();
        const int lights = below(6);
        for (int i = 0; i < lights; ++i) made.lights.push_back(any_light(objects));
        if (chance()) made.background = {{color(), color()}, {1.2}, {color()}, {}};
        if (chance()) made.background = {{color()}, {}, {color()}, {}};
        const Point3 eye = point(25);
        made.camera = camera_along(eye, point(10) - eye);
        made.camera.field_of_view_rad = 0.2 + unit() * 1.5;
        if (++made_ % 4 == 0) made.camera = parallel_camera(made.camera, length(eye));
        return made;
    }
    Ray ray() {
        const Point3 origin = point(20);
        return {origin, point(1)};
    }

  private:
    double unit() { return uniform(random_, 0, 1); }
    bool chance() { return (random_() & 1) != 0; }
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    Point3 point(double half) { return uniform_point(random_, half); }
    Color color() { return {unit(), unit(), unit()}; }

    Material any_material() {
        Material material;
        material.diffuse_color = color();
        material.ambient_intensity = chance() ? 0 : unit();
        if (chance()) material.specular_color = color();
        material.shininess = chance() ? unit() : below(3) * 0.5;
        if (chance()) material.emissive_color = color() * 0.3;
        material.lit = below(5) != 0;
        return material;
    }

    Object any_object() {
        const Point3 center = point(10);
        const double size = std::exp2(uniform(random_, -4, 2));
        Object object;
        switch (below(5)) {
            case 0:
                object.shape = Sphere{center, size};
                break;
            case 1:
                object.shape =
                    Ellipsoid{center, {{point(1), point(1), point(1) + Vector3{0, 0, 2}}}, size};
                break;
            case 2:
                object.shape = octahedron(center, size);
                break;
            default:
                object.shape = any_mesh(center, size);
        }
        object.material = static_cast<std::uint32_t>(below(4));
        object.solid = chance();
        object.casts_shadow = below(8) != 0;
        return object;
    }

    // Triangles that share corners, with or without normals and colors.
    TriangleMesh any_mesh(const Point3& center, double size) {
        TriangleMesh mesh;
        const int corners = 3 + below(12);
        const bool smooth = chance(), colored = chance();
        for (int i = 0; i < corners; ++i) {
            mesh.positions.push_back(center + point(size));
            if (smooth) mesh.normals.push_back(point(1) + Vector3{0, 1.5, 0});
            if (colored) mesh.colors.push_back(color());
        }
        const auto corner = [&] { return static_cast<std::uint32_t>(below(corners)); };
        for (int i = 0; i < corners; ++i) mesh.triangles.push_back({corner(), corner(), corner()});
        return mesh;
    }

    Light any_light(int objects) {
        Light light;
        light.kind = static_cast<Light::Kind>(below(3));
        light.color = color();
        light.intensity = unit();
        light.ambient_intensity = chance() ? 0 : unit();
        light.direction = normalized(point(1));
        if (below(4) == 0) light.direction = {0, -1, 0};
        light.location = point(chance() ? 6 : 20);
        if (chance()) light.attenuation = {unit(), unit() * 0.1, unit() * 0.01};
        light.radius = chance() ? 1e9 : 5 + 20 * unit();
        light.units_per_world = chance() ? 1 : 0.5 + unit();
        light.cut_off_angle = 0.2 + unit() * 1.3;
        light.beam_width = light.cut_off_angle * (chance() ? unit() : 1.5);
        light.casts_shadow = below(4) != 0;
        if (chance()) {
            light.scope.first = static_cast<std::uint32_t>(below(objects));
            light.scope.last = light.scope.first + static_cast<std::uint32_t>(below(objects));
        }
        return light;
    }

    int made_ = 0;
    std::mt19937_64 random_;
};

}  // namespace nuvo::testing
