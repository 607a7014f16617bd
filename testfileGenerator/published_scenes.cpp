// The scenes of the thesis' tests 1 to 4 (section 5.7.3), as its author's generators made them: the
// same positions, sizes, colours, cameras and lights.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "camera.h"
#include "float_sine.h"
#include "glibc_rand.h"
#include "scenes.h"
#include "x3d_text.h"

namespace nuvo::generator {

namespace {

struct Body {
    std::array<float, 3> center;
    int size = 0;  ///< of a sphere its radius, of an octahedron the distance of its corners
    std::string color;
};

struct TestScene {
    std::string_view name;
    std::string_view description;
    std::string_view viewpoint;  ///< its attributes
    std::string_view sky;
    std::string_view lights;  ///< their elements
    bool spheres = false;
    std::vector<Body> bodies;
};

/// The shortest text that reads back as the same float.
std::string float_text(float value) {
    std::array<char, 64> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                   value == 0 ? 0 : value, std::chars_format::fixed);
    return {buffer.data(), end.ptr};
}

std::string octahedron_name(int size) { return "Octahedron" + std::to_string(size); }

std::string octahedron_text(int size) {
    const auto axes = [](const std::string& s) {
        return s + " 0 0 0 0 " + s + " -" + s + " 0 0 0 " + s + " 0 0 -" + s + " 0 0 0 -" + s;
    };
    return "<IndexedTriangleSet DEF='" + octahedron_name(size) +
           "' index='0 1 4 2 4 1 3 1 0 1 3 2 0 5 4 2 4 5 3 5 0 5 3 2'><Coordinate point='" +
           axes(std::to_string(size)) + "'/><Normal vector='" + axes("1") +
           "'/></IndexedTriangleSet>";
}

/// The camera's attributes where `place` wants another than the scene's own.
std::string placed_viewpoint(const TestScene& scene, CameraPlace place) {
    double half_height = 0;
    double front = 0;
    for (const Body& body : scene.bodies) {
        const double size = body.size;
        half_height = std::max(half_height, std::abs(body.center[1]) + size);
        front = std::max(front, body.center[2] + size);
    }
    const double z = front + camera_fraction(place, 0) * fitting_distance(half_height);
    return "position='0 0 " + number(std::round(z)) + "' fieldOfView='0.7853981633974483'";
}

std::string text(const TestScene& scene, CameraPlace place) {
    std::string out = scene_head(scene.name, scene.description);
    out += "    <NavigationInfo headlight='false'/>\n    <Viewpoint ";
    out +=
        place == CameraPlace::kOwn ? std::string(scene.viewpoint) : placed_viewpoint(scene, place);
    out += "/>\n    <Background groundColor='0.43 0.54 0.72' skyColor='" + std::string(scene.sky) +
           "'/>\n" + std::string(scene.lights);
    std::set<int> sizes;  // of the octahedra that are written in full
    for (const Body& body : scene.bodies) {
        out += "    <Transform translation='" + float_text(body.center[0]) + " " +
               float_text(body.center[1]) + " " + float_text(body.center[2]) +
               "'><Shape><Appearance><Material diffuseColor='" + body.color + "'/></Appearance>";
        if (scene.spheres)
            out += "<Sphere radius='" + std::to_string(body.size) + "'/>";
        else if (sizes.insert(body.size).second)
            out += octahedron_text(body.size);
        else
            out += "<IndexedTriangleSet USE='" + octahedron_name(body.size) + "'/>";
        out += "</Shape></Transform>\n";
    }
    return out + scene_foot();
}

std::string color_text(double r, double g, double b) { return triple({r, g, b}); }

/// The octahedron at a whole position, in the colour that follows from the position's last two
/// digits.
Body octahedron_at(int x, int y, int z, int size) {
    const auto channel = [](int coordinate) { return std::abs(coordinate % 100) / 100.0; };
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)},
            size,
            color_text(channel(x), channel(y), channel(z))};
}

}  // namespace

std::string trianglemesh_scene(const Variation& variation) {
    constexpr int kHalf = 80;
    constexpr int kStep = 20;
    constexpr int kSize = 2;
    TestScene scene{"trianglemesh",
                    "Thesis test 1: 728 octahedra, a 9 x 9 x 9 grid without its middle",
                    "position='0 0 200'",
                    "0.65 0.74 0.88",
                    "    <PointLight location='0 0 0' radius='100'/>\n"
                    "    <DirectionalLight direction='-0.3 -0.3 -1'/>\n",
                    false,
                    {}};
    const auto channel = [](int place) { return (place + kHalf) / (2.0 * kHalf); };
    for (int x = -kHalf; x <= kHalf; x += kStep)
        for (int y = -kHalf; y <= kHalf; y += kStep)
            for (int z = -kHalf; z <= kHalf; z += kStep) {
                if (x == 0 && y == 0 && z == 0) continue;
                scene.bodies.push_back(
                    {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)},
                     kSize,
                     color_text(channel(x), channel(y), channel(z))});
            }
    return text(scene, variation.camera);
}

