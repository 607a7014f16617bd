#pragma once

#include <cstdint>
#include <optional>

#include "nuvo/math/ray.h"

namespace nuvo {

/// Picture width and height in pixels.
struct Resolution {
    int width = 1920;
    int height = 1080;

    friend bool operator==(const Resolution&, const Resolution&) = default;
};

inline std::uint64_t pixel_count(Resolution resolution) {
    return static_cast<std::uint64_t>(resolution.width) *
           static_cast<std::uint64_t>(resolution.height);
}

/// What an X3D OrthoViewpoint shows, in lengths of the world to the right of its position and above
/// it: low < high on both axes.
struct OrthoWindow {
    Vec2<double> low;
    Vec2<double> high;

    friend bool operator==(const OrthoWindow&, const OrthoWindow&) = default;
};

/// An X3D Viewpoint in world space. [thesis 4.2.2] The axes are orthonormal; the view looks along
/// `forward`, which for the default orientation is (0, 0, -1).
struct Camera {
    Point3 position{0, 0, 10};
    Vector3 right{1, 0, 0};
    Vector3 up{0, 1, 0};
    Vector3 forward{0, 0, -1};
    double field_of_view_rad = 0.78539816339744831;  ///< the smaller of the two angles, in (0, pi)

    /// Parallel projection: rays start in the plane through `position`. The picture shows the
    /// window, and more on one axis where their shapes differ.
    std::optional<OrthoWindow> window = {};

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Turns pixels into primary rays: eq. 25-35 with the constants of one picture taken out.
class RayGenerator {
  public:
    RayGenerator(const Camera& camera, Resolution resolution);

    /// The ray through the centre of pixel (x, y), y counted from the top row; unit direction.
    Ray ray(int x, int y) const { return ray_at(x + 0.5, y + 0.5); }
    /// The ray through any point of the picture, in pixels from its top left corner.
    Ray ray_at(double x, double y) const;
    /// From a pixel's direction to its right and lower neighbour's, both before they get unit
    /// length, where the view's own direction has length 1. Of a parallel projection: from the
    /// start of a pixel's ray to its neighbours'.
    Vector3 step_right() const { return camera_.right * (2 * half_width_ / width_); }
    Vector3 step_down() const { return camera_.up * (-2 * half_height_ / height_); }
    /// Where the ray through the picture's middle starts. Of a parallel projection.
    const Point3& middle() const { return middle_; }

  private:
    Camera camera_;
    double width_;
    double height_;
    double half_width_;  // of the image plane at distance 1, or in which rays start
    double half_height_;
    Point3 middle_;  // of a parallel projection's picture
};

}  // namespace nuvo
