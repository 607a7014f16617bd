// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/camera_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/camera/camera_triangle_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

std::uint32_t make_triangles(const CameraRays& camera, const TriangleBatch& batch,
                             CameraTriangle* out) {
    return TriangleMaker(camera).make(batch, out, TriangleBatch::kSize).unknown;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "camera_view.h"
#include "fast/camera/exact_planes.h"
#include "fast/primary/plane_order.h"
#include "fast/simd/dispatch.h"

// The functions of a pixel against the same in 60 digits: at pixels all over a large picture, of
// triangles for which each part of a bound counts.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261133;

/// A pixel's coordinates, as its tile's middle and the offset from it.
struct Pixel {
    float middle_x, middle_y, x, y;

    explicit Pixel(std::mt19937_64& random) {
        const auto at = [&](int size, float& middle, float& offset) {
            const int pixel = static_cast<int>(random() % static_cast<unsigned>(size));
            const int first = pixel / kTileSide * kTileSide;
            middle = static_cast<float>(first + 0.5 * kTileSide - 0.5 * size);
            offset = static_cast<float>(pixel - first + 0.5 - 0.5 * kTileSide);
        };
        at(kPicture.width, middle_x, x);
        at(kPicture.height, middle_y, y);
    }
    Real real_x() const { return Real(middle_x) + Real(x); }
    Real real_y() const { return Real(middle_y) + Real(y); }
    int column() const { return static_cast<int>(middle_x + x + 0.5F * (kPicture.width - 1)); }
    int row() const { return static_cast<int>(middle_y + y + 0.5F * (kPicture.height - 1)); }
    float value(float a, float b, float c) const {
        const float middle = std::fma(b, middle_y, std::fma(a, middle_x, c));
        return std::fma(x, a, std::fma(y, b, middle));
    }
};

/// A triangle before the camera, of which another part of the bounds counts by kind.
constexpr int kKinds = 6;
constexpr int kTelescope = 5;
Triangle triangle_before(std::mt19937_64& random, const View& view, int kind) {
    const double x = uniform(random, -900, 900);
    const double y = uniform(random, -500, 500);
    const CameraRays& camera = view.camera;
    const Vector3 way = normalized(camera.direction(x, y));
    const Point3 eye = start_of(camera, x, y);
    const Point3 middle = eye + way * std::exp2(uniform(random, -3, 6));
    const double size = std::exp2(uniform(random, -12, 2));
    Triangle t{middle + uniform_point(random, size), middle + uniform_point(random, size),
               middle + uniform_point(random, size)};
    const double small = std::exp2(uniform(random, -46, -20));
    if (kind == 1) {  // a needle that points at the eye
        const double part = uniform(random, 0.1, 2);
        t.b = t.a + (camera.parallel ? way : t.a - eye) * part + uniform_point(random, small);
    } else if (kind == 2) {  // its plane passes close to the eye
        const Vector3 across = normalized(cross(way, uniform_point(random, 1)));
        t.b = t.a + way * size + across * (size * small);
        t.a = eye + way * (length(middle - eye) - size);
        t.b = eye + way * length(middle - eye) + across * (size * small);
        t.c = middle + normalized(uniform_point(random, 1)) * size;
        t.c = t.a + (t.b - t.a) * 0.5 + across * size;
    } else if (kind == 3) {  // thin
        const double part = uniform(random, 0, 1);
        t.c = t.a + (t.b - t.a) * part + uniform_point(random, size * small);
    } else if (kind == kTelescope) {  // edges through all of the little that is seen
        t.a = middle;
    } else if (kind == 4) {  // tiny, all numbers exact
        t.b = t.a + uniform_point(random, small);
        t.c = t.a + uniform_point(random, small);
    }
    return t;
}

/// The true functions of a pixel: u, v, w with their positive factors, and q.
struct TruePlanes {
    const View& view;
    RealVector plane[4];
    RealVector point[4];            // of each plane, in the local frame
    Real before[4] = {0, 0, 0, 0};  // is added
    Real size[4] = {1, 1, 1, 1};    // of the functions before they were brought to 1

    TruePlanes(const View& view_in, const Triangle& t) : view(view_in) {
        const CameraRays& camera = view.camera;
        const Real scale = view.frame.scale;
        const RealVector anchor = RealVector(camera.anchor) * scale;
        const RealVector forward(camera.forward);
        const RealVector at[3] = {RealVector(t.a) * scale, RealVector(t.b) * scale,
                                  RealVector(t.c) * scale};
        const auto from_eye = [&](int i) { return camera.parallel ? forward : at[i] - anchor; };
        const RealVector normal = cross(at[0] - at[2], at[1] - at[0]);
        const Real constant = dot(normal, from_eye(0));
        const CameraExtent extent(camera);
        for (int i = 0; i < 3; ++i) {
            const int p = (i + 1) % 3;
            plane[i] = cross(from_eye(p), at[(i + 2) % 3] - at[p]);
            point[i] = at[p];
            size[i] = abs(coefficient(i, 0)) * Real(extent.x) +
                      abs(coefficient(i, 1)) * Real(extent.y) + abs(coefficient(i, 2));
            plane[i] = plane[i] * (Real(constant > 0 ? 1 : -1) / size[i]);
        }
        plane[3] = normal * (1 / constant);
        point[3] = at[0];
        if (camera.parallel) before[3] = camera.starts_at;
    }

    /// Of X, of Y, and the constant.
    Real coefficient(int i, int which) const {
        const CameraRays& camera = view.camera;
        if (which == 2 && camera.parallel)
            return dot(plane[i], RealVector(camera.anchor) * Real(view.frame.scale) - point[i]);
        return dot(plane[i], RealVector(which == 0   ? camera.right
                                        : which == 1 ? camera.down
                                                     : camera.forward));
    }
    Real value(int i, const Pixel& pixel) const {
        if (!view.camera.parallel)
            return dot(plane[i], view.direction(pixel.real_x(), pixel.real_y()));
        return dot(plane[i], view.start(pixel.column(), pixel.row()) - point[i]) + before[i];
    }
};

TEST(CameraBounds, HoldTheFunctionsOfTriangles) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto make = NUVO_FOR_ISA(isa, make_triangles);
        std::mt19937_64 random(kSeed);
        double widest[4] = {};
        int judged[kKinds] = {};
        for (int round = 0; round < 300; ++round) {
            const Camera camera =
                camera_of_round(random, round / kKinds, round % kKinds == kTelescope);
            const View view(camera, std::exp2(-static_cast<int>(random() % 8)));
            TriangleBatch batch{};
            for (std::size_t i = 0; i < TriangleBatch::kSize; ++i) {
                const Triangle t = triangle_before(random, view, round % kKinds);
                for (int axis = 0; axis < 3; ++axis) {
                    batch.corner[axis][i] = t.a[axis];
                    batch.corner[axis + 3][i] = t.b[axis];
                    batch.corner[axis + 6][i] = t.c[axis];
                }
            }
            CameraTriangle made[TriangleBatch::kSize];
            const std::uint32_t unknown = make(view.camera, batch, made);
            for (std::size_t i = 0; i < TriangleBatch::kSize; ++i) {
                if ((unknown >> i & 1) != 0) continue;
                ++judged[round % kKinds];
                const TruePlanes truth(view, batch.triangle(i));
                for (int p = 0; p < 40; ++p) {
                    const Pixel pixel(random);
                    for (int f = 0; f < 4; ++f) {
                        const Real value = pixel.value(made[i].a[f], made[i].b[f], made[i].c[f]);
                        const Real error = abs(value - truth.value(f, pixel));
                        ASSERT_LE(error, Real(made[i].e[f]))
                            << "seed " << kSeed << ", round " << round << ", function " << f;
                    }
                }
                if (round % kKinds == 0)
                    for (int f = 0; f < 3; ++f)
                        widest[f] = std::max(widest[f], static_cast<double>(made[i].e[f]));
            }
        }
        // Twelve roundings of a function of at most 1, and what far starts of rays are off.
        for (int f = 0; f < 3; ++f) EXPECT_LT(widest[f], 12.5 * 0x1p-24);
        for (int k = 0; k < kKinds; ++k) EXPECT_GT(judged[k], k == 2 ? 20 : 100) << "kind " << k;
    }
}

