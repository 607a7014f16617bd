#include "scene_files.h"

#include <array>
#include <cmath>
#include <sstream>

namespace nuvo::hard {
namespace {

constexpr const char* kRed = "0.8 0.2 0.1";
constexpr const char* kGreen = "0.2 0.7 0.3";
constexpr const char* kBlue = "0.2 0.3 0.9";
constexpr const char* kGray = "0.7 0.7 0.7";

std::string text(double v) {
    std::ostringstream out;
    out.precision(17);
    out << v;
    return out.str();
}
std::string text(double x, double y, double z) { return text(x) + " " + text(y) + " " + text(z); }

std::string appearance(const std::string& color) {
    return "<Appearance><Material diffuseColor='" + color +
           "' ambientIntensity='0.5' specularColor='0.3 0.3 0.3' shininess='0.2'/></Appearance>";
}
std::string shape(const std::string& color, const std::string& geometry) {
    return "    <Shape>" + appearance(color) + geometry + "</Shape>\n";
}
std::string moved(const std::string& fields, const std::string& content) {
    return "    <Transform " + fields + ">\n" + content + "    </Transform>\n";
}
std::string at(double x, double y, double z, const std::string& content) {
    return moved("translation='" + text(x, y, z) + "'", content);
}
std::string ball(const std::string& color, double x, double y, double z, double radius) {
    return at(x, y, z, shape(color, "<Sphere radius='" + text(radius) + "'/>"));
}
std::string box(const std::string& color, const std::string& size) {
    return shape(color, "<Box size='" + size + "'/>");
}
std::string faces(const std::string& color, const std::string& index, const std::string& points,
                  const std::string& fields = "solid='false'") {
    return shape(color, "<IndexedFaceSet " + fields + " coordIndex='" + index +
                            "'><Coordinate point='" + points + "'/></IndexedFaceSet>");
}
// A square in the plane of height y.
std::string square(const std::string& color, double half, double y) {
    return faces(color, "0 1 2 3 -1",
                 text(-half, y, half) + ", " + text(half, y, half) + ", " + text(half, y, -half) +
                     ", " + text(-half, y, -half));
}
// An octahedron whose normals are blended.
std::string smooth(const std::string& color) {
    return faces(color, "0 2 4 -1 2 1 4 -1 1 3 4 -1 3 0 4 -1 2 0 5 -1 1 2 5 -1 3 1 5 -1 0 3 5 -1",
                 "1 0 0, -1 0 0, 0 1 0, 0 -1 0, 0 0 1, 0 0 -1", "creaseAngle='4'");
}

std::string sun(const std::string& direction) {
    return "    <DirectionalLight global='true' direction='" + direction +
           "' intensity='0.6' ambientIntensity='0.3'/>\n";
}
std::string lamp(const std::string& location, const std::string& more = "") {
    return "    <PointLight location='" + location +
           "' intensity='0.8' ambientIntensity='0.3' radius='1000'" + more + "/>\n";
}
std::string view(const std::string& position, const std::string& orientation,
                 const std::string& field_of_view = "0.785398") {
    return "    <Viewpoint position='" + position + "' orientation='" + orientation +
           "' fieldOfView='" + field_of_view + "'/>\n";
}

SceneFile file(const std::string& name, const std::string& content) {
    return {name,
            "<?xml version='1.0' encoding='UTF-8'?>\n"
            "<X3D profile='Interchange' version='3.3'>\n  <Scene>\n"
            "    <NavigationInfo headlight='false'/>\n"
            "    <Background skyColor='0.5 0.6 0.8' groundColor='0.3 0.2 0.2'/>\n" +
                content + "  </Scene>\n</X3D>\n"};
}

// A bit of everything; distances of 0 to 10.
std::string arrangement() {
    return view("0 3 9", "1 0 0 -0.2") + sun("-1 -2 -0.5") + lamp("3 5 4") +
           "    <SpotLight location='-4 6 3' direction='0.5 -1 -0.5' beamWidth='0.3' "
           "cutOffAngle='0.6' intensity='0.7' radius='1000'/>\n" +
           square(kGray, 8, 0) + ball(kRed, -2, 1, 0, 1) +
           moved("translation='2 1 -1' rotation='0 1 0 0.6'", box(kBlue, "2 2 2")) +
           at(0, 1.25, 2, smooth(kGreen)) +
           moved("translation='0.5 1.5 -2' rotation='0 0 1 0.5' scale='0.5 1.5 0.75'",
                 shape(kRed, "<Sphere/>")) +
           ball(kBlue, -1, 0.25, 2.5, 0.25);
}

SceneFile placed_file(const std::string& name, const std::string& fields) {
    return file(name, moved(fields, arrangement()));
}

SceneFile planet_and_ants() {
    const double r = 6.4e6;
    std::string ants;
    for (int i = 0; i < 5; ++i) {
        const double x = 0.006 * (i - 2);
        const double z = -0.004 * (i % 3);
        ants += ball(kRed, x, 0.001, z, 0.001) + ball(kBlue, x + 0.0015, 0.0014, z, 0.0008) +
                moved("translation='" + text(x - 0.0018, 0.001, z) + "' scale='0.001 0.001 0.001'",
                      smooth(kGreen));
    }
    return file("planet-and-ants", view("0 0.006 0.03", "1 0 0 -0.15") + sun("-1 -0.4 -0.3") +
                                       lamp("0.01 0.02 0.01") + ball(kGray, 0, -r, 0, r) + ants);
}

// Lights on the floor, on a sphere's pole, on a box's corner and within a sphere.
SceneFile light_on_surface() {
    return file("light-on-surface",
                view("0 3 9", "1 0 0 -0.25") + lamp("0 0 2") + lamp("-2 2 0") + lamp("3 2 0") +
                    lamp("0 1 -3") + square(kGray, 8, 0) + ball(kRed, -2, 1, 0, 1) +
                    at(2, 1, -1, box(kBlue, "2 2 2")) + ball(kGreen, 0, 1, -3, 1) +
                    ball(kGray, 0.5, 0.25, 2.5, 0.25));
}

SceneFile coincident_surfaces() {
    const std::string tilted =
        square(kGreen, 1, 0) +
        faces(kRed, "0 1 2 -1", "-0.5 0 0.5, 1.5 0 0.5, 0.5 0 -1.5", "solid='false'");
    return file("coincident-surfaces",
                view("0 3 9", "1 0 0 -0.25") + sun("-1 -2 -0.5") + lamp("3 5 4") +
                    square(kGray, 8, 0) +
                    faces(kRed, "0 1 2 -1", "-3 0 4, 0 0 2, -4 0 1", "solid='false'") +
                    square(kBlue, 2, 0) + at(2, 1, -1, box(kBlue, "2 2 2")) +
                    at(2, 1, -1, box(kRed, "2 2 2")) + at(2.5, 0.5, -0.5, box(kGreen, "1 1 1")) +
                    ball(kRed, -2, 1, 0, 1) + ball(kBlue, -2, 1, 0, 1) +
                    at(-2, 1, 0, box(kGreen, "2 2 0.5")) +
                    moved("translation='0 1 2.5' rotation='1 1 0 0.7'", tilted));
}

SceneFile contact_gaps() {
    std::string bodies;
    const std::array<double, 6> gaps{0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8};
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const double x = -3.75 + 1.5 * static_cast<double>(i);
        bodies += ball(kRed, x, 0.5 + gaps[i], 1, 0.5) +
                  at(x, 0.5 + gaps[i], -1, box(kBlue, "1 1 1")) +
                  at(x, 1.5 + 2 * gaps[i], -1, box(kGreen, "1 1 1"));
    }
    return file("contact-gaps", view("0 2.5 8", "1 0 0 -0.25") + sun("-1 -2 -0.5") + lamp("3 5 4") +
                                    square(kGray, 8, 0) + bodies);
}

// Fans of needles, strips as thin as 1e-9, faces without area.
SceneFile slivers() {
    std::string points = "0 2 0";
    std::string index;
    for (int i = 0; i <= 60; ++i) {
        const double angle = 0.002 * i * i * 0.9;
        points += ", " + text(3 * std::cos(angle), 2 + 2 * std::sin(angle), 0.01 * i);
        if (i > 0) index += "0 " + std::to_string(i) + " " + std::to_string(i + 1) + " -1 ";
    }
    std::string strips;
    for (int i = 0; i < 6; ++i) {
        const double y = 0.5 + 0.25 * i;
        strips += faces(kRed, "0 1 2 3 -1 0 1 1 -1 0 2 2 -1",
                        text(-4, y, 1) + ", " + text(4, y + 0.1, 1) + ", " +
                            text(4, y + 0.1 + std::pow(10, -1 - 1.6 * i), 1) + ", " +
                            text(-4, y + std::pow(10, -1 - 1.6 * i), 1));
    }
    return file("slivers", view("0 3 9", "1 0 0 -0.1") + sun("-1 -2 -0.5") + lamp("3 5 4") +
                               square(kGray, 8, 0) + at(-3, 0, -1, faces(kGreen, index, points)) +
                               strips +
                               at(3, 1.5, -2, moved("scale='1e-5 1.5 1.5'", smooth(kBlue))));
}

// Light within the floor's plane and at 1e-3 to 1e-6 above it.
SceneFile grazing_light() {
    return file("grazing-light", view("0 3 9", "1 0 0 -0.25") + sun("-1 0 0") + sun("0 -1e-3 -1") +
                                     sun("1 -1e-6 0") + lamp("0 0 4") + square(kGray, 8, 0) +
                                     ball(kRed, -2, 1, 0, 1) + at(2, 1, -1, box(kBlue, "2 2 2")) +
                                     ball(kGreen, 0, 1.5, 1, 0.5) + at(0, 1, 3, smooth(kGreen)));
}

// Blended normals where the light grazes, from the side, from behind and from a spot.
SceneFile terminator() {
    std::string points;
    std::string index;
    constexpr int kAround = 12;
    for (int i = 0; i <= 6; ++i)
        for (int k = 0; k < kAround; ++k) {
            const double up = 3.14159265358979 * (i - 3) / 6.5;
            const double turn = 6.28318530717959 * k / kAround;
            points +=
                text(std::cos(up) * std::cos(turn), std::sin(up), std::cos(up) * std::sin(turn)) +
                ", ";
            const int a = i * kAround + k;
            const int b = i * kAround + (k + 1) % kAround;
            if (i < 6)
                index += std::to_string(a) + " " + std::to_string(a + kAround) + " " +
                         std::to_string(b + kAround) + " " + std::to_string(b) + " -1 ";
        }
    const std::string lathe = faces(kGray, index, points, "creaseAngle='4' solid='false'");
    return file("terminator",
                view("0 0 8", "0 0 1 0") + sun("-1 0 0") + lamp("2 4 -3") +
                    "    <SpotLight location='0 -4 3' direction='0 1 -0.7' beamWidth='0.2' "
                    "cutOffAngle='0.7' ambientIntensity='0.2' radius='1000'/>\n" +
                    moved("translation='-2 0 0' scale='1.5 1.5 1.5'", lathe) +
                    moved("translation='2 1 0' scale='1 1 1' rotation='1 1 0 1'", smooth(kGreen)) +
                    ball(kRed, 2, -1.5, 0, 1) +
                    moved("translation='0 -2 -1' scale='1 0.5 -1'", lathe));
}

SceneFile mirrored_and_sheared() {
    const std::string shear = "scale='2 0.5 1' scaleOrientation='0 0 1 0.7' rotation='0 0 1 0.4'";
    const std::string mirror = "scale='-1 1 1.5' rotation='0 1 0 0.5'";
    return file("mirrored-and-sheared",
                view("0 3 9", "1 0 0 -0.25") + sun("-1 -2 -0.5") + lamp("3 5 4") +
                    square(kGray, 8, 0) +
                    at(-2.5, 1.5, 0, moved(shear, moved(mirror, shape(kRed, "<Sphere/>")))) +
                    at(2.5, 1.5, 0, moved(mirror, moved(shear, smooth(kGreen)))) +
                    at(0, 1, -2, moved(shear, moved(mirror, box(kBlue, "1 1 1")))) +
                    at(0, 1, 2,
                       moved("scale='-0.7 -0.7 -0.7'",
                             moved(shear, shape(kBlue, "<Sphere radius='0.8'/>")))) +
                    moved("translation='0 3 -1' scale='2 1e-3 1'", shape(kGreen, "<Sphere/>")));
}

// In a box, on its front face and within a great sphere; one lamp touches the ceiling.
SceneFile camera_on_surface() {
    return file("camera-on-surface",
                view("0 1 3", "0 0 1 0", "1.2") + lamp("0 3 0") + lamp("1.5 0.5 1") +
                    at(0, 1, 0, box(kGray, "6 4 6")) + ball(kGreen, 0, 1, 3, 4.5) +
                    ball(kRed, -1, 0, 0, 1) + at(1, -0.5, -1, box(kBlue, "1 1 1")) +
                    moved("translation='1 1 0' scale='0.5 0.5 0.5'", smooth(kGreen)));
}

}  // namespace

std::vector<SceneFile> hard_scene_files() {
    std::vector<SceneFile> files;
    for (const char* scale : {"1e-15", "1e-6", "1", "1e6", "1e15"})
        files.push_back(
            placed_file(std::string("scale-") + scale,
                        "scale='" + std::string(scale) + " " + scale + " " + scale + "'"));
    files.push_back(placed_file("moved-by-1e6", "translation='1e6 -1e6 1e6'"));
    for (const auto& make :
         {planet_and_ants, light_on_surface, coincident_surfaces, contact_gaps, slivers,
          grazing_light, terminator, mirrored_and_sheared, camera_on_surface})
        files.push_back(make());
    return files;
}

}  // namespace nuvo::hard
