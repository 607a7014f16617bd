// Scenes like those that people render, by rules and of any size, for measuring.
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "mesh.h"
#include "random.h"
#include "scenes.h"
#include "x3d_text.h"

namespace nuvo::generator {

namespace {

constexpr std::string_view kColor = "diffuseColor='0.75 0.7 0.62'";

void add(Mesh& all, const Mesh& part, Point at) {
    const int first = static_cast<int>(all.points.size());
    for (const Point& p : part.points)
        all.points.push_back(
            {six_decimals(at.x + p.x), six_decimals(at.y + p.y), six_decimals(at.z + p.z)});
    for (const auto& [a, b, c] : part.triangles)
        all.triangles.push_back({first + a, first + b, first + c});
}

/// A box of these half widths around 0: 12 triangles.
Mesh box(double x, double y, double z) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.points.push_back(
            {(corner & 1) != 0 ? x : -x, (corner & 2) != 0 ? y : -y, (corner & 4) != 0 ? z : -z});
    constexpr std::array<std::array<int, 4>, 6> kFaces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& [a, b, c, d] : kFaces) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

/// Everything: `viewpoint` and `lights` are the nodes' attributes.
std::string one_mesh(std::string_view name, const std::string& description, const Mesh& mesh,
                     const std::string& viewpoint, const std::string& lamp) {
    std::string out = scene_head(name, description);
    out += "    <Viewpoint " + viewpoint + " fieldOfView='0.7853981633974483'/>\n";
    out += sky_and_no_headlight();
    out += "    <PointLight location='" + lamp + "' radius='100000000'/>\n";
    out += "    <DirectionalLight direction='-0.5 -1 -0.25'/>\n";
    out += "    <Shape>\n" + appearance(kColor, "", "      ");
    return out + triangle_set(mesh, "", Shading::kFlat, "      ") + "    </Shape>\n" + scene_foot();
}

int square_root(int n) {
    auto root = static_cast<int>(std::sqrt(static_cast<double>(n)));
    while (root * root < n) ++root;
    return root;
}

/// Heights between 0 and 1 on a square of `side` + 1 points: octaves of smoothed random lattices.
std::vector<double> heights(Random& random, int side) {
    const auto width = static_cast<std::size_t>(side) + 1;
    std::vector<double> out(width * width, 0);
    double weight = 0.5;
    for (int cells = 4; cells <= side; cells *= 2, weight *= 0.5) {
        const auto lattice_width = static_cast<std::size_t>(cells) + 2;
        std::vector<double> lattice(lattice_width * lattice_width);
        for (double& value : lattice) value = random.unit();
        for (std::size_t i = 0; i < out.size(); ++i) {
            const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
            const double x = static_cast<double>(i % width) * cells / side;
            const double y = static_cast<double>(i / width) * cells / side;
            const auto column = static_cast<std::size_t>(x);
            const auto row = static_cast<std::size_t>(y);
            const double u = smooth(x - static_cast<double>(column));
            const double v = smooth(y - static_cast<double>(row));
            const double* const at = &lattice[row * lattice_width + column];
            out[i] += weight * ((at[0] * (1 - u) + at[1] * u) * (1 - v) +
                                (at[lattice_width] * (1 - u) + at[lattice_width + 1] * u) * v);
        }
    }
    return out;
}

Point unit_vector(Random& random) {
    for (;;) {
        const double x = random.symmetric(1);
        const double y = random.symmetric(1);
        const double z = random.symmetric(1);
        const double length = std::sqrt(x * x + y * y + z * z);
        if (length > 0.125 && length < 1) return {x / length, y / length, z / length};
    }
}

}  // namespace

