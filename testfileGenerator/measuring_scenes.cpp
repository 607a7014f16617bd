// Scenes of any size, for measuring: shapes at random in a cube.
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

// Octahedra: as densely as thesis test 2's, 1,000 in a cube of side 1,000.
constexpr std::uint64_t kOctahedronVolumeEach = 1'000'000;  // cubed scene units
constexpr double kOctahedronRadius = 7.5;

// Spheres: ten radii apart on average.
constexpr std::uint64_t kSphereVolumeEach = 1000;
constexpr double kSphereRadius = 1;

// The standard's default of 100 would leave most of these scenes unlit.
constexpr double kLightRadius = 10000;

constexpr std::array<std::string_view, 5> kColors{"0.8 0.3 0.25", "0.25 0.5 0.75", "0.85 0.65 0.25",
                                                  "0.3 0.6 0.4", "0.6 0.4 0.65"};

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

/// `count` points in the cube around 0 that gives each of them `volume_each`.
std::vector<Point> random_points(const Variation& variation, std::uint64_t volume_each) {
    Random random(variation.seed);
    const double half = cube_root(volume_each * static_cast<std::uint64_t>(variation.count)) / 2;
    std::vector<Point> points;
    for (int i = 0; i < variation.count; ++i) {
        // One statement each: the order in which arguments are evaluated is not fixed.
        const double x = on_grid(random.symmetric(half));
        const double y = on_grid(random.symmetric(half));
        const double z = on_grid(random.symmetric(half));
        points.push_back({x, y, z});
    }
    return points;
}

/// Everything before the shapes, which reach `radius` beyond their `centers`.
std::string head(std::string_view name, const std::string& description,
                 const std::vector<Point>& centers, double radius, CameraPlace place) {
    double half_height = 0;
    double front = 0;
    for (const Point& center : centers) {
        half_height = std::max(half_height, std::abs(center.y) + radius);
        front = std::max(front, center.z + radius);
    }
    const double far = camera_fraction(CameraPlace::kFar, 0);
    const double z = front + camera_fraction(place, far) * fitting_distance(half_height);
    std::string out = scene_head(name, description);
    out += "    <Viewpoint position='0 0 " + number(on_grid(z)) +
           "' fieldOfView='0.7853981633974483'/>\n";
    out += sky_and_no_headlight();
    out += "    <PointLight location='0 0 0' radius='" + number(kLightRadius) + "'/>\n";
    return out + "    <DirectionalLight direction='0 0 -1'/>\n";
}

std::string colored(std::size_t color) {
    return "diffuseColor='" + std::string(kColors[color]) + "'";
}

}  // namespace

std::string many_spheres(const Variation& variation) {
    const std::vector<Point> centers = random_points(variation, kSphereVolumeEach);
    std::string out =
        head("spheres", std::to_string(centers.size()) + " spheres at random in a cube", centers,
             kSphereRadius, variation.camera);
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const std::size_t color = i % kColors.size();
        const std::string name = "Color" + std::to_string(color);
        out += "    <Transform translation='" + triple(centers[i]) + "'><Shape>";
        out += i < kColors.size() ? "<Appearance DEF='" + name + "'><Material " + colored(color) +
                                        "/></Appearance>"
                                  : "<Appearance USE='" + name + "'/>";
        out += "<Sphere radius='" + number(kSphereRadius) + "'/></Shape></Transform>\n";
    }
    return out + scene_foot();
}

std::string many_octahedra(const Variation& variation) {
    const std::vector<Point> centers = random_points(variation, kOctahedronVolumeEach);
    const Mesh one = octahedron(kOctahedronRadius);
    Mesh all;
    for (const Point& middle : centers) {
        const int first = static_cast<int>(all.points.size());
        for (const Point& p : one.points)
            all.points.push_back({middle.x + p.x, middle.y + p.y, middle.z + p.z});
        for (const auto& [a, b, c] : one.triangles)
            all.triangles.push_back({first + a, first + b, first + c});
    }
    std::string out = head(
        "octahedra", std::to_string(centers.size()) + " octahedra at random in a cube, one mesh",
        centers, kOctahedronRadius, variation.camera);
    out += "    <Shape>\n" + appearance(colored(0), "", "      ");
    return out + triangle_set(all, "", Shading::kFlat, "      ") + "    </Shape>\n" + scene_foot();
}

}  // namespace nuvo::generator
