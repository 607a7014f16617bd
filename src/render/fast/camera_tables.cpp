#include "camera_tables.h"

#include <cmath>
#include <limits>

#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kFloatRoundoff = 0x1p-24;
// What products of floats lose below the normal range, a few of them; and room for the scale.
constexpr double kFloatUnderflow = 0x1p-120;

// Half the picture in pixels, and the largest of the sums |forward| + |X right| + |Y down|.
struct Extent {
    double x;
    double y;
    double direction;
};

Extent extent_of(const CameraRays& camera) {
    const double x = 0.5 * camera.resolution.width;
    const double y = 0.5 * camera.resolution.height;
    return {
        x, y,
        3 * (max_norm(camera.forward) + x * max_norm(camera.right) + y * max_norm(camera.down))};
}

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 2 * kFloatRoundoff) + kFloatUnderflow);
}

class TriangleMaker {
  public:
    TriangleMaker(const CameraRays& camera, const Point3& eye, double scale)
        : camera_(camera), extent_(extent_of(camera)), eye_(eye), scale_(scale) {}

    // u, v, w are the triple products of d with the planes through the eye and an edge, turned so
    // that they are positive where the line enters at t > 0; t = K / (u + v + w).
    CameraTriangle make(const Triangle& t) const {
        const Vector3 a = (t.a - eye_) * scale_;
        const Vector3 b = (t.b - eye_) * scale_;
        const Vector3 c = (t.c - eye_) * scale_;
        const Vector3 bc = (t.c - t.b) * scale_;
        const Vector3 ca = (t.a - t.c) * scale_;
        const Vector3 ab = (t.b - t.a) * scale_;
        const Vector3 normal = cross(ca, ab);
        const double constant = dot(normal, a);
        const double edge = std::fmax(max_norm(ab), max_norm(ca)) + max_norm(bc);
        const double reach = std::fmax(max_norm(a), std::fmax(max_norm(b), max_norm(c)));
        // Each component of an edge plane has two products of three roundings and a difference;
        // the direction's own roundings and its unit length in the exact ray add 12 more.
        const double edge_error = gamma(32) * 2 * edge * reach * extent_.direction;
        const double normal_error = gamma(32) * 2 * edge * edge;
        const double constant_error = 3 * normal_error * reach;
        const double sign = constant > 0 ? 1 : -1;
        const double inverse = 1 / constant;
        CameraTriangle out;
        fill(out, 0, cross(b, bc) * sign, edge_error);
        fill(out, 1, cross(c, ca) * sign, edge_error);
        fill(out, 2, cross(a, ab) * sign, edge_error);
        const double share = constant_error * std::fabs(inverse);
        fill(out, 3, normal * inverse, normal_error * extent_.direction * std::fabs(inverse));
        const double depth =
            std::fabs(out.c[3]) + std::fabs(out.a[3]) * extent_.x + std::fabs(out.b[3]) * extent_.y;
        out.e[3] = rounded_up(out.e[3] + 2 * share * depth);
        if (share < 0.25 && finite(out)) return out;
        out = {};
        for (float& e : out.e) e = kInfinity;
        return out;
    }

  private:
    void fill(CameraTriangle& out, int i, const Vector3& plane, double error) const {
        const double a = dot(plane, camera_.right);
        const double b = dot(plane, camera_.down);
        const double c = dot(plane, camera_.forward);
        out.a[i] = static_cast<float>(a);
        out.b[i] = static_cast<float>(b);
        out.c[i] = static_cast<float>(c);
        const double size = std::fabs(a) * extent_.x + std::fabs(b) * extent_.y + std::fabs(c);
        out.e[i] = rounded_up(error + kCameraRoundings * kFloatRoundoff * size);
    }
    static bool finite(const CameraTriangle& t) {
        float sum = 0;
        for (int i = 0; i < 4; ++i) sum += t.e[i] * 0 + t.a[i] * 0 + t.b[i] * 0 + t.c[i] * 0;
        return sum == 0;
    }

    const CameraRays& camera_;
    Extent extent_;
    Point3 eye_;  // world
    double scale_;
};

CameraSphere make_sphere(const Point3& eye, double scale, const Point3& center, double radius,
                         double direction) {
    const Vector3 from = (eye - center) * scale;
    const double r = radius * scale;
    const double ff = dot(from, from);
    const double power = ff - r * r;
    // f carries one rounding, its square and r's three more.
    const double error = gamma(8) * (ff + r * r);
    const double gap = std::sqrt(ff) - r;
    CameraSphere out{};
    for (int axis = 0; axis < 3; ++axis) out.from[axis] = from[axis];
    out.radius = static_cast<float>(r);
    out.inverse_power = static_cast<float>(1 / power);
    out.power_error = rounded_up(2 * error / std::fabs(power) + 4 * kFloatRoundoff);
    out.nearest = gap > 0 && power > error
                      ? rounded_up(1 / (gap * (1 - gamma(32)) - gamma(16) * std::sqrt(ff)))
                      : kInfinity;
    if (!(out.nearest > 0)) out.nearest = kInfinity;
    out.cross_error = rounded_up(gamma(32) * max_norm(from) * direction);
    out.exactly = !(std::fabs(power) > 4 * error && std::isfinite(out.inverse_power) &&
                    std::isnormal(out.radius) && std::isfinite(out.cross_error));
    return out;
}

}  // namespace

CameraTables::CameraTables(const FastScene& fast, const CameraRays& camera) {
    const Scene& scene = fast.scene();
    const Point3 eye = scene.camera.position;
    const double scale = fast.frame().scale;
    const TriangleMaker maker(camera, eye, scale);
    triangles.resize(fast.triangle_end());
    for (Slot slot = 0; slot < fast.triangle_end(); ++slot) {
        const PrimitiveSource& source = fast.source(slot);
        const auto& mesh = std::get<TriangleMesh>(scene.objects[source.object].shape);
        triangles[slot] = maker.make(mesh.triangle(source.triangle));
    }
    const double direction = extent_of(camera).direction;
    spheres.reserve(fast.slot_end() - fast.triangle_end());
    for (Slot slot = fast.triangle_end(); slot < fast.slot_end(); ++slot) {
        const Shape& shape = scene.objects[fast.source(slot).object].shape;
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            spheres.push_back(make_sphere(eye, scale, sphere->center, sphere->radius, direction));
        } else {
            const Bounds3 box = bounds(shape);
            const double radius = 0.5 * length(box.widths()) * (1 + gamma(64));
            spheres.push_back(make_sphere(eye, scale, box.center(), radius, direction));
            spheres.back().exactly = true;
        }
    }
}

}  // namespace nuvo
