#include "nuvo/scene/camera.h"

#include <cmath>

namespace nuvo {

RayGenerator::RayGenerator(const Camera& camera, Resolution resolution)
    : camera_(camera), width_(resolution.width), height_(resolution.height) {
    if (camera.window) {
        const OrthoWindow& window = *camera.window;
        const double right = window.high.x * 0.5 - window.low.x * 0.5;
        const double up = window.high.y * 0.5 - window.low.y * 0.5;
        const double wider = std::fmax(right / width_, up / height_);
        half_width_ = wider * width_;
        half_height_ = wider * height_;
        middle_ = camera.position + camera.right * (window.low.x * 0.5 + window.high.x * 0.5) +
                  camera.up * (window.low.y * 0.5 + window.high.y * 0.5);
        return;
    }
    // X3D's fieldOfView is the smaller angle: the vertical one of a wide picture [eq. 31-33, 29].
    const double half_extent = std::tan(camera.field_of_view_rad / 2);
    const double smaller = width_ < height_ ? width_ : height_;
    half_width_ = half_extent * (width_ / smaller);
    half_height_ = half_extent * (height_ / smaller);
}

Ray RayGenerator::ray_at(double x, double y) const {
    const double screen_x = (2 * x / width_ - 1) * half_width_;    // [eq. 34]
    const double screen_y = (1 - 2 * y / height_) * half_height_;  // [eq. 35]
    if (camera_.window)
        return {middle_ + camera_.right * screen_x + camera_.up * screen_y, camera_.forward};
    const Vector3 direction = camera_.right * screen_x + camera_.up * screen_y + camera_.forward;
    return {camera_.position, normalized(direction)};
}

}  // namespace nuvo
