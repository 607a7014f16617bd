#include <array>
#include <string>
#include <string_view>

#include "mesh.h"
#include "scenes.h"
#include "x3d_text.h"

namespace nuvo::generator {

namespace {

/// Places what `child` says (one element) at `position`.
std::string placed(Point position, std::string_view child) {
    return "    <Transform translation='" + triple(position) + "'>\n" + std::string(child) +
           "    </Transform>\n";
}

std::string shape(std::string_view appearance_text, std::string_view geometry_text) {
    return "      <Shape>\n" + std::string(appearance_text) + std::string(geometry_text) +
           "      </Shape>\n";
}

constexpr std::string_view kIndent = "        ";

/// Figures 19 and 20: one octahedron, seen from the thesis' usual place.
std::string one_octahedron(std::string_view name, std::string_view description, Shading shading) {
    std::string out = scene_head(name, description);
    out += "    <Viewpoint position='0 0 10'/>\n" + sky_and_no_headlight();
    out += "    <DirectionalLight direction='-0.3 -0.3 -1'/>\n";
    out += shape(appearance("diffuseColor='0.8 0.25 0.2'", "", kIndent),
                 triangle_set(octahedron(3), "", shading, kIndent));
    return out + scene_foot();
}

}  // namespace

std::string figure_19(const Variation&) {
    return one_octahedron("figure19", "Thesis figure 19: face normals", Shading::kFlat);
}

std::string figure_20(const Variation&) {
    return one_octahedron("figure20", "Thesis figure 20: vertex normals", Shading::kSmooth);
}

std::string icosphere_scene(const Variation&) {
    // The camera of the thesis' validation tests sees 4.14 up and down at the origin: spheres of
    // this radius at these distances fill the picture and leave the light in the middle free.
    constexpr double kRadius = 1.6;
    constexpr double kOffset = 2;
    constexpr int kSubdivisions = 1;  // 80 triangles, what Blender makes unasked
    // The standard's default specularColor is black, with which shininess shows nothing; the
    // published program's is white.
    constexpr std::string_view kFields = "diffuseColor='1 0 0' specularColor='1 1 1' shininess='";

    struct Ball {
        Point position;
        std::string_view shininess;
    };
    constexpr std::array<Ball, 4> kBalls{{{{-kOffset, kOffset, 0}, "1"},
                                          {{kOffset, kOffset, 0}, "0.1"},
                                          {{-kOffset, -kOffset, 0}, "1"},
                                          {{kOffset, -kOffset, 0}, "0.1"}}};

    std::string out = scene_head(
        "icosphere", "Four icospheres around a point light; shininess 1 on the left, 0.1 right");
    out += "    <Viewpoint position='0 0 10'/>\n" + sky_and_no_headlight();
    out += "    <PointLight location='0 0 0'/>\n";
    bool is_first = true;
    for (const Ball& ball : kBalls) {
        const std::string fields = std::string(kFields) + std::string(ball.shininess) + "'";
        const std::string geometry =
            is_first ? triangle_set(icosphere(kRadius, kSubdivisions), "Icosphere", Shading::kFlat,
                                    kIndent)
                     : std::string(kIndent) + "<IndexedTriangleSet USE='Icosphere'/>\n";
        out += placed(ball.position, shape(appearance(fields, "", kIndent), geometry));
        is_first = false;
    }
    return out + scene_foot();
}

std::string showcase_scene(const Variation&) {
    const Mesh plate{{{-5, 0, -4.2}, {-5, 0, 2.8}, {5, 0, 2.8}, {5, 0, -4.2}},
                     {{0, 1, 2}, {0, 2, 3}}};
    struct Item {
        Point position;
        std::string_view material;
        Mesh mesh;
        Shading shading;
    };
    // Everything stands on the plate. ambientIntensity 1 lets the lights' own ambient part through,
    // so that the side away from a light is not black.
    const std::array<Item, 4> items{{
        {{0, 0, 0}, "diffuseColor='0.78 0.76 0.72' ambientIntensity='1'", plate, Shading::kFlat},
        {{-2.7, 1.25, -0.4},
         "diffuseColor='0.16 0.5 0.52' ambientIntensity='1' specularColor='0.3 0.3 0.3'",
         icosphere(1.25, 1),
         Shading::kFlat},
        {{0.1, 1.5, -1.2},
         "diffuseColor='0.83 0.33 0.22' ambientIntensity='1' specularColor='0.6 0.6 0.6' "
         "shininess='0.4'",
         icosphere(1.5, 4),
         Shading::kSmooth},
        {{2.6, 1.35, 0.5},
         "diffuseColor='0.9 0.68 0.25' ambientIntensity='1' specularColor='0.3 0.3 0.3'",
         octahedron(1.35),
         Shading::kFlat},
    }};
    std::string out =
        scene_head("showcase", "A faceted ball, a smooth ball and an octahedron on a plate");
    out += "    <Viewpoint position='0 4.4 8.7' orientation='1 0 0 -0.385'/>\n";
    out += sky_and_no_headlight();
    // The sun, a lamp, and a weak light along the view that keeps the shadows of both from black.
    out +=
        "    <DirectionalLight direction='0.55 -0.8 -0.5' intensity='0.5' "
        "ambientIntensity='0.05'/>\n";
    out +=
        "    <PointLight location='3.5 6.5 6' intensity='0.45' ambientIntensity='0.05' "
        "color='1 0.95 0.88'/>\n";
    out +=
        "    <DirectionalLight direction='0 -0.435 -0.9' intensity='0.15' "
        "ambientIntensity='0.1'/>\n";
    for (const Item& item : items) {
        out += placed(item.position, shape(appearance(item.material, "", kIndent),
                                           triangle_set(item.mesh, "", item.shading, kIndent)));
    }
    return out + scene_foot();
}

}  // namespace nuvo::generator