/// Six times that of the tetrahedron whose apex is the eye, exactly; 0 also where parallel rays lie
/// in the triangle's plane.
boost::multiprecision::cpp_rational volume(const Triangle& t, const CameraRays& camera) {
    using Rational = boost::multiprecision::cpp_rational;
    Rational row[3][3];
    for (int axis = 0; axis < 3; ++axis) {
        const Rational a(t.a[axis]);
        row[0][axis] =
            camera.parallel ? Rational(camera.forward[axis]) : a - Rational(camera.anchor[axis]);
        row[1][axis] = Rational(t.b[axis]) - a;
        row[2][axis] = Rational(t.c[axis]) - a;
    }
    Rational sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        sum += row[0][i] * (row[1][j] * row[2][k] - row[1][k] * row[2][j]);
    }
    return sum;
}

TEST(CameraBounds, HoldTheFunctionsOfTrianglesMadeExactly) {
    std::mt19937_64 random(kSeed + 1);
    int judged = 0;
    double widest[4] = {};
    for (int round = 0; round < 600; ++round) {
        const Camera camera = camera_of_round(random, round / kKinds, round % kKinds == kTelescope);
        const View view(camera, std::exp2(-static_cast<int>(random() % 8)));
        const Triangle t = triangle_before(random, view, round % kKinds);
        CameraTriangle made{};
        if (!make_exact_camera_triangle(view.camera, t, false, made)) {
            // Its plane goes through the eye.
            ASSERT_EQ(volume(t, view.camera), 0) << "round " << round;
            continue;
        }
        ++judged;
        const TruePlanes truth(view, t);
        for (int f = 0; f < 4; ++f) {
            if (!std::isfinite(made.e[f])) continue;
            const Real coefficients[3] = {truth.coefficient(f, 0), truth.coefficient(f, 1),
                                          truth.coefficient(f, 2)};
            const float found[3] = {made.a[f], made.b[f], made.c[f]};
            int largest = 0;
            for (int i = 1; i < 3; ++i)
                if (abs(coefficients[i]) > abs(coefficients[largest])) largest = i;
            // The edges' factor is any power of two.
            const Real quotient = Real(found[largest]) / coefficients[largest] / truth.size[f];
            const Real factor =
                f < 3 ? Real(exp2(boost::multiprecision::round(log2(quotient))) * truth.size[f])
                      : Real(1);
            ASSERT_GT(factor, 0) << "round " << round << ", function " << f;
            Real most = 0;
            for (int p = 0; p < 20; ++p) {
                const Pixel pixel(random);
                const Real value = pixel.value(made.a[f], made.b[f], made.c[f]);
                const Real exact = factor * truth.value(f, pixel);
                most = std::max(most, Real(abs(exact)));
                ASSERT_LE(abs(value - exact), Real(made.e[f]))
                    << "seed " << kSeed + 1 << ", round " << round << ", function " << f;
            }
            if (round % kKinds != kTelescope)
                widest[f] = std::max(widest[f], static_cast<double>(Real(made.e[f]) / most));
        }
    }
    for (const double w : widest) EXPECT_LT(w, 32 * 0x1p-24);
    EXPECT_GT(judged, 550);
}