std::string terrain_scene(const Variation& variation) {
    Random random(variation.seed);
    const int side = square_root((variation.count + 1) / 2);
    const std::vector<double> height = heights(random, side);
    Mesh mesh;
    for (int i = 0; i < static_cast<int>(height.size()); ++i)
        mesh.points.push_back(
            {six_decimals(100.0 * (i % (side + 1)) / side - 50),
             six_decimals(25 * height[static_cast<std::size_t>(i)]),
             six_decimals(100.0 * static_cast<double>(i / (side + 1)) / side - 50)});
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const int a = row * (side + 1) + column;
            const int c = a + side + 1;
            mesh.triangles.push_back({a, c, a + 1});
            mesh.triangles.push_back({a + 1, c, c + 1});
        }
    return one_mesh("terrain", "A fractal landscape, one mesh", mesh,
                    "position='0 40 68' orientation='1 0 0 -0.45'", "-20 60 10");
}

std::string city_scene(const Variation& variation) {
    Random random(variation.seed);
    constexpr double kBlock = 16;
    // An even number, so that a street runs through the middle.
    const int side = (square_root(variation.count) + 1) / 2 * 2;
    const double half = side * kBlock / 2;
    Mesh mesh;
    add(mesh, box(half, 1, half), {0, -1, 0});
    for (int i = 0; i < variation.count; ++i) {
        const double height = 4 + 40 * random.unit() * random.unit();
        const double x = 3 + 3 * random.unit();
        const double z = 3 + 3 * random.unit();
        add(mesh, box(x, height / 2, z),
            {(i % side + 0.5) * kBlock - half, height / 2,
             (static_cast<double>(i / side) + 0.5) * kBlock - half});
    }
    const bool street = variation.camera == CameraPlace::kNear;
    const std::string place =
        street ? "0 1.75 0" : "0 " + number(0.5 * half) + " " + number(1.25 * half);
    return one_mesh("city", street ? "A city from the street" : "A city from above", mesh,
                    "position='" + place + "'" + (street ? "" : " orientation='1 0 0 -0.5'"),
                    "0 " + number(half) + " 0");
}

std::string interior_scene(const Variation& variation) {
    Random random(variation.seed);
    constexpr double kRoom = 6;
    constexpr double kHeight = 3;
    const int side = square_root(variation.count);
    Mesh mesh;
    const Mesh large = icosphere(0.4, 4);
    const Mesh small = icosphere(0.2, 3);
    for (int i = 0; i < variation.count; ++i) {
        const double x = i % side * kRoom;
        const double z = -static_cast<double>(i / side) * kRoom;
        add(mesh, box(kRoom / 2, 0.1, kRoom / 2), {x, -0.1, z});
        add(mesh, box(kRoom / 2, 0.1, kRoom / 2), {x, kHeight + 0.1, z});
        for (const double end : {-1.0, 1.0}) {  // two walls, each with a door in the middle
            add(mesh, box(0.05, kHeight / 2, 1.25), {x - kRoom / 2, kHeight / 2, z + end * 1.75});
            add(mesh, box(1.25, kHeight / 2, 0.05), {x + end * 1.75, kHeight / 2, z - kRoom / 2});
            add(mesh, box(0.05, 0.4, 0.05), {x + end * 0.9, 0.4, z - 0.5});
            add(mesh, box(0.05, 0.4, 0.05), {x + end * 0.9, 0.4, z + 0.5});
            add(mesh, large, {x + end * 2, 0.4, z + random.symmetric(1)});
        }
        add(mesh, box(1, 0.04, 0.6), {x, 0.84, z});
        for (int k = 0; k < 3; ++k) add(mesh, small, {x + 0.6 * (k - 1), 1.08, z});
    }
    return one_mesh("interior", "Rooms with tables and balls, from within one of them", mesh,
                    "position='" + number((side / 2) * kRoom - 2) + " 1.7 " +
                        number(2.5 - (side / 2) * kRoom) + "' orientation='0 1 0 -0.4'",
                    number((side / 2) * kRoom) + " 2.8 " + number(-(side / 2) * kRoom));
}

