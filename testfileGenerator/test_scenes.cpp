// Tests 1 to 4 of the thesis (section 5.7.3). It gives the number and the arrangement of the shapes
// and no more. The sizes and camera distances here were looked for, and are the ones at which the
// thesis' leaf counts and its tests and searches per ray come out closely.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "camera.h"
#include "mesh.h"
#include "random.h"
#include "scenes.h"
#include "x3d_text.h"

namespace nuvo::generator {

namespace {

// Test 1: 9^3 octahedra without the middle one, where the point light is.
constexpr int kGridSide = 9;
constexpr double kGridSpacing = 100;
constexpr double kGridRadius = 12;  // 0.12 of the spacing
constexpr double kGridCameraFraction = 0.65;

// Test 2: octahedra at random in a cube.
constexpr int kRandomCount = 1000;
constexpr std::uint64_t kRandomVolumeEach = 1'000'000;  // cubed scene units: a side of 1,000
constexpr double kRandomRadius = 7.5;
constexpr double kRandomCameraFraction = 0.30;

// Test 3: spheres at random on concentric shells, the same number on each (5,985 is 5 * 1,197; in
// proportion to the area of the shells it would not come out whole).
constexpr int kShells = 5;
constexpr int kSpheresPerShell = 1197;
constexpr double kShellStep = 100;
constexpr double kShellSphereRadius = 3;
constexpr double kShellCameraFraction = 0.62;

// Test 4: clumps of octahedra at random about the points of a 4^3 grid.
constexpr int kClumpSide = 4;
constexpr int kPerClump = 50;
constexpr double kClumpSpacing = 300;
constexpr double kClumpHalfSide = 30;
constexpr double kClumpRadius = 4;
constexpr double kClumpCameraFraction = 0.60;

// Spheres of any number: at random in a cube, ten radii apart on average.
constexpr std::uint64_t kSphereVolumeEach = 1000;
constexpr double kSphereRadius = 1;

// The standard's default of 100 would leave most of these scenes unlit.
constexpr double kLightRadius = 10000;

// Multiples of 1/64: short to write, exact in float too, and so is every sum of two of them here,
// so that moving a shape to its place rounds nothing.
double on_grid(double value) { return std::round(value * 64) / 64; }

/// The least whole number whose cube is at least `volume` <= 2^62. (std::cbrt need not be correctly
/// rounded, so its last bits may differ between platforms.)
double cube_root(std::uint64_t volume) {
    std::uint64_t root = 0;
    for (std::uint64_t bit = std::uint64_t{1} << 20; bit > 0; bit /= 2) {
        const std::uint64_t more = root + bit;
        if (more * more * more < volume) root = more;
    }
    return static_cast<double>(root + 1);
}

struct Placement {
    Point center;
    int color = 0;  // used modulo the number of colours
};

struct TestScene {
    std::string name;
    std::string description;
    bool spheres = false;
    double radius = 0;           // of every shape
    double camera_fraction = 0;  // of the distance at which 1.05 times the height fits
    std::vector<Placement> shapes;
};

constexpr std::array<std::string_view, 5> kColors{"0.8 0.3 0.25", "0.25 0.5 0.75", "0.85 0.65 0.25",
                                                  "0.3 0.6 0.4", "0.6 0.4 0.65"};

std::string color_name(std::size_t color) { return "Color" + std::to_string(color); }

/// The camera on the z axis, 45 degrees high: `camera_fraction` of the distance from the scene's
/// front at which its height times 1.05 fits into the picture, or where `place` wants it.
double camera_z(const TestScene& scene, CameraPlace place) {
    double half_height = 0;
    double front = 0;
    for (const Placement& shape : scene.shapes) {
        half_height = std::max(half_height, std::abs(shape.center.y) + scene.radius);
        front = std::max(front, shape.center.z + scene.radius);
    }
    return on_grid(front +
                   camera_fraction(place, scene.camera_fraction) * fitting_distance(half_height));
}

/// Appends the shape's geometry: the first octahedron in full, the others as its copies.
void add_geometry(std::string& out, const TestScene& scene, bool is_first) {
    if (scene.spheres) {
        out += "<Sphere radius='" + number(scene.radius) + "'/>";
    } else if (is_first) {
        out += "\n";
        out += triangle_set(octahedron(scene.radius), "Octahedron", Shading::kFlat, "      ");
        out += "    ";
    } else {
        out += "<IndexedTriangleSet USE='Octahedron'/>";
    }
}

/// Everything before the shapes.
std::string head(const TestScene& scene, CameraPlace place) {
    std::string out = scene_head(scene.name, scene.description);
    out += "    <Viewpoint position='0 0 " + number(camera_z(scene, place)) +
           "' fieldOfView='0.7853981633974483'/>\n";
    out += sky_and_no_headlight();
    out += "    <PointLight location='0 0 0' radius='" + number(kLightRadius) + "'/>\n";
    out += "    <DirectionalLight direction='0 0 -1'/>\n";
    return out;
}

std::string text(const TestScene& scene, const Variation& variation) {
    std::string out = head(scene, variation.camera);
    std::array<bool, kColors.size()> defined{};
    bool is_first = true;
    for (const Placement& shape : scene.shapes) {
        const std::size_t color = static_cast<std::size_t>(shape.color) % kColors.size();
        out += "    <Transform translation='" + triple(shape.center) + "'><Shape>";
        if (defined[color]) {
            out += "<Appearance USE='" + color_name(color) + "'/>";
        } else {
            out += "<Appearance DEF='" + color_name(color) + "'><Material diffuseColor='" +
                   std::string(kColors[color]) + "'/></Appearance>";
        }
        add_geometry(out, scene, is_first);
        out += "</Shape></Transform>\n";
        defined[color] = true;
        is_first = false;
    }
    return out + scene_foot();
}

/// A point of the cube of half side `half` about `middle`.
Point in_cube(Random& random, Point middle, double half) {
    // One statement each: the order in which arguments are evaluated is not fixed.
    const double x = on_grid(middle.x + random.symmetric(half));
    const double y = on_grid(middle.y + random.symmetric(half));
    const double z = on_grid(middle.z + random.symmetric(half));
    return {x, y, z};
}

/// A point uniform on the sphere of radius `radius`: a point uniform in the unit ball, pushed out.
/// No sine or cosine, whose last bits differ between platforms.
Point on_shell(Random& random, double radius) {
    for (;;) {
        const double x = random.symmetric(1);
        const double y = random.symmetric(1);
        const double z = random.symmetric(1);
        const double squared = x * x + y * y + z * z;
        if (squared > 1 || squared < 0.01) continue;
        const double scale = radius / std::sqrt(squared);
        return {on_grid(scale * x), on_grid(scale * y), on_grid(scale * z)};
    }
}

/// The middle-most of `count` places `spacing` apart is 0.
double grid_place(int i, int count, double spacing) { return (i - (count - 1) / 2.0) * spacing; }

}  // namespace

std::string test_1(const Variation& variation) {
    TestScene scene{"test1",
                    "728 octahedra: a 9 x 9 x 9 grid without its middle",
                    false,
                    kGridRadius,
                    kGridCameraFraction,
                    {}};
    for (int i = 0; i < kGridSide * kGridSide * kGridSide; ++i) {
        const int ix = i % kGridSide;
        const int iy = i / kGridSide % kGridSide;
        const int iz = i / (kGridSide * kGridSide);
        const Point center{grid_place(ix, kGridSide, kGridSpacing),
                           grid_place(iy, kGridSide, kGridSpacing),
                           grid_place(iz, kGridSide, kGridSpacing)};
        if (center.x == 0 && center.y == 0 && center.z == 0) continue;
        scene.shapes.push_back({center, ix + iy + iz});
    }
    return text(scene, variation);
}

std::string test_2(const Variation& variation) {
    TestScene scene{"test2",
                    "1,000 octahedra at random in a cube of side 1,000",
                    false,
                    kRandomRadius,
                    kRandomCameraFraction,
                    {}};
    Random random(variation.seed);
    // With the same number in the same space, that is with copies = 1, the side is exactly 1,000.
    const std::uint64_t volume = kRandomVolumeEach * kRandomCount;
    const double half = cube_root(volume * static_cast<std::uint64_t>(variation.copies)) / 2;
    for (int i = 0; i < kRandomCount * variation.copies; ++i) {
        scene.shapes.push_back({in_cube(random, {0, 0, 0}, half), i});
    }
    if (variation.copies > 1)
        scene.description = std::to_string(scene.shapes.size()) + " octahedra at random in a cube";
    return text(scene, variation);
}

std::string test_3(const Variation& variation) {
    TestScene scene{"test3",
                    "5,985 spheres on five concentric larger spheres",
                    true,
                    kShellSphereRadius,
                    kShellCameraFraction,
                    {}};
    Random random(variation.seed);
    for (int shell = 1; shell <= kShells; ++shell) {
        for (int i = 0; i < kSpheresPerShell; ++i) {
            scene.shapes.push_back({on_shell(random, kShellStep * shell), shell - 1});
        }
    }
    return text(scene, variation);
}

std::string test_4(const Variation& variation) {
    TestScene scene{
        "test4", "3,200 octahedra in 64 clumps of 50", false, kClumpRadius, kClumpCameraFraction,
        {}};
    Random random(variation.seed);
    for (int clump = 0; clump < kClumpSide * kClumpSide * kClumpSide; ++clump) {
        const int ix = clump % kClumpSide;
        const int iy = clump / kClumpSide % kClumpSide;
        const int iz = clump / (kClumpSide * kClumpSide);
        const Point middle{grid_place(ix, kClumpSide, kClumpSpacing),
                           grid_place(iy, kClumpSide, kClumpSpacing),
                           grid_place(iz, kClumpSide, kClumpSpacing)};
        for (int i = 0; i < kPerClump; ++i) {
            scene.shapes.push_back({in_cube(random, middle, kClumpHalfSide), ix + iy + iz});
        }
    }
    return text(scene, variation);
}

std::string many_spheres(const Variation& variation) {
    const auto count = static_cast<std::uint64_t>(variation.count);
    TestScene scene{"spheres",
                    std::to_string(count) + " spheres at random in a cube",
                    true,
                    kSphereRadius,
                    camera_fraction(CameraPlace::kFar, 1),
                    {}};
    Random random(variation.seed);
    const double half = cube_root(kSphereVolumeEach * count) / 2;
    for (int i = 0; i < variation.count; ++i) {
        scene.shapes.push_back({in_cube(random, {0, 0, 0}, half), i});
    }
    return text(scene, variation);
}

std::string many_octahedra(const Variation& variation) {
    const auto count = static_cast<std::uint64_t>(variation.count);
    TestScene scene{"octahedra",
                    std::to_string(count) + " octahedra at random in a cube, one mesh",
                    false,
                    kRandomRadius,
                    camera_fraction(CameraPlace::kFar, 1),
                    {}};
    Random random(variation.seed);
    const double half = cube_root(kRandomVolumeEach * count) / 2;
    const Mesh one = octahedron(kRandomRadius);
    Mesh all;
    for (int i = 0; i < variation.count; ++i) {
        const Point middle = in_cube(random, {0, 0, 0}, half);
        scene.shapes.push_back({middle, i});
        const int first = static_cast<int>(all.points.size());
        for (const Point& p : one.points)
            all.points.push_back({middle.x + p.x, middle.y + p.y, middle.z + p.z});
        for (const auto& [a, b, c] : one.triangles)
            all.triangles.push_back({first + a, first + b, first + c});
    }
    std::string out = head(scene, variation.camera) + "    <Shape>\n";
    out += appearance("diffuseColor='" + std::string(kColors[0]) + "'", "", "      ");
    return out + triangle_set(all, "", Shading::kFlat, "      ") + "    </Shape>\n" + scene_foot();
}

}  // namespace nuvo::generator
