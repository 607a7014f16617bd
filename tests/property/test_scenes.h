#pragma once

#include <random>

#include "nuvo/scene/scene.h"

namespace nuvo::testing {

inline double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline Point3 uniform_point(std::mt19937_64& random, double half) {
    const double x = uniform(random, -half, half);
    const double y = uniform(random, -half, half);
    return {x, y, uniform(random, -half, half)};
}

inline TriangleMesh octahedron(const Point3& c, double r) {
    TriangleMesh mesh;
    mesh.positions = {c + Vector3{r, 0, 0},  c + Vector3{-r, 0, 0}, c + Vector3{0, r, 0},
                      c + Vector3{0, -r, 0}, c + Vector3{0, 0, r},  c + Vector3{0, 0, -r}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

/// Adds a light from above and one in the middle, a plain material and consecutive shape numbers.
inline void finish(Scene& scene) {
    scene.materials = {Material{}};
    scene.shape_count = scene.objects.size();
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) scene.objects[i].shape_index = i;
    Light sun;
    sun.direction = {0, -1, 0};
    Light lamp;
    lamp.kind = Light::Kind::kPoint;
    lamp.radius = 1e9;
    scene.lights = {sun, lamp};
    scene.camera.position = {0, 0, 30};
}

/// Octahedra on the points of an integer grid, so that faces of octants, edges and corners of
/// triangles and exact diagonals coincide; spheres and ellipsoids between them.
inline Scene grid_scene() {
    Scene scene;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z)
                scene.objects.push_back({octahedron({x * 4.0, y * 4.0, z * 4.0}, 1)});
    for (int i = -2; i < 2; ++i) {
        scene.objects.push_back({Sphere{{i * 4.0 + 2, 2, 2}, 1}});
        scene.objects.push_back(
            {Ellipsoid{{2, i * 4.0 + 2, -2}, {{{1, 0, 0}, {0, 2, 0}, {0, 0, 0.5}}}, 1}});
    }
    finish(scene);
    return scene;
}

/// Triangles and spheres of all sizes anywhere in a cube of half side 10, all of them crossing.
inline Scene random_scene(unsigned seed, int count) {
    std::mt19937_64 random(seed);
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const Point3 center = uniform_point(random, 10);
        const double size = std::exp2(uniform(random, -5, 1.5));
        if (i % 3 == 0) {
            scene.objects.push_back({Sphere{center, size}});
        } else {
            TriangleMesh mesh;
            for (int k = 0; k < 3; ++k)
                mesh.positions.push_back(center + uniform_point(random, 1) * size);
            mesh.triangles = {{0, 1, 2}};
            scene.objects.push_back({mesh});
        }
    }
    finish(scene);
    return scene;
}

}  // namespace nuvo::testing
