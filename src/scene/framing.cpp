#include "nuvo/scene/framing.h"
#include "nuvo/math/error_bounds.h"

#include <algorithm>
#include <cmath>

// All is asked of supports: how far a shape reaches along a direction. A shape lies within a
// picture iff it lies on the inner side of the four planes through the eye and the picture's sides.

namespace nuvo {
namespace {

/// The largest n.p over the points p of the shape.
double reach(const Shape& shape, const Vector3& n) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
        double most = -kInfinity;
        for (const IndexTriple& corners : mesh->triangles)
            for (const std::uint32_t corner : corners)
                most = std::max(most, dot(n, mesh->positions[corner]));
        return most;
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return dot(n, sphere->center) + length(n) * sphere->radius;
    const auto& ellipsoid = std::get<Ellipsoid>(shape);
    return dot(n, ellipsoid.center) + length(ellipsoid.linear.transposed() * n) * ellipsoid.radius;
}
double reach(const Bounds3& box, const Vector3& n) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis)
        most += std::max(n[axis] * box.min[axis], n[axis] * box.max[axis]);
    return most;
}
double reach(const Scene& scene, const Vector3& n) {
    double most = -kInfinity;
    for (const Object& object : scene.objects) most = std::max(most, reach(object.shape, n));
    return most;
}

/// The picture's half width and half height at distance 1.
struct Slopes {
    Slopes(double field_of_view_rad, Resolution resolution) {
        const double half = std::tan(field_of_view_rad / 2);
        const double shorter = std::min(resolution.width, resolution.height);
        x = half * resolution.width / shorter;
        y = half * resolution.height / shorter;
    }
    double x, y;
};

/// Seen from the camera, in its own axes: how far a box reaches to both sides, in slopes, at most;
/// infinite where it is not surely in front.
struct Extent {
    double low[2];
    double high[2];
};
Extent extent(const Bounds3& box, const Camera& camera) {
    const double eye = dot(camera.forward, camera.position);
    const double depth = -reach(box, -camera.forward) - eye;
    const double far = reach(box, camera.forward) - eye;
    Extent seen{{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
    if (!(depth > 0)) return seen;
    const Vector3* const axes[2] = {&camera.right, &camera.up};
    for (int i = 0; i < 2; ++i) {
        const double at = dot(*axes[i], camera.position);
        const double high = reach(box, *axes[i]) - at;
        const double low = -reach(box, -*axes[i]) - at;
        // Nearer parts look larger.
        seen.high[i] = high / (high > 0 ? depth : far);
        seen.low[i] = low / (low < 0 ? depth : far);
    }
    return seen;
}

/// The inward normals of the planes through the eye and the picture's sides.
struct Sides {
    Sides(const Camera& camera, const Slopes& slopes)
        : inward{camera.forward * slopes.x - camera.right, camera.forward * slopes.x + camera.right,
                 camera.forward * slopes.y - camera.up, camera.forward * slopes.y + camera.up},
          eye(camera.position) {}

    template <typename Body>
    bool contain(const Body& shape) const {
        return std::all_of(std::begin(inward), std::end(inward),
                           [&](const Vector3& n) { return -reach(shape, -n) >= dot(n, eye); });
    }
    template <typename Body>
    bool exclude(const Body& shape) const {
        return std::any_of(std::begin(inward), std::end(inward),
                           [&](const Vector3& n) { return reach(shape, n) < dot(n, eye); });
    }

    Vector3 inward[4];
    Point3 eye;
};

Camera looking_along(const Vector3& forward) {
    Camera camera;
    camera.forward = forward;
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

}  // namespace

Framing framing(const Scene& scene, const Camera& camera, Resolution resolution) {
    if (scene.objects.empty()) return Framing::kGood;
    const Slopes slopes(camera.field_of_view_rad, resolution);
    const Sides sides(camera, slopes);
    bool any = false;
    bool whole = true;
    Extent all{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
    for (const Object& object : scene.objects) {
        const Bounds3 box = bounds(object.shape);  // what it tells is told faster
        if (box.empty()) continue;
        any = any || !(sides.exclude(box) || sides.exclude(object.shape));
        whole = whole && (sides.contain(box) || sides.contain(object.shape));
        const Extent seen = extent(box, camera);
        for (int i = 0; i < 2; ++i) {
            all.low[i] = std::min(all.low[i], seen.low[i]);
            all.high[i] = std::max(all.high[i], seen.high[i]);
        }
    }
    if (!any) return Framing::kNothing;
    if (!whole) return Framing::kCut;
    constexpr double kTinyShare = 0.1;
    const double shorter = 2 * std::min(slopes.x, slopes.y);
    const double size = std::max(all.high[0] - all.low[0], all.high[1] - all.low[1]);
    return size < kTinyShare * shorter ? Framing::kTiny : Framing::kGood;
}

std::optional<Camera> fitted_camera(const Scene& scene) {
    if (scene.objects.empty()) return std::nullopt;
    constexpr double kFlat = 0.25;
    constexpr double kFilled = 0.9;
    const double height = reach(scene, {0, 1, 0}) + reach(scene, {0, -1, 0});
    const double depth = reach(scene, {0, 0, 1}) + reach(scene, {0, 0, -1});
    const Vector3 downwards{0, -0.5, -0.5 * std::sqrt(3.0)};
    Camera camera = looking_along(height < kFlat * depth ? downwards : Vector3{0, 0, -1});
    const auto middle = [&](const Vector3& axis) {
        return axis * (0.5 * (reach(scene, axis) - reach(scene, -axis)));
    };
    // On the line through the middle of what is seen the planes of the sides tell how far back.
    const Point3 on_axis = middle(camera.right) + middle(camera.up);
    const double slope = kFilled * std::tan(camera.field_of_view_rad / 2);
    double back = -kInfinity;
    for (const Vector3& axis : {camera.right, -camera.right, camera.up, -camera.up}) {
        const Vector3 outward = axis - camera.forward * slope;
        back = std::max(back, (reach(scene, outward) - dot(outward, on_axis)) / slope);
    }
    camera.position = on_axis - camera.forward * back;
    const Vector3& p = camera.position;
    const bool seen = back > reach(scene, -camera.forward);
    if (!seen || !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return std::nullopt;
    return camera;
}

std::optional<Camera> aimed_camera(const Camera& camera, const Point3& from, const Point3& at) {
    const Vector3 way = at * 0.5 - from * 0.5;  // halves: their difference is finite
    if (way == Vector3{}) return std::nullopt;
    Camera aimed = camera;
    aimed.position = from;
    aimed.forward = normalized(way);
    Vector3 right = cross(aimed.forward, Vector3{0, 1, 0});
    if (right == Vector3{}) right = {1, 0, 0};
    aimed.right = normalized(right);
    aimed.up = cross(aimed.right, aimed.forward);
    return aimed;
}

}  // namespace nuvo
