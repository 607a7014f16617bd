#include "lights.h"

#include <algorithm>
#include <limits>

namespace nuvo::hard {
namespace {

Light lamp_at(const Point3& location) {
    Light light;
    light.kind = Light::Kind::kPoint;
    light.location = location;
    light.ambient_intensity = 0.5;
    light.intensity = 0.5;
    light.radius = std::numeric_limits<double>::max();
    return light;
}

Color any_color(Random& random) {
    return {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
}

Material any_material(Random& random) {
    Material material;
    material.diffuse_color = any_color(random);
    material.ambient_intensity = random.chance() ? 1 : random.uniform(0, 1);
    if (random.chance()) material.specular_color = any_color(random);
    constexpr double kShininess[] = {0, 1, 0.2, 1e-3, 1e-60};
    material.shininess = random.chance() ? random.uniform(0, 1) : kShininess[random.below(5)];
    if (random.below(4) == 0) material.emissive_color = any_color(random) * 0.3;
    material.lit = random.below(8) != 0;
    return material;
}

Light any_light(const Scene& scene, Aims& aims, Random& random) {
    const Object& target = aims.object();
    const Point3 middle = Aims::middle(target);
    const double size = Aims::half_size(target);
    Light light;
    light.kind = static_cast<Light::Kind>(random.below(3));
    light.color = any_color(random);
    light.intensity = random.uniform(0.3, 1);
    light.ambient_intensity = random.chance() ? 0 : random.uniform(0, 1);
    if (random.chance()) {
        const Vector3 way = random.unit();
        light.location = middle + way * (size * random.uniform(1.2, 6));
    } else {
        light.location = aims.outside();
    }
    light.direction = normalized(random.chance() ? middle - light.location : random.unit());
    const double distance = length(middle - light.location);
    light.radius =
        random.chance() ? std::numeric_limits<double>::max() : distance * random.uniform(0.7, 2);
    light.units_per_world = random.chance() ? 1 : random.uniform(0.5, 2);
    if (random.chance() && distance > 0) {
        const double d = distance * light.units_per_world;
        light.attenuation = {random.uniform(0, 1), random.uniform(0, 1) / d,
                             random.uniform(0, 1) / (d * d)};
    }
    // A cone as wide as the target, wider, or far narrower.
    const double seen = distance > 0 ? std::min(size / distance, 1.5) : 1.5;
    const double narrow = random.below(4) == 0 ? random.power_of_ten(-6, 0) : 1;
    light.cut_off_angle = std::clamp(seen * narrow * random.uniform(0.3, 2), 1e-9, 1.57);
    light.beam_width = light.cut_off_angle * random.uniform(0, 1.3);
    if (random.below(4) == 0) {
        const auto objects = static_cast<int>(scene.objects.size());
        light.scope.first = static_cast<std::uint32_t>(random.below(objects));
        light.scope.last =
            light.scope.first + 1 + static_cast<std::uint32_t>(random.below(objects));
    }
    light.casts_shadow = random.below(8) != 0;
    return light;
}

// Normals of any length within some 60 degrees of the mesh's own way out, and colors.
void paint(TriangleMesh& mesh, Random& random) {
    const Point3 middle = mesh.bounds().min + (mesh.bounds().max - mesh.bounds().min) * 0.5;
    if (random.chance())
        for (const Point3& p : mesh.positions) {
            const Vector3 normal = normalized(p - middle) + random.unit() * 0.8;
            mesh.normals.push_back(normal * random.uniform(0.5, 2));
        }
    if (random.chance())
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.colors.push_back(any_color(random));
}

}  // namespace

void light_from_hard_places(Scene& scene, Aims& aims, Random& random) {
    scene.lights.push_back(lamp_at(aims.feature()));
    scene.lights.push_back(lamp_at(aims.on_surface(aims.object())));
    scene.lights.push_back(lamp_at(random.chance() ? aims.outside() : aims.middle(aims.object())));
    Light sun;
    sun.ambient_intensity = 0.5;
    sun.intensity = 0.5;
    sun.direction = {};
    sun.direction[random.below(3)] = random.sign();
    if (random.chance()) sun.direction = random.unit();
    scene.lights.push_back(sun);
    for (Object& object : scene.objects) {
        object.solid = random.chance();
        object.casts_shadow = random.below(8) != 0;
    }
    scene.materials[0].specular_color = {0.3, 0.3, 0.3};
    scene.materials[0].ambient_intensity = 1;
}

void light_richly(Scene& scene, Aims& aims, Random& random) {
    scene.materials.clear();
    for (Object& object : scene.objects) {
        object.material = static_cast<std::uint32_t>(scene.materials.size());
        object.solid = random.chance();
        object.casts_shadow = random.below(8) != 0;
        scene.materials.push_back(any_material(random));
        auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        if (mesh != nullptr && random.chance()) paint(*mesh, random);
    }
    for (int i = 1 + random.below(4); i > 0; --i)
        scene.lights.push_back(any_light(scene, aims, random));
}

}  // namespace nuvo::hard
