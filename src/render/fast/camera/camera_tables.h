#pragma once

#include <cmath>

#include "fast/scene/fast_scene.h"
#include "fast/tile/camera_rays.h"
#include "fast/tile/tile.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/render/fast.h"

// What a camera's rays ask of primitives. Of a sphere the vector f x d is affine in the pixel's
// coordinates, and the ray's distance from the centre comes from it without cancellation (Haines et
// al. 2019).

namespace nuvo {

/// How far pixel coordinates and directions reach: over the picture and the middles of its tiles,
/// from which functions are evaluated. A tile that sticks out has its middle less than half a
/// tile outside.
struct CameraExtent {
    explicit CameraExtent(const CameraRays& camera)
        : x(0.5 * (camera.resolution.width + kTileSide)),
          y(0.5 * (camera.resolution.height + kTileSide)),
          direction(3 * max_norm(camera.forward)),
          starts(0) {
        const double offset = 3 * (x * max_norm(camera.right) + y * max_norm(camera.down));
        if (camera.parallel)
            starts = offset + camera.start_error / kUnitRoundoff;
        else
            direction += offset;
    }

    double x;  ///< pixels
    double y;
    double direction;  ///< bounds the sum of |components| of a ray's direction
    /// Of a parallel projection, else 0: bounds that of how far rays are from the anchor; what they
    /// are off is in it, counted as a rounding.
    double starts;
};

/// Of a parallel projection: what has a lower q than `low` stands surely before the rays' starts,
/// what has a higher one than `high` surely behind.
struct StartRange {
    float low;
    float high;
};
inline StartRange start_range(const CameraRays& camera) {
    const double slack =
        CameraExtent(camera).starts * gamma(8) + roundings(2) * std::fabs(camera.starts_at);
    return {static_cast<float>(camera.starts_at - slack),
            static_cast<float>(camera.starts_at + slack)};
}

/// The functions u, v, w (each >= 0 inside of an edge) and q of a triangle at the pixel coordinates
/// X, Y of CameraRays: value = c + a X + b Y, each off by at most e over the picture if it is
/// evaluated in float by at most kCameraRoundings operations. e is infinite where floats cannot
/// tell.
struct alignas(64) CameraTriangle {
    float a[4];
    float b[4];
    float c[4];
    float e[4];
};
static_assert(sizeof(CameraTriangle) == 64);
inline constexpr int kCameraRoundings = 12;

/// A sphere, the sphere around an ellipsoid, or an ellipsoid's ball, where that is mapped to, seen
/// from the camera.
struct alignas(64) CameraSphere {
    double from[3];          ///< f: from the centre to the anchor of CameraRays, local
    double exact_radius;     ///< r in double
    float radius;            ///< r
    float inverse_power;     ///< 1 / (f.f - r^2); its sign tells which root is hit. Of a
                             ///< parallel projection: 1 / d.d
    float power_error;       ///< relative, of inverse_power
    float cross_error;       ///< bounds the error of f x d and of f.d in double on each axis,
                             ///< over the picture
    std::uint32_t material;  ///< index into Scene::materials
    bool solid;
    bool unseen;  ///< the camera is surely inside, where a back that nobody sees is turned to it
    bool floats_cannot_tell;  ///< the camera is at the surface, or an ellipsoid too flat
};
static_assert(sizeof(CameraSphere) == 64);

/// What the float stages see of a quadric.
struct SeenQuadric {
    const CameraSphere* sphere;  ///< its own, of its ball, or the one around it
    const BallMap* map;          ///< to its ball; null: it is no ball
};

/// The pixels at whose centres a primitive may be seen, and how near it may be: most primitives of
/// a dense scene show at few pixels or none, and 16 bytes tell so without the 64 of a record.
struct alignas(16) PixelBox {
    std::uint32_t columns;  ///< the first | the one after the last << 16
    std::uint32_t rows;     ///< the same
    float nearest;          ///< bounds q of its hits from above
    std::uint32_t unused;
};
static_assert(sizeof(PixelBox) == 16);
inline constexpr PixelBox kNoPixels{};
/// Pictures whose sides are longer get boxes that rule nothing out.
inline constexpr int kMostBoxPixels = 65535;

/// Of the spheres and ellipsoids; made anew for each picture.
class CameraTables {
  public:
    /// Keeps references.
    CameraTables(const FastScene& scene, const CameraRays& camera, InstructionSet isa,
                 int threads = 1);

    SeenQuadric seen(Slot slot) const {
        if (slot >= scene_.sphere_end()) {
            const CameraSphere& ball = balls[slot - scene_.sphere_end()];
            if (!ball.floats_cannot_tell) return {&ball, &scene_.ball(slot)};
        }
        return {&spheres[slot - scene_.triangle_end()], nullptr};
    }

    std::size_t memory_bytes() const {
        return vector_bytes(spheres) + vector_bytes(balls) + vector_bytes(boxes);
    }

    BigVector<CameraSphere> spheres;  ///< by slot - triangle_end()
    BigVector<CameraSphere> balls;    ///< of ellipsoids, by slot - sphere_end()
    BigVector<PixelBox> boxes;        ///< by slot - triangle_end()

  private:
    void make_spheres(QuadricSpan quadrics);

    const FastScene& scene_;
    const CameraRays& camera_;
};

}  // namespace nuvo
