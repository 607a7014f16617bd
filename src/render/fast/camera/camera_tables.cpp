#include "fast/camera/camera_tables.h"

#include <cmath>
#include <limits>

#include "fast/camera/camera_triangles.h"
#include "fast/camera/pixel_boxes.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/parallel.h"

namespace nuvo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Of the float stages that use it.
float bound(double value) { return rounded_up(value + kFloatUnderflow); }

// `r` in the local frame.
CameraSphere make_sphere(const Point3& eye, double scale, const Point3& center, double r,
                         double direction) {
    const Vector3 from = (eye - center) * scale;
    const double ff = dot(from, from);
    const double power = ff - r * r;
    // f carries one rounding, its square and r's three more.
    const double error = gamma(8) * (ff + r * r);
    const double gap = std::sqrt(ff) - r;
    CameraSphere out{};
    for (int axis = 0; axis < 3; ++axis) out.from[axis] = from[axis];
    out.exact_radius = r;
    out.radius = static_cast<float>(r);
    out.inverse_power = static_cast<float>(1 / power);
    out.power_error = bound(2 * error / std::fabs(power) + 4 * kFloatRoundoff);
    out.nearest = gap > 0 && power > error
                      ? bound(1 / (gap * (1 - gamma(32)) - gamma(16) * std::sqrt(ff)))
                      : kInfinity;
    if (!(out.nearest > 0)) out.nearest = kInfinity;
    out.distance = bound(std::sqrt(ff));
    out.cross_error = bound(gamma(32) * max_norm(from) * direction);
    out.exactly = !(std::fabs(power) > 4 * error && std::isfinite(out.inverse_power) &&
                    std::isnormal(out.radius) && std::isfinite(out.cross_error));
    return out;
}

}  // namespace

CameraTables::CameraTables(const FastScene& scene, const CameraRays& camera, InstructionSet isa,
                           int threads)
    : scene_(scene), camera_(camera), isa_(isa), threads_(threads) {
    spheres.resize(scene.slot_end() - scene.triangle_end());
    boxes.resize(spheres.size());
}

void CameraTables::take_quadrics(QuadricSpan quadrics) {
    const Point3 eye = scene_.scene().camera.position;
    const double scale = scene_.frame().scale;
    const double direction = CameraExtent(camera_).direction;
    for (const QuadricSlot& quadric : quadrics) {
        if (const QuadricSlot* const prefetched = scene_.prefetched_after(quadric))
            __builtin_prefetch(&spheres[prefetched->slot - scene_.triangle_end()], 1);
        const Object& object = scene_.object(quadric.id);
        const Shape& shape = object.shape;
        CameraSphere& out = spheres[quadric.slot - scene_.triangle_end()];
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            out = make_sphere(eye, scale, sphere->center, sphere->radius * scale, direction);
        } else {
            const Bounds3 box = bounds(shape);
            // Halves do not overflow.
            const Vector3 half = (box.max * 0.5 - box.min * 0.5) * scale;
            const double r = length(half) * (1 + gamma(64)) + kFloatUnderflow;
            out = make_sphere(eye, scale, box.center(), r, direction);
            out.exactly = true;
        }
        out.material = object.material;
        out.solid = object.solid;
        out.hidden = scene_.front_only(object) && !out.exactly && out.inverse_power < 0;
    }
}

void CameraTables::finish() {
    for_each_part(threads_, spheres.size(), [&](std::size_t begin, std::size_t end) {
        make_sphere_boxes(isa_, camera_, spheres.data() + begin, end - begin, boxes.data() + begin);
        for (std::size_t i = begin; i < end; ++i)
            if (spheres[i].hidden) boxes[i] = kNoPixels;
    });
}

}  // namespace nuvo