std::string both_scene(const Variation& variation) {
    constexpr int kCount = 1000;
    constexpr int kSide = 1000;
    TestScene scene{"both",
                    "Thesis test 2: 1,000 octahedra at random in a cube of side 1,000",
                    "position='0 0 800' fieldOfView='0.9'",
                    "0.65 0.74 0.88",
                    "    <DirectionalLight direction='1 0 -1' intensity='0.2'/>\n"
                    "    <PointLight location='0 0 0' radius='1000'/>\n",
                    false,
                    {}};
    GlibcRand rand;
    for (int i = 0; i < kCount; ++i) {
        const int x = rand() % kSide - kSide / 2;
        const int y = rand() % kSide - kSide / 2;
        const int z = rand() % kSide - kSide / 2;
        // Smaller towards the camera.
        const double size = std::max(1.0, rand() % 15 + 1 - z / 250.0);
        scene.bodies.push_back(octahedron_at(x, y, z, static_cast<int>(size)));
    }
    return text(scene, variation.camera);
}

std::string concentric_scene(const Variation& variation) {
    constexpr double kTurn = 2 * 3.14159265;  // so the author wrote it
    constexpr int kRadius = 10;
    constexpr int kPerMeridian = 19;
    struct Shell {
        int distance;
        std::string_view color;
    };
    constexpr std::array<Shell, 5> kShells{{{1500, "0.66 0.22 0.22"},
                                            {1250, "0.13 0.4 0.4"},
                                            {1000, "0.66 0.42 0.22"},
                                            {750, "0.17 0.53 0.17"},
                                            {500, "0.42 0.25 0.52"}}};
    TestScene scene{"concentric",
                    "Thesis test 3: 5,985 spheres on five concentric larger spheres",
                    "position='0 0 2500' fieldOfView='1.3'",
                    "0.65 0.74 0.88",
                    "    <DirectionalLight direction='1 0 -1' intensity='0.3'/>\n"
                    "    <DirectionalLight direction='0 1 -1' intensity='0.3'/>\n",
                    true,
                    {}};
    for (const Shell& shell : kShells) {
        const auto distance = static_cast<float>(shell.distance);
        // The sum of so many roundings is part of the scene. The first angle puts its 19 spheres at
        // one point.
        for (float i = 0; i <= kTurn; i = static_cast<float>(i + 0.1))
            for (int j = 1; j <= kPerMeridian; ++j) {
                const float around = i * static_cast<float>(j);
                const float x = distance * float_cosine(i) * float_sine(around);
                const float y = distance * float_sine(i) * float_sine(around);
                const float z = distance * float_cosine(around);
                scene.bodies.push_back({{x, y, z}, kRadius, std::string(shell.color)});
            }
    }
    return text(scene, variation.camera);
}

std::string clumped_scene(const Variation& variation) {
    constexpr int kPerClump = 50;
    constexpr int kStep = 50;
    constexpr int kSize = 15;
    constexpr std::array kOuter{-1000, 1000};
    constexpr std::array kInner{-250, 250};
    TestScene scene{"clumped",
                    "Thesis test 4: 3,200 octahedra in 64 clumps of 50",
                    "position='0 0 3300' fieldOfView='1.2'",
                    "0.91 0.81 0.91",
                    "    <DirectionalLight direction='1 0 -1' intensity='0.2'/>\n"
                    "    <PointLight location='0 0 0' radius='10000'/>\n",
                    false,
                    {}};
    GlibcRand rand;
    const auto walk = [&](int x, int y, int z) {
        for (int i = 0; i < kPerClump; ++i) {
            for (int* coordinate : {&x, &y, &z}) {
                const bool forward = rand() % 2 == 0;
                const int step = rand() % kStep;
                *coordinate += forward ? step : -step;
            }
            scene.bodies.push_back(octahedron_at(x, y, z, kSize));
        }
    };
    for (const int bx : kOuter)
        for (const int by : kOuter)
            for (const int bz : kOuter)
                for (const int xm : kInner)
                    for (const int ym : kInner)
                        for (const int zm : kInner) walk(bx + xm, by + ym, bz + zm);
    return text(scene, variation.camera);
}

}  // namespace nuvo::generator
