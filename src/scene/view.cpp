#include "view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nuvo::x3d {

namespace {

/// Makes a list of angles fit its colours: one fewer, never decreasing.
void match(const Fields& fields, std::string_view angle_field, std::vector<Color>& colors,
           std::vector<double>& angles) {
    const std::size_t bands = colors.empty() ? 0 : colors.size() - 1;
    if (angles.size() != bands) {
        fields.warn(angle_field, "not one fewer than the colors: what is over is left out");
        angles.resize(std::min(angles.size(), bands));
        colors.resize(colors.empty() ? 0 : angles.size() + 1);
    }
    for (std::size_t i = 1; i < angles.size(); ++i) {
        if (angles[i] >= angles[i - 1]) continue;
        fields.warn(angle_field, "decreasing: raised to the one before");
        angles[i] = angles[i - 1];
    }
}

/// The extents that an OrthoViewpoint shows: left, bottom, right, top.
OrthoWindow read_window(const Fields& fields, double scale) {
    const auto window = [scale](const Numbers& sides) {
        return OrthoWindow{{sides[0] * scale, sides[1] * scale},
                           {sides[2] * scale, sides[3] * scale}};
    };
    const OrthoWindow standard = window({-1, -1, 1, 1});
    const Numbers sides = fields.numbers("fieldOfView");
    if (sides.empty()) return standard;
    constexpr std::size_t kSides = 4;
    if (sides.size() == kSides) {
        const OrthoWindow given = window(sides);
        const double wide = given.high.x - given.low.x;
        const double high = given.high.y - given.low.y;
        if (wide > 0 && high > 0 && std::isfinite(wide) && std::isfinite(high)) return given;
    }
    fields.reject("fieldOfView", "is not left, bottom, right and top of some extent");
    return standard;
}

}  // namespace

Camera read_viewpoint(const Fields& fields, const Placement& placement, const Defaults& defaults) {
    Camera camera;
    const Affine3& to_world = placement.to_world;
    camera.position = to_world.point(fields.vector("position", camera.position));
    if (fields.element().name == "OrthoViewpoint") {
        camera.window = read_window(fields, placement.length_scale);
    } else {
        camera.field_of_view_rad = fields.number("fieldOfView", defaults.field_of_view_rad);
        if (!(camera.field_of_view_rad > 0 && camera.field_of_view_rad < std::numbers::pi)) {
            fields.reject("fieldOfView", "is not between 0 and pi");
            camera.field_of_view_rad = defaults.field_of_view_rad;
        }
    }
    const Matrix3 orientation = fields.rotation("orientation");
    const Vector3 forward = normalized(to_world.vector(orientation * Vector3{0, 0, -1}));
    const Vector3 right =
        normalized(cross(forward, normalized(to_world.vector(orientation * Vector3{0, 1, 0}))));
    if (!is_finite(camera.position) || !is_finite(forward) || !is_finite(right))
        fields.fail("position", "beyond the range of double in world space");
    if (right == Vector3{}) {
        fields.warn("orientation", "lost in a singular transform");
        return camera;
    }
    camera.forward = forward;
    camera.right = right;
    camera.up = cross(right, forward);
    return camera;
}

std::string viewpoint_name(const Element& node, std::size_t number) {
    for (const char* field : {"DEF", "description"})
        if (const std::string_view* name = node.find(field); name != nullptr && !name->empty())
            return std::string(*name);
    return std::to_string(number);
}

bool is_wanted(const Element& node, std::size_t number, const std::string& wanted) {
    if (wanted.empty() || wanted == std::to_string(number)) return true;
    for (const char* field : {"DEF", "description"})
        if (const std::string_view* name = node.find(field); name != nullptr && *name == wanted)
            return true;
    return false;
}

Background read_background(const Fields& fields, const Placement& placement) {
    Background background;
    if (fields.has("skyColor")) background.sky_color = fields.colors("skyColor");
    if (background.sky_color.empty()) background.sky_color = {{0, 0, 0}};
    const Numbers sky = fields.clamped_numbers("skyAngle", up_to_angle(std::numbers::pi));
    background.sky_angle.assign(sky.begin(), sky.end());
    background.ground_color = fields.colors("groundColor");
    const Numbers ground = fields.clamped_numbers("groundAngle", up_to_angle(std::numbers::pi / 2));
    background.ground_angle.assign(ground.begin(), ground.end());
    background.zenith = normalized(placement.turn * background.zenith);
    match(fields, "skyAngle", background.sky_color, background.sky_angle);
    match(fields, "groundAngle", background.ground_color, background.ground_angle);
    for (const char* picture :
         {"backUrl", "bottomUrl", "frontUrl", "leftUrl", "rightUrl", "topUrl"})
        if (const std::string_view* url = fields.element().find(picture);
            url != nullptr && !url->empty())
            fields.warn(picture, "not drawn");
    return background;
}

}  // namespace nuvo::x3d
