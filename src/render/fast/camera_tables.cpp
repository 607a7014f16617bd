#include "camera_tables.h"

#include <cmath>
#include <limits>

#include "camera_triangles.h"
#include "nuvo/math/error_bounds.h"
#include "pixel_boxes.h"

namespace nuvo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kFloatRoundoff = 0x1p-24;
constexpr std::size_t kAhead = 16;  // records are asked for before they are written

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 2 * kFloatRoundoff) + kTableUnderflow);
}

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
    out.exact_radius = r;
    out.radius = static_cast<float>(r);
    out.inverse_power = static_cast<float>(1 / power);
    out.power_error = rounded_up(2 * error / std::fabs(power) + 4 * kFloatRoundoff);
    out.nearest = gap > 0 && power > error
                      ? rounded_up(1 / (gap * (1 - gamma(32)) - gamma(16) * std::sqrt(ff)))
                      : kInfinity;
    if (!(out.nearest > 0)) out.nearest = kInfinity;
    out.distance = rounded_up(std::sqrt(ff));
    out.cross_error = rounded_up(gamma(32) * max_norm(from) * direction);
    out.exactly = !(std::fabs(power) > 4 * error && std::isfinite(out.inverse_power) &&
                    std::isnormal(out.radius) && std::isfinite(out.cross_error));
    return out;
}

}  // namespace

CameraTables::CameraTables(const FastScene& fast, const CameraRays& camera, InstructionSet isa) {
    const Scene& scene = fast.scene();
    const Point3 eye = scene.camera.position;
    const double scale = fast.frame().scale;
    triangles.resize(fast.triangle_end());
    BigVector<PixelBox> by_slot;
    by_slot.resize(fast.slot_end());
    make_camera_triangles(isa, fast, camera, triangles, by_slot);
    const double direction = CameraExtent(camera).direction;
    spheres.resize(fast.slot_end() - fast.triangle_end());
    const std::vector<FastScene::Round>& rounds = fast.rounds();
    for (std::size_t i = 0; i < rounds.size(); ++i) {
        const auto& [id, slot] = rounds[i];
        if (rounds.size() - i > kAhead)
            __builtin_prefetch(&spheres[rounds[i + kAhead].slot - fast.triangle_end()], 1);
        const Object& object = scene.objects[fast.primitives().sources[id].object];
        const Shape& shape = object.shape;
        CameraSphere& out = spheres[slot - fast.triangle_end()];
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            out = make_sphere(eye, scale, sphere->center, sphere->radius, direction);
        } else {
            const Bounds3 box = bounds(shape);
            const double radius = 0.5 * length(box.widths()) * (1 + gamma(64));
            out = make_sphere(eye, scale, box.center(), radius, direction);
            out.exactly = true;
        }
        out.material = object.material;
        out.solid = object.solid;
    }
    make_sphere_boxes(isa, camera, spheres.data(), spheres.size(),
                      by_slot.data() + fast.triangle_end());
    const std::vector<std::uint32_t>& items = fast.octree().items;
    boxes.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        boxes[i] = by_slot[items[i]];
        boxes[i].slot = items[i];
    }
}

}  // namespace nuvo
