#pragma once

#include <random>

#include "fast/tile/tile.h"
#include "fast_cases.h"
#include "real_numbers.h"

namespace nuvo::testing {

inline constexpr Resolution kPicture{1920, 1080};

/// A camera's rays over a large picture, in a local frame of that scale.
struct View {
    Scene scene;
    LocalFrame frame;
    CameraRays camera;

    static Scene scene_of(const Camera& camera) {
        Scene scene;
        scene.camera = camera;
        return scene;
    }
    View(const Camera& camera_in, double scale)
        : scene(scene_of(camera_in)),
          frame{{}, scale, 0.25},
          camera(scene.camera, kPicture, frame) {}

    RealVector direction(Real x, Real y) const {
        return RealVector(camera.forward) + RealVector(camera.right) * x +
               RealVector(camera.down) * y;
    }
};

inline Camera random_camera(std::mt19937_64& random, bool telescope = false) {
    const Point3 eye = uniform_point(random, 1);
    Camera camera = camera_along(eye, uniform_point(random, 1));
    if (random() % 3 == 0) camera.field_of_view_rad = uniform(random, 1, 2.9);
    if (telescope) camera.field_of_view_rad = std::exp2(uniform(random, -36, -24));
    return camera;
}

}  // namespace nuvo::testing
