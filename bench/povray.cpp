#include <cmath>
#include <fstream>
#include <stdexcept>

#include "contest.h"

// The scene in the language of POV-Ray 3.7: the same camera, lights, materials and background, one
// mesh2 or sphere a shape. POV-Ray's axes are left-handed, so `right` is turned about.

namespace nuvo::bench {
namespace {

template <typename T>
std::string vec(const Vec3<T>& v) {
    return "<" + std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z) + ">";
}

void write_camera(std::ostream& out, const Camera& camera) {
    if (camera.window) {
        const OrthoWindow& window = *camera.window;
        // It shows the window, and more on one axis.
        out << "#declare Pixel = max(" << window.high.x - window.low.x << "/image_width, "
            << window.high.y - window.low.y << "/image_height);\n"
            << "camera { orthographic location " << vec(RayGenerator(camera, {1, 1}).middle())
            << " direction " << vec(camera.forward) << " up " << vec(camera.up)
            << "*Pixel*image_height right " << vec(camera.right) << "*Pixel*image_width }\n";
        return;
    }
    // The picture is wide: the field of view is the vertical one.
    const double half = std::tan(camera.field_of_view_rad / 2);
    out << "camera { perspective location " << vec(camera.position) << " direction "
        << vec(camera.forward) << " up " << vec(camera.up * (2 * half)) << " right "
        << vec(camera.right * (2 * half)) << "*image_width/image_height }\n";
}

void write_light(std::ostream& out, const Light& light) {
    const std::string color = " rgb " + vec(light.color * light.intensity);
    if (light.kind == Light::Kind::kDirectional) {
        // Parallel rays, from far beyond the scene.
        constexpr double kFarAway = 1e6;
        out << "light_source { " << vec(light.direction * -kFarAway) << color
            << " parallel point_at <0,0,0> }\n";
    } else if (light.kind == Light::Kind::kPoint) {
        out << "light_source { " << vec(light.location) << color << " }\n";
    } else {
        throw std::invalid_argument("the comparison with POV-Ray lights no spots");
    }
}

void write_materials(std::ostream& out, const FloatScene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        out << "#declare M" << i << " = texture { pigment { rgb " << vec(scene.materials[i].diffuse)
            << " } finish { ambient 0 diffuse 1 specular 0 } }\n";
}

void write_mesh(std::ostream& out, const FloatScene& scene) {
    out << "mesh2 { vertex_vectors { " << scene.positions.size() - 1;
    for (std::size_t i = 0; i + 1 < scene.positions.size(); ++i)
        out << ",\n" << vec(scene.positions[i]);
    out << " }\n";
    if (!scene.normals.empty()) {
        out << "normal_vectors { " << scene.normals.size();
        for (const Float3& n : scene.normals) out << ",\n" << vec(n);
        out << " }\n";
    }
    const auto write_corners = [&](const IndexTriple& t) {
        out << "<" << t[0] << "," << t[1] << "," << t[2] << ">";
    };
    out << "texture_list { " << scene.materials.size();
    for (std::size_t i = 0; i < scene.materials.size(); ++i) out << ", texture { M" << i << " }";
    out << " }\nface_indices { " << scene.triangles.size();
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        out << ",\n";
        write_corners(scene.triangles[i]);
        out << "," << scene.triangle_material[i];
    }
    out << " }\n";
    if (!scene.normals.empty()) {
        out << "normal_indices { " << scene.normal_triangles.size();
        for (const IndexTriple& t : scene.normal_triangles) {
            out << ",\n";
            write_corners(t);
        }
        out << " }\n";
    }
    out << "}\n";
}

}  // namespace

void write_povray(const Scene& scene, const Primitives& primitives, const std::string& file) {
    const FloatScene floats = to_float(scene, primitives);
    std::ofstream out(file, std::ios::trunc);
    out << "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n";
    write_camera(out, scene.camera);
    for (const Light& light : scene.lights) write_light(out, light);
    // Eq. 36: ground at the nadir, sky at the zenith.
    out << "sky_sphere { pigment { gradient y color_map { [0 rgb " << vec(floats.ground)
        << "] [1 rgb " << vec(floats.sky) << "] } scale 2 translate -1 } }\n";
    write_materials(out, floats);
    if (!floats.triangles.empty()) write_mesh(out, floats);
    for (std::size_t i = 0; i < floats.spheres.size(); ++i) {
        const auto& [x, y, z, radius] = floats.spheres[i];
        out << "sphere { " << vec(Float3{x, y, z}) << ", " << radius << " texture { M"
            << floats.sphere_material[i] << " } }\n";
    }
    out << std::flush;
    if (!out) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace nuvo::bench
