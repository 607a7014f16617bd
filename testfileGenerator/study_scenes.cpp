// Families of scenes for the study of midpoints: octahedra whose places are drawn by a rule that
// the seed varies. Each is a Shape of its own, so that whole shapes and triangles can stand in
// leaves.
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

constexpr double kHalf = 500;  // of the space that most families fill
constexpr std::array<std::string_view, 4> kColors{"0.8 0.3 0.25", "0.25 0.5 0.75", "0.85 0.65 0.25",
                                                  "0.3 0.6 0.4"};

struct Stone {
    Point center;
    Point radius;  // on each axis
};

std::string rounded(Point p) {
    return triple({six_decimals(p.x), six_decimals(p.y), six_decimals(p.z)});
}

/// From one seed to the next parameters go through their range evenly: `low` to `high` by
/// multiplication, in five steps.
double stepped(const Variation& variation, double low, double high) {
    constexpr int kSteps = 5;
    const auto step = static_cast<int>(variation.seed % kSteps);
    double value = low;
    for (int i = 0; i < step; ++i) value *= std::sqrt(std::sqrt(high / low));
    return value;
}

Point random_point(Random& random, double half) {
    const double x = random.symmetric(half);
    const double y = random.symmetric(half);
    const double z = random.symmetric(half);
    return {x, y, z};
}

Stone stone(Point center, double radius) { return {center, {radius, radius, radius}}; }

std::string written(std::string_view name, const std::string& description,
                    const std::vector<Stone>& stones) {
    double half_height = 0;
    double front = 0;
    for (const Stone& s : stones) {
        half_height = std::max(half_height, std::abs(s.center.y) + s.radius.y);
        front = std::max(front, s.center.z + s.radius.z);
    }
    // Half the distance at which all is seen: rays are spread, and all of them meet the scene.
    const double z = six_decimals(front + fitting_distance(half_height) / 2);
    std::string out = scene_head(name, description);
    out += "    <Viewpoint position='0 0 " + number(z) + "' fieldOfView='0.7853981633974483'/>\n";
    out += sky_and_no_headlight();
    out += "    <PointLight location='0 " + number(six_decimals(half_height * 2)) + " " +
           number(z) + "' radius='1000000'/>\n    <DirectionalLight direction='-0.3 -0.5 -1'/>\n";
    for (std::size_t i = 0; i < stones.size(); ++i) {
        const Stone& s = stones[i];
        out +=
            "    <Transform translation='" + rounded(s.center) + "' scale='" + rounded(s.radius) +
            "'><Shape>" +
            appearance("diffuseColor='" + std::string(kColors[i % kColors.size()]) + "'", "", "");
        out += i == 0 ? triangle_set(octahedron(1), "Stone", Shading::kFlat, "")
                      : "<IndexedTriangleSet USE='Stone'/>";
        out += "</Shape></Transform>\n";
    }
    return out + scene_foot();
}

}  // namespace

// Blocks with aisles between them, at uneven places: planes that part all are there to be found.
std::string aisles_scene(const Variation& variation) {
    Random random(variation.seed);
    const double gap = stepped(variation, 0.05, 0.6);  // of the space, on each axis
    constexpr int kBlocks = 6;
    std::array<std::array<double, kBlocks + 1>, 3> bounds{};
    for (auto& axis : bounds) {
        double sum = 0;
        for (double& at : axis) {
            at = sum;
            sum += 0.25 + random.unit();
        }
        for (double& at : axis) at = (2 * at / axis[kBlocks] - 1) * kHalf;
    }
    std::vector<Stone> stones;
    for (int i = 0; i < variation.count; ++i) {
        std::array<double, 3> p{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto block = static_cast<std::size_t>(random.unit() * kBlocks);
            const double low = bounds[axis][block], width = bounds[axis][block + 1] - low;
            p[axis] = low + width * (gap / 2 + (1 - gap) * random.unit());
        }
        stones.push_back(stone({p[0], p[1], p[2]}, 8));
    }
    return written("aisles", "blocks of octahedra between aisles", stones);
}

// Thick in one corner, thin in the others.
std::string drift_scene(const Variation& variation) {
    Random random(variation.seed);
    const double power = stepped(variation, 1.25, 5);
    std::vector<Stone> stones;
    for (int i = 0; i < variation.count; ++i) {
        std::array<double, 3> p{};
        for (double& value : p) {
            // u to a multiple of 1/4: products and roots only, which are correctly rounded.
            const double root = std::sqrt(std::sqrt(random.unit()));
            double v = root;
            for (int quarters = 2; quarters <= 4 * power; ++quarters) v *= root;
            value = (2 * v - 1) * kHalf;
        }
        stones.push_back(stone({p[0], p[1], p[2]}, 1 + 8 * random.unit()));
    }
    return written("drift", "octahedra, thickest in one corner", stones);
}

// A teapot in a stadium: half of the shapes in a small cluster, half in the hall.
std::string stadium_scene(const Variation& variation) {
    Random random(variation.seed);
    const double ratio = stepped(variation, 16, 4096);  // hall to cluster
    const Point middle = random_point(random, kHalf / 2);
    const double half = kHalf / ratio;
    std::vector<Stone> stones;
    for (int i = 0; i < variation.count; ++i) {
        if (i % 2 == 0) {
            stones.push_back(stone(random_point(random, kHalf), 4 + 8 * random.unit()));
        } else {
            const Point p = random_point(random, half);
            stones.push_back(stone({middle.x + p.x, middle.y + p.y, middle.z + p.z}, half / 20));
        }
    }
    return written("stadium", "a dense cluster in a sparse hall", stones);
}

// Long and thin, along the axes: planes cut many.
std::string sticks_scene(const Variation& variation) {
    Random random(variation.seed);
    const double length = stepped(variation, 20, 200);
    std::vector<Stone> stones;
    for (int i = 0; i < variation.count; ++i) {
        const Point center = random_point(random, kHalf);
        Stone s = stone(center, 3);
        const auto axis = static_cast<int>(random.unit() * 3);
        (axis == 0 ? s.radius.x : axis == 1 ? s.radius.y : s.radius.z) = length;
        stones.push_back(s);
    }
    return written("sticks", "long thin octahedra along the axes", stones);
}

// Sizes over a wide range: few large ones around and among many small ones.
std::string sizes_scene(const Variation& variation) {
    Random random(variation.seed);
    const double largest = stepped(variation, 16, 256);
    std::vector<Stone> stones;
    for (int i = 0; i < variation.count; ++i) {
        const Point center = random_point(random, kHalf);
        const double u = 1 - random.unit();
        stones.push_back(stone(center, std::min(largest, 3 / std::sqrt(u))));
    }
    return written("sizes", "octahedra of sizes over a wide range", stones);
}

}  // namespace nuvo::generator