TEST(CameraBounds, HoldTheOrderOfTwoPlanes) {
    std::mt19937_64 random(kSeed + 2);
    int sure = 0;
    for (int round = 0; round < 400; ++round) {
        View view(round % 4 < 2 ? random_camera(random) : random_parallel_camera(random), 1);
        TriangleMesh mesh;
        const Triangle t = triangle_before(random, view, 0);
        // The other: elsewhere, or nearly the same.
        const double apart = round % 2 != 0 ? std::exp2(uniform(random, -54, -20)) : 0;
        Triangle other = triangle_before(random, view, 0);
        if (apart != 0)
            other = {t.a + uniform_point(random, apart), t.b + uniform_point(random, apart),
                     t.c + uniform_point(random, apart)};
        mesh.positions = {t.a, t.b, t.c, other.a, other.b, other.c};
        mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
        Object object;
        object.shape = mesh;
        view.scene.objects = {object};
        const Primitives primitives = flatten(view.scene, LeafContent::kPrimitives);
        const FastScene fast(view.scene, primitives, OctreeType::kUniform, 1);
        const CameraRays camera(view.scene.camera, kPicture, fast.frame());
        PlaneOrders orders(fast, camera);
        const auto first = [&](Slot slot) { return fast.source(slot).triangle == 0 ? t : other; };
        const PixelFunction order = orders.between(0, 1);
        // q - q', by a positive factor.
        const View local(view.scene.camera, fast.frame());
        const TruePlanes planes[2] = {{local, first(0)}, {local, first(1)}};
        Real coefficients[3];
        for (int i = 0; i < 3; ++i)
            coefficients[i] = planes[0].coefficient(3, i) - planes[1].coefficient(3, i);
        const float found[3] = {order.a, order.b, order.c};
        int largest = 0;
        for (int i = 1; i < 3; ++i)
            if (abs(coefficients[i]) > abs(coefficients[largest])) largest = i;
        if (coefficients[largest] == 0) continue;
        const Real factor = Real(found[largest]) / coefficients[largest];
        ASSERT_GT(factor, 0) << "round " << round;
        for (int p = 0; p < 40; ++p) {
            const Pixel pixel(random);
            const Real value = pixel.value(order.a, order.b, order.c);
            const Real exact = factor * (planes[0].value(3, pixel) - planes[1].value(3, pixel));
            ASSERT_LE(abs(value - exact), Real(order.e)) << "round " << round;
            sure += abs(value) > Real(order.e);
        }
    }
    EXPECT_GT(sure, 15000);
}

}  // namespace
}  // namespace nuvo::testing
#endif