std::string assembly_scene(const Variation& variation) {
    const int side = square_root(variation.count);
    const Mesh wheel = icosphere(0.35, 4);
    const Mesh bolt = icosphere(0.02, 1);
    Mesh car;
    add(car, box(2, 0.25, 0.8), {0, 0.6, 0});
    add(car, box(1, 0.25, 0.7), {-0.2, 1.1, 0});
    for (const double x : {-1.3, 1.3})
        for (const double z : {-0.8, 0.8}) add(car, wheel, {x, 0.35, z});
    for (int i = 0; i < 100; ++i)
        add(car, bolt, {0.19 * (i % 20) - 1.8, 0.87, 0.36 * static_cast<double>(i / 20) - 0.72});
    Mesh mesh;
    for (int i = 0; i < variation.count; ++i)
        add(mesh, car, {5.0 * (i % side), 0, -2.5 * static_cast<double>(i / side)});
    const double half = 2.5 * side;
    return one_mesh("assembly", "Cars with wheels and bolts, one mesh", mesh,
                    "position='" + number(half) + " " + number(0.6 * half + 2) + " " +
                        number(half + 4) + "' orientation='1 0 0 -0.45'",
                    number(half) + " " + number(2 * half) + " 5");
}

std::string floor_scene(const Variation& variation) {
    Mesh mesh = icosphere(1, 6);
    add(mesh, box(variation.count, 1, variation.count), {0, -2, 0});
    return one_mesh("floor", "A ball of 81,920 triangles on a floor --count times as wide", mesh,
                    "position='0 1.2 4' orientation='1 0 0 -0.3'", "2 4 3");
}

std::string molecule_scene(const Variation& variation) {
    Random random(variation.seed);
    constexpr double kBond = 1.5;
    constexpr std::array<double, 4> kRadii{1.7, 1.55, 1.52, 1.1};
    constexpr std::array<std::string_view, 4> kColors{"0.4 0.4 0.4", "0.2 0.3 0.9", "0.9 0.2 0.2",
                                                      "0.9 0.9 0.9"};
    // A chain that turns back where it leaves a ball with room for it.
    const double ball = 1.3 * std::sqrt(std::sqrt(static_cast<double>(variation.count))) *
                        std::sqrt(std::sqrt(std::sqrt(static_cast<double>(variation.count))));
    std::string out = scene_head("molecule", "A chain of touching spheres");
    out += "    <Viewpoint position='0 0 " + number(six_decimals(3.6 * ball)) +
           "' fieldOfView='0.7853981633974483'/>\n" + sky_and_no_headlight();
    out += "    <PointLight location='" + number(six_decimals(2 * ball)) + " " +
           number(six_decimals(3 * ball)) + " " + number(six_decimals(3 * ball)) +
           "' radius='100000000'/>\n    <DirectionalLight direction='-0.5 -1 -0.25'/>\n";
    Point at;
    for (int i = 0; i < variation.count; ++i) {
        const auto kind = static_cast<std::size_t>(random.unit() * kRadii.size());
        const std::string name = "Atom" + std::to_string(i < 4 ? i : static_cast<int>(kind));
        const std::size_t shown = i < 4 ? static_cast<std::size_t>(i) : kind;
        out += "    <Transform translation='" +
               triple({six_decimals(at.x), six_decimals(at.y), six_decimals(at.z)}) + "'><Shape>";
        out += i < 4 ? "<Appearance DEF='" + name + "'><Material diffuseColor='" +
                           std::string(kColors[shown]) + "'/></Appearance>"
                     : "<Appearance USE='" + name + "'/>";
        out += "<Sphere radius='" + number(kRadii[shown]) + "'/></Shape></Transform>\n";
        const Point step = unit_vector(random);
        const double inwards = at.x * step.x + at.y * step.y + at.z * step.z;
        const bool outside = at.x * at.x + at.y * at.y + at.z * at.z > ball * ball;
        const double sign = outside && inwards > 0 ? -kBond : kBond;
        at = {at.x + sign * step.x, at.y + sign * step.y, at.z + sign * step.z};
    }
    return out + scene_foot();
}

}  // namespace nuvo::generator
