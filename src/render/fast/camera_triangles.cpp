#include "fast/camera_triangles.h"

#include <limits>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/camera_triangles.cpp"
#include <hwy/foreach_target.h>

#include "fast/lanes.h"
#include "fast/pixel_box_lanes.h"

// u, v, w are the triple products of the ray's direction with the planes through the eye and an
// edge, turned so that they are positive where the line enters at t > 0; with K = n.(a - eye),
// t = K / (u + v + w) and u + v + w = n.d. Eight triangles at a time, in double.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Numbers = Lanes<double, 8>;
inline constexpr int kGroup = 8;

struct Triple {
    Numbers x, y, z;

    friend HWY_INLINE Triple operator-(const Triple& a, const Triple& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend HWY_INLINE Triple operator*(const Triple& a, const Numbers& s) {
        return {a.x * s, a.y * s, a.z * s};
    }
    friend HWY_INLINE Numbers dot(const Triple& a, const Triple& b) {
        return a.x * b.x + a.y * b.y + a.z * b.z;
    }
    friend HWY_INLINE Triple cross(const Triple& a, const Triple& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend HWY_INLINE Numbers max_norm(const Triple& a) {
        return max(abs(a.x), max(abs(a.y), abs(a.z)));
    }
};

class TriangleGroup {
  public:
    TriangleGroup(const CameraRays& camera, const Point3& eye, double scale)
        : right_(broadcast(camera.right)),
          down_(broadcast(camera.down)),
          forward_(broadcast(camera.forward)),
          eye_(broadcast(eye)),
          scale_(scale),
          extent_(camera) {}

    /// Corners by coordinates: a.x, a.y, a.z, b.x ... c.z.
    HWY_INLINE void make(const double (&corners)[9][kGroup], CameraTriangle* out, int count) const {
        const Triple p = load(corners, 0);
        const Triple q = load(corners, 3);
        const Triple r = load(corners, 6);
        const Numbers scale(scale_);
        const Triple a = (p - eye_) * scale;
        const Triple b = (q - eye_) * scale;
        const Triple c = (r - eye_) * scale;
        const Triple bc = (r - q) * scale;
        const Triple ca = (p - r) * scale;
        const Triple ab = (q - p) * scale;
        const Triple normal = cross(ca, ab);
        const Numbers constant = dot(normal, a);
        const Numbers edge = max(max_norm(ab), max_norm(ca)) + max_norm(bc);
        const Numbers reach = max(max_norm(a), max(max_norm(b), max_norm(c)));
        // Each component of an edge plane has two products of three roundings and a difference; the
        // direction's own roundings and its unit length in the exact ray add 12 more.
        const Numbers direction(extent_.direction);
        const Numbers relative(2 * gamma(32));
        const Numbers normal_error = relative * edge * edge;
        const Numbers inverse = Numbers(1.0) / constant;
        const Numbers sign = select(constant > Numbers(0.0), Numbers(1.0), Numbers(-1.0));
        const Numbers edge_error = relative * edge * reach * direction;
        double value[4][4][kGroup];  // a, b, c, e of u, v, w, q
        fill(value, 0, cross(b, bc) * sign, edge_error);
        fill(value, 1, cross(c, ca) * sign, edge_error);
        fill(value, 2, cross(a, ab) * sign, edge_error);
        // The relative error of K.
        const Numbers share = Numbers(3.0) * normal_error * reach * abs(inverse);
        const Numbers size = fill(value, 3, normal * inverse,
                                  normal_error * direction * abs(inverse), Numbers(2.0) * share);
        // Infinite or NaN: floats cannot tell.
        const std::uint32_t good = ((share < Numbers(0.25)) & (size < Numbers(kLargest)) &
                                    (edge_error < Numbers(kLargest)))
                                       .bits();
        write(value, good, out, count);
    }

  private:
    static constexpr double kRoundoff = 0x1p-24;
    static constexpr double kLargest = 0x1p120;

    static HWY_INLINE Triple broadcast(const Vector3& v) {
        return {Numbers(v.x), Numbers(v.y), Numbers(v.z)};
    }
    static HWY_INLINE Triple load(const double (&corners)[9][kGroup], int i) {
        return {Numbers::load(corners[i]), Numbers::load(corners[i + 1]),
                Numbers::load(corners[i + 2])};
    }

    // One function with its bound: `error` is that of the double stage. Returns a bound of |value|.
    HWY_INLINE Numbers fill(double (&value)[4][4][kGroup], int i, const Triple& plane,
                            const Numbers& error, const Numbers& relative = Numbers(0.0)) const {
        const Numbers a = dot(plane, right_);
        const Numbers b = dot(plane, down_);
        const Numbers c = dot(plane, forward_);
        const Numbers size = abs(a) * Numbers(extent_.x) + abs(b) * Numbers(extent_.y) + abs(c);
        a.store(value[0][i]);
        b.store(value[1][i]);
        c.store(value[2][i]);
        const Numbers bound = error + size * (relative + Numbers(kCameraRoundings * kRoundoff));
        (bound * Numbers(1 + 2 * kRoundoff) + Numbers(kTableUnderflow)).store(value[3][i]);
        return size;
    }

    static void write(const double (&value)[4][4][kGroup], std::uint32_t good, CameraTriangle* out,
                      int count) {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        for (int lane = 0; lane < count; ++lane) {
            CameraTriangle& t = out[lane];
            const bool sure = (good >> lane & 1) != 0;
            for (int i = 0; i < 4; ++i) {
                t.a[i] = sure ? static_cast<float>(value[0][i][lane]) : 0;
                t.b[i] = sure ? static_cast<float>(value[1][i][lane]) : 0;
                t.c[i] = sure ? static_cast<float>(value[2][i][lane]) : 0;
                t.e[i] = sure ? static_cast<float>(value[3][i][lane]) : kInfinity;
            }
        }
    }

    Triple right_, down_, forward_, eye_;
    double scale_;
    CameraExtent extent_;
};

void make_triangles(const FastScene& fast, const CameraRays& camera, BigVector<CameraTriangle>& out,
                    BigVector<PixelBox>& boxes) {
    const Scene& scene = fast.scene();
    const TriangleGroup group(camera, scene.camera.position, fast.frame().scale);
    const PixelBoxMaker box_maker(camera);
    alignas(64) double corners[9][kGroup] = {};
    for (Slot first = 0; first < fast.triangle_end(); first += kGroup) {
        const int count = static_cast<int>(std::min<Slot>(kGroup, fast.triangle_end() - first));
        for (int lane = 0; lane < count; ++lane) {
            const PrimitiveSource& source = fast.source(first + static_cast<Slot>(lane));
            const auto& mesh = std::get<TriangleMesh>(scene.objects[source.object].shape);
            const IndexTriple& corner = mesh.triangles[source.triangle];
            for (std::size_t i = 0; i < 3; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    corners[3 * i + static_cast<std::size_t>(axis)][lane] =
                        mesh.positions[corner[i]][axis];
        }
        group.make(corners, out.data() + first, count);
        box_maker.triangles(corners, scene.camera.position, fast.frame().scale,
                            boxes.data() + first, static_cast<std::size_t>(count));
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

void make_camera_triangles(InstructionSet isa, const FastScene& scene, const CameraRays& camera,
                           BigVector<CameraTriangle>& out, BigVector<PixelBox>& boxes) {
    NUVO_FOR_ISA(isa, make_triangles)(scene, camera, out, boxes);
}

}  // namespace nuvo
#endif
