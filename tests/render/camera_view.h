#pragma once

#include <random>

#include "fast/tile/camera_rays.h"
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
    View(const Camera& camera_in, const LocalFrame& frame_in)
        : scene(scene_of(camera_in)), frame(frame_in), camera(scene.camera, kPicture, frame) {}
    View(const Camera& camera_in, double scale) : View(camera_in, LocalFrame{{}, scale, 0.25}) {}

    RealVector direction(Real x, Real y) const {
        const RealVector forward(camera.forward);
        return camera.parallel
                   ? forward
                   : forward + RealVector(camera.right) * x + RealVector(camera.down) * y;
    }
    /// Where the exact ray of a pixel starts, in the local frame.
    RealVector start(int x, int y) const {
        return RealVector(camera.rays.ray(x, y).origin) * Real(frame.scale);
    }
};

/// Where the ray of pixel coordinates X, Y starts, in world space, but for roundings.
inline Point3 start_of(const CameraRays& rays, double x, double y) {
    return rays.parallel ? rays.rays.middle() + rays.offset(x, y) * (1 / rays.scale) : rays.anchor;
}

inline Camera random_camera(std::mt19937_64& random, bool telescope = false) {
    const Point3 eye = uniform_point(random, 1);
    Camera camera = camera_along(eye, uniform_point(random, 1));
    if (random() % 3 == 0) camera.field_of_view_rad = uniform(random, 1, 2.9);
    if (telescope) camera.field_of_view_rad = std::exp2(uniform(random, -36, -24));
    return camera;
}

/// Of parallel rays; `near`: a pixel is as wide as floats of the scene are apart.
inline Camera random_parallel_camera(std::mt19937_64& random, bool near = false) {
    Camera camera = random_camera(random);
    camera.position = camera.position * std::exp2(uniform(random, 0, 8));
    const double wide = std::exp2(near ? uniform(random, -24, -16) : uniform(random, -3, 4));
    return parallel_camera(camera, wide);
}

/// Of parallel rays in one of three rounds.
inline Camera camera_of_round(std::mt19937_64& random, int round, bool near = false) {
    return round % 3 == 0 ? random_parallel_camera(random, near) : random_camera(random, near);
}

}  // namespace nuvo::testing
