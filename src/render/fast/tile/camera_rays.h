#pragma once

#include <cmath>

#include "fast/scene/local_frame.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/scene/camera.h"

namespace nuvo {

/// The primary rays of a picture as affine functions of the pixel coordinates X, Y, in double, in
/// the local frame. A camera's eye is homogeneous, so that planes seen from it have the same
/// functions in both projections: [numerics: functions of the pixel]
/// - in perspective a ray's points are eye + t direction(X, Y) [eq. 34, 35]; q = 1 / t, and the
///   view's direction has the component 1 along forward;
/// - in a parallel projection, whose eye is infinitely far, they are anchor + offset(X, Y) - q
///   forward. The anchor is near the frame's origin, so that q has most digits there.
/// Of two hits the nearer one has the larger q, and q of a plane is affine in X, Y.
struct CameraRays {
    CameraRays(const Camera& camera, Resolution size, const LocalFrame& frame)
        : resolution(size),
          rays(camera, size),
          parallel(camera.window.has_value()),
          scale(frame.scale),
          forward(camera.forward),
          right(rays.step_right() * (parallel ? scale : 1)),
          down(rays.step_down() * (parallel ? scale : 1)) {
        anchor = camera.position;
        if (parallel) {
            const Point3& middle = rays.middle();
            const double depth = dot(middle - frame.center, forward);
            anchor = middle - forward * depth;
            starts_at = -depth * scale;
            start_error = gamma(8) * ((max_norm(middle) + std::fabs(depth)) * scale +
                                      max_norm(right) * size.width + max_norm(down) * size.height);
        }
        origin = frame.local(anchor);
    }

    /// Pixel coordinates count from the picture's centre: X = x + 0.5 - width / 2.
    Vector3 offset(double from_center_x, double from_center_y) const {
        return right * from_center_x + down * from_center_y;
    }
    Vector3 direction(double from_center_x, double from_center_y) const {
        return parallel ? forward : forward + offset(from_center_x, from_center_y);
    }
    double center_x(int x) const { return x + 0.5 - 0.5 * resolution.width; }
    double center_y(int y) const { return y + 0.5 - 0.5 * resolution.height; }

    /// q of a point of the exact ray of pixel x, y, whose direction has length 1, at t in world
    /// lengths; within `error` and a few roundings of its own.
    struct Near {
        double value;
        double error;
    };
    Near near(int x, int y, double t) const {
        const double way = t * scale;
        if (parallel)
            return {starts_at - way, start_error + gamma(8) * (std::fabs(starts_at) + way)};
        return {length(direction(center_x(x), center_y(y))) / way, 0};
    }

    /// Below q of all that a scene holds: the background's.
    float background() const { return parallel ? -4.0F : 0.0F; }
    /// Whether double arithmetic tells pixels apart.
    bool is_sharp() const {
        constexpr double kPixel = 0x1p-9;
        return !parallel || start_error < kPixel * std::fmin(max_norm(right), max_norm(down));
    }

    Resolution resolution;
    RayGenerator rays;  ///< the exact rays, in world space
    bool parallel;
    double scale;   ///< of the local frame
    Point3 anchor;  ///< world space; in perspective the eye
    Point3 origin;  ///< the anchor in the local frame
    Vector3 forward;
    Vector3 right;  ///< to the next pixel of the row
    Vector3 down;   ///< to the next row

    // Of a parallel projection.
    double starts_at = 0;    ///< q where rays start: only what has less is before them
    double start_error = 0;  ///< bounds how far the exact rays are beside these, on each axis
};

}  // namespace nuvo
