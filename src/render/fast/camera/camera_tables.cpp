#include "fast/camera/camera_tables.h"

#include <cmath>

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/camera/camera_tables.cpp"
#include <hwy/foreach_target.h>

#include "fast/camera/pixel_box_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void make_sphere_boxes(const CameraRays& camera, const CameraSphere* spheres, std::size_t count,
                       PixelBox* out) {
    const PixelBoxMaker maker(camera);
    for (std::size_t first = 0; first < count; first += PixelBoxMaker::kGroup)
        maker.spheres(spheres + first, out + first, std::min(PixelBoxMaker::kGroup, count - first));
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {
namespace {

// Of the float stages that use it.
float bound(double value) { return rounded_up(value + kFloatUnderflow); }

// A sphere of radius r seen from an eye at `from`, all in one frame. `error` bounds that of the
// power |from|^2 - r^2, `cross_error` those of from x d and from . d on each axis.
CameraSphere make_sphere(const Vector3& from, double r, double error, double cross_error) {
    const double ff = dot(from, from);
    const double power = ff - r * r;
    CameraSphere out{};
    for (int axis = 0; axis < 3; ++axis) out.from[axis] = from[axis];
    out.exact_radius = r;
    out.radius = static_cast<float>(r);
    out.inverse_power = static_cast<float>(1 / power);
    out.power_error = bound(2 * error / std::fabs(power) + roundings(4));
    out.cross_error = bound(cross_error);
    out.floats_cannot_tell = !(std::fabs(power) > 4 * error && std::isfinite(out.inverse_power) &&
                               std::isnormal(out.radius) && std::isfinite(out.cross_error));
    return out;
}

// The same along parallel rays in the direction d; `error` bounds that of |d|^2.
CameraSphere make_parallel_sphere(const Vector3& from, double r, const Vector3& d, double error,
                                  double cross_error) {
    CameraSphere out = make_sphere(from, r, 0, cross_error);
    const double square = dot(d, d);
    out.inverse_power = static_cast<float>(1 / square);
    out.power_error = bound(2 * error / square + roundings(4));
    out.floats_cannot_tell = !(square > 4 * error && std::isfinite(out.inverse_power) &&
                               std::isnormal(out.radius) && std::isfinite(out.cross_error));
    return out;
}

// Makes spheres as one camera sees them.
class SphereMaker {
  public:
    explicit SphereMaker(const CameraRays& camera) : camera_(camera), extent_(camera) {}

    // `r` in the local frame.
    CameraSphere local(const Vector3& from, double r) const {
        const double cross_error =
            gamma(32) * (max_norm(from) + extent_.starts) * extent_.direction;
        // Of a square, three roundings; f carries one, and r's three more.
        if (camera_.parallel)
            return make_parallel_sphere(from, r, camera_.forward, gamma(4), cross_error);
        return make_sphere(from, r, gamma(8) * (dot(from, from) + r * r), cross_error);
    }

    // The ball of an ellipsoid. [numerics: ellipsoids as balls]
    CameraSphere ball(const BallMap& map, const Vector3& from) const {
        const Vector3 f = map.to_ball * from;
        const double map_error = map.error + gamma(8) * map.stretch;
        const double f_size = max_norm(f) + map.stretch * extent_.starts;
        const double f_error = (max_norm(from) + extent_.starts) * map_error;
        const double d_size = map.stretch * extent_.direction;
        const double d_error = extent_.direction * map_error;
        const double cross_error =
            gamma(32) * f_size * d_size + 4 * (f_size * d_error + f_error * (d_size + d_error));
        CameraSphere out = camera_.parallel
                               ? make_parallel_sphere(f, map.radius, map.to_ball * camera_.forward,
                                                      3 * d_error * (2 * d_size + d_error) +
                                                          gamma(8) * d_size * d_size,
                                                      cross_error)
                               : make_sphere(f, map.radius,
                                             gamma(8) * (dot(f, f) + map.radius * map.radius) +
                                                 3 * f_error * (2 * f_size + f_error),
                                             cross_error);
        out.floats_cannot_tell |= !map.sure;
        return out;
    }

    // Whether it may stand where the rays of a parallel projection start.
    bool may_hold_starts(const Vector3& from, double r) const {
        if (!camera_.parallel) return false;
        const double q = dot(from, camera_.forward);
        return q + r + gamma(8) * (3 * max_norm(from) + r + extent_.starts) >= camera_.starts_at;
    }

  private:
    const CameraRays& camera_;
    CameraExtent extent_;
};

}  // namespace

CameraTables::CameraTables(const FastScene& scene, const CameraRays& camera, InstructionSet isa,
                           int threads)
    : scene_(scene), camera_(camera) {
    spheres.resize(scene.slot_end() - scene.triangle_end());
    balls.resize(scene.slot_end() - scene.sphere_end());
    boxes.resize(spheres.size());
    for_each_part(threads, spheres.size(), [&](std::size_t begin, std::size_t end) {
        make_spheres(scene.quadrics().subspan(begin, end - begin));
    });
    const auto make_boxes = NUVO_FOR_ISA(isa, make_sphere_boxes);
    for_each_part(threads, spheres.size(), [&](std::size_t begin, std::size_t end) {
        make_boxes(camera, spheres.data() + begin, end - begin, boxes.data() + begin);
        for (std::size_t i = begin; i < end; ++i)
            if (spheres[i].unseen) boxes[i] = kNoPixels;
    });
}

void CameraTables::make_spheres(QuadricSpan quadrics) {
    const Point3& anchor = camera_.anchor;
    const double scale = camera_.scale;
    const SphereMaker maker(camera_);
    for (const QuadricSlot& quadric : quadrics) {
        if (const QuadricSlot* const prefetched = scene_.prefetched_after(quadric))
            __builtin_prefetch(&spheres[prefetched->slot - scene_.triangle_end()], 1);
        const Object& object = scene_.object(quadric.id);
        const Shape& shape = object.shape;
        const bool front_only = scene_.front_only(object);
        CameraSphere& out = spheres[quadric.slot - scene_.triangle_end()];
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            const Vector3 from = (anchor - sphere->center) * scale;
            const double r = sphere->radius * scale;
            out = maker.local(from, r);
            out.floats_cannot_tell |= maker.may_hold_starts(from, r);
            out.unseen = front_only && !out.floats_cannot_tell && out.inverse_power < 0;
        } else {
            const Bounds3 box = bounds(shape);
            // Halves do not overflow.
            const Vector3 half = (box.max * 0.5 - box.min * 0.5) * scale;
            const double r = length(half) * (1 + gamma(64)) + kFloatUnderflow;
            const Vector3 from = (anchor - box.center()) * scale;
            out = maker.local(from, r);
            out.floats_cannot_tell = true;
            CameraSphere& ball = balls[quadric.slot - scene_.sphere_end()];
            const Point3& center = std::get<Ellipsoid>(shape).center;
            ball = maker.ball(scene_.ball(quadric.slot), (anchor - center) * scale);
            ball.floats_cannot_tell |= maker.may_hold_starts(from, r);
            ball.material = object.material;
            ball.solid = object.solid;
            out.unseen = front_only && !ball.floats_cannot_tell && ball.inverse_power < 0;
        }
        out.material = object.material;
        out.solid = object.solid;
    }
}

}  // namespace nuvo
#endif
