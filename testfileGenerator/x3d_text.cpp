#include "x3d_text.h"

#include <array>
#include <charconv>
#include <cstddef>

namespace nuvo::generator {

namespace {

constexpr std::size_t kPointsPerLine = 4;
constexpr std::size_t kTrianglesPerLine = 8;

std::string def_attribute(std::string_view def) {
    return def.empty() ? std::string() : std::string(" DEF='").append(def).append("'");
}

/// What goes between item `i - 1` and item `i` of a long list.
std::string separator(std::size_t i, std::size_t per_line, std::string_view indent) {
    if (i == 0) return {};
    return i % per_line == 0 ? std::string("\n").append(indent) : std::string(" ");
}

}  // namespace

std::string number(double value) {
    // Longest: a sign, "0.", 323 zeros and 17 digits.
    std::array<char, 400> buffer;
    const double plain = value == 0 ? 0 : value;
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), plain,
                                      std::chars_format::fixed);
    return {buffer.data(), result.ptr};
}

std::string triple(Point p) { return number(p.x) + " " + number(p.y) + " " + number(p.z); }

std::string scene_head(std::string_view title, std::string_view description) {
    std::string out =
        "<?xml version='1.0' encoding='UTF-8'?>\n"
        "<!DOCTYPE X3D PUBLIC \"ISO//Web3D//DTD X3D 3.0//EN\"\n"
        "  \"http://www.web3d.org/specifications/x3d-3.0.dtd\">\n"
        "<X3D version='3.0' profile='Immersive'>\n"
        "  <head>\n";
    out += "    <meta name='title' content='" + std::string(title) + "'/>\n";
    out += "    <meta name='description' content='" + std::string(description) + "'/>\n";
    out += "    <meta name='generator' content='testfile_generator'/>\n";
    return out + "  </head>\n  <Scene>\n";
}

std::string scene_foot() { return "  </Scene>\n</X3D>\n"; }

std::string sky_and_no_headlight() {
    return "    <NavigationInfo headlight='false'/>\n"
           "    <Background groundColor='0.43 0.54 0.72' skyColor='0.9 0.74 0.9'/>\n";
}

std::string triangle_set(const Mesh& mesh, std::string_view def, Shading shading,
                         std::string_view indent) {
    const std::string pad(indent);
    std::string out = pad + "<IndexedTriangleSet" + def_attribute(def) + " normalPerVertex='" +
                      (shading == Shading::kSmooth ? "true" : "false") + "' index='";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        out += separator(i, kTrianglesPerLine, indent);
        out += std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c);
    }
    out += "'>\n" + pad + "  <Coordinate point='";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        out += separator(i, kPointsPerLine, indent) + triple(mesh.points[i]);
    }
    return out + "'/>\n" + pad + "</IndexedTriangleSet>\n";
}

std::string appearance(std::string_view fields, std::string_view def, std::string_view indent) {
    return std::string(indent) + "<Appearance" + def_attribute(def) + "><Material " +
           std::string(fields) + "/></Appearance>\n";
}

}  // namespace nuvo::generator
