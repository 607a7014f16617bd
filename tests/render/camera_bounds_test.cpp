// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/camera_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/camera/camera_triangle_lanes.h"
#include "fast/primary/primary_lanes.h"
#include "fast/primary/sphere_lanes.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_CAMERA_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_CAMERA_BOUNDS_TEST_CPP_
/// What a sphere's functions say at some pixels of a tile.
struct ConicAnswers {
    static constexpr int kLanes = 16;
    float discriminant[kLanes], toward[kLanes], low[kLanes], high[kLanes];
    float error, toward_error;
    std::uint32_t met;  // blocks
};
#endif
}  // namespace nuvo

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

std::uint32_t make_triangles(const CameraRays& camera, const Point3& eye, double scale,
                             const TriangleBatch& batch, CameraTriangle* out) {
    return TriangleMaker(camera, eye, scale).make(batch, out, TriangleBatch::kSize).unknown;
}

// At the first block's pixels of a tile.
void ask_conic(const CameraRays& camera, int tile_x, int tile_y, const CameraSphere& sphere,
               ConicAnswers& out) {
    const TileRays rays(camera, tile_x, tile_y);
    SphereConics conics;
    const CameraSphere* const one[] = {&sphere};
    conics.fill(one, 1, rays);
    const Floats x = Floats::load(kOffsets.x[0]);
    const Floats y = Floats::load(kOffsets.y[0]);
    const Floats discriminant = conics.discriminant(0, x, y);
    const SphereHits hits(sphere, conics, 0, discriminant, x, y);
    discriminant.store(out.discriminant);
    conics.toward(0, x, y).store(out.toward);
    hits.low.store(out.low);
    hits.high.store(out.high);
    out.error = conics.error(0);
    out.toward_error = conics.toward_error(0);
    out.met = conics.met(0, 0xffff);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <bit>
#include <cmath>

#include "fast/camera/exact_planes.h"
#include "fast/primary/plane_order.h"
#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "real_numbers.h"

// The functions of a pixel against the same in 60 digits: at pixels all over a large picture, of
// triangles and spheres for which each part of a bound counts.
namespace nuvo::testing {
namespace {

constexpr Resolution kPicture{1920, 1080};
constexpr unsigned kSeed = 20261133;

struct View {
    Scene scene;
    LocalFrame frame;
    CameraRays camera;

    static Scene scene_of(const Camera& camera) {
        Scene scene;
        scene.camera = camera;
        return scene;
    }
    View(const Camera& camera_in, double scale)
        : scene(scene_of(camera_in)),
          frame{{}, scale, 0.25},
          camera(scene.camera, kPicture, frame) {}

    RealVector direction(Real x, Real y) const {
        return RealVector(camera.forward) + RealVector(camera.right) * x +
               RealVector(camera.down) * y;
    }
};

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
    float value(float a, float b, float c) const {
        const float middle = std::fma(b, middle_y, std::fma(a, middle_x, c));
        return std::fma(x, a, std::fma(y, b, middle));
    }
};

/// A triangle before the camera, of which another part of the bounds counts by kind.
constexpr int kKinds = 6;
constexpr int kTelescope = 5;
Triangle triangle_before(std::mt19937_64& random, const Point3& eye, const View& view, int kind) {
    const Vector3 way =
        normalized(view.camera.direction(uniform(random, -900, 900), uniform(random, -500, 500)));
    const Point3 middle = eye + way * std::exp2(uniform(random, -3, 6));
    const double size = std::exp2(uniform(random, -12, 2));
    Triangle t{middle + uniform_point(random, size), middle + uniform_point(random, size),
               middle + uniform_point(random, size)};
    const double small = std::exp2(uniform(random, -46, -20));
    if (kind == 1) {  // a needle that points at the eye
        t.b = t.a + (t.a - eye) * uniform(random, 0.1, 2) + uniform_point(random, small);
    } else if (kind == 2) {  // its plane passes close to the eye
        const Vector3 across = normalized(cross(way, uniform_point(random, 1)));
        t.b = t.a + way * size + across * (size * small);
        t.a = eye + way * (length(middle - eye) - size);
        t.b = eye + way * length(middle - eye) + across * (size * small);
        t.c = middle + normalized(uniform_point(random, 1)) * size;
        t.c = t.a + (t.b - t.a) * 0.5 + across * size;
    } else if (kind == 3) {  // thin
        t.c = t.a + (t.b - t.a) * uniform(random, 0, 1) + uniform_point(random, size * small);
    } else if (kind == kTelescope) {  // edges through all of the little that is seen
        t.a = middle;
    } else if (kind == 4) {  // tiny, all numbers exact
        t.b = t.a + uniform_point(random, small);
        t.c = t.a + uniform_point(random, small);
    }
    return t;
}

/// The true functions of a pixel: u, v, w with their positive factors, and q = 1 / t.
struct TruePlanes {
    RealVector plane[4];
    Real size[4] = {1, 1, 1, 1};  // of the functions before they were brought to 1

    TruePlanes(const View& view, const Triangle& t) {
        const RealVector eye(view.scene.camera.position);
        const Real scale = view.frame.scale;
        const RealVector a = (RealVector(t.a) - eye) * scale;
        const RealVector b = (RealVector(t.b) - eye) * scale;
        const RealVector c = (RealVector(t.c) - eye) * scale;
        const RealVector normal = cross(a - c, b - a);
        const Real constant = dot(normal, a);
        const RealVector edges[3] = {cross(b, c - b), cross(c, a - c), cross(a, b - a)};
        const CameraExtent extent(view.camera);
        for (int i = 0; i < 3; ++i) {
            const auto along = [&](const Vector3& v) { return dot(edges[i], RealVector(v)); };
            size[i] = abs(along(view.camera.right)) * Real(extent.x) +
                      abs(along(view.camera.down)) * Real(extent.y) +
                      abs(along(view.camera.forward));
            plane[i] = edges[i] * (Real(constant > 0 ? 1 : -1) / size[i]);
        }
        plane[3] = normal * (1 / constant);
    }
};

Camera random_camera(std::mt19937_64& random, int kind = 0) {
    Camera camera = camera_along(uniform_point(random, 1), uniform_point(random, 1));
    if (random() % 3 == 0) camera.field_of_view_rad = uniform(random, 1, 2.9);
    if (kind == kTelescope) camera.field_of_view_rad = std::exp2(uniform(random, -36, -24));
    return camera;
}

TEST(CameraBounds, HoldTheFunctionsOfTriangles) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto make = NUVO_FOR_ISA(isa, make_triangles);
        std::mt19937_64 random(kSeed);
        double widest[4] = {};
        int judged[kKinds] = {};
        for (int round = 0; round < 300; ++round) {
            const View view(random_camera(random, round % kKinds),
                            std::exp2(-static_cast<int>(random() % 8)));
            const Point3& eye = view.scene.camera.position;
            TriangleBatch batch{};
            for (std::size_t i = 0; i < TriangleBatch::kSize; ++i) {
                const Triangle t = triangle_before(random, eye, view, round % kKinds);
                for (int axis = 0; axis < 3; ++axis) {
                    batch.corner[axis][i] = t.a[axis];
                    batch.corner[axis + 3][i] = t.b[axis];
                    batch.corner[axis + 6][i] = t.c[axis];
                }
            }
            CameraTriangle made[TriangleBatch::kSize];
            const std::uint32_t unknown = make(view.camera, eye, view.frame.scale, batch, made);
            for (std::size_t i = 0; i < TriangleBatch::kSize; ++i) {
                if ((unknown >> i & 1) != 0) continue;
                ++judged[round % kKinds];
                const TruePlanes truth(view, batch.triangle(i));
                for (int p = 0; p < 40; ++p) {
                    const Pixel pixel(random);
                    const RealVector d = view.direction(pixel.real_x(), pixel.real_y());
                    for (int f = 0; f < 4; ++f) {
                        const Real value = pixel.value(made[i].a[f], made[i].b[f], made[i].c[f]);
                        const Real error = abs(value - dot(truth.plane[f], d));
                        ASSERT_LE(error, Real(made[i].e[f]))
                            << "seed " << kSeed << ", round " << round << ", function " << f;
                    }
                }
                if (round % kKinds == 0)
                    for (int f = 0; f < 3; ++f)
                        widest[f] = std::max(widest[f], static_cast<double>(made[i].e[f]));
            }
        }
        // Twelve roundings of a function of at most 1.
        for (int f = 0; f < 3; ++f) EXPECT_LT(widest[f], 12.01 * 0x1p-24);
        for (int k = 0; k < kKinds; ++k) EXPECT_GT(judged[k], k == 2 ? 20 : 100) << "kind " << k;
    }
}

TEST(CameraBounds, HoldTheFunctionsOfTrianglesMadeExactly) {
    std::mt19937_64 random(kSeed + 1);
    double widest[4] = {};
    for (int round = 0; round < 600; ++round) {
        const View view(random_camera(random, round % kKinds),
                        std::exp2(-static_cast<int>(random() % 8)));
        const Point3& eye = view.scene.camera.position;
        const Triangle t = triangle_before(random, eye, view, round % kKinds);
        CameraTriangle made{};
        PixelBox box{1, 1, 0, 0};
        make_exact_camera_triangle({view.camera, eye, view.frame.scale}, t, false, made, box);
        ASSERT_NE(box.columns, 0U);
        const TruePlanes truth(view, t);
        for (int f = 0; f < 4; ++f) {
            const auto along = [&](const Vector3& v) { return dot(truth.plane[f], RealVector(v)); };
            const Real coefficients[3] = {along(view.camera.right), along(view.camera.down),
                                          along(view.camera.forward)};
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
                const RealVector d = view.direction(pixel.real_x(), pixel.real_y());
                const Real value = pixel.value(made.a[f], made.b[f], made.c[f]);
                const Real exact = factor * dot(truth.plane[f], d);
                most = std::max(most, Real(abs(exact)));
                ASSERT_LE(abs(value - exact), Real(made.e[f]))
                    << "seed " << kSeed + 1 << ", round " << round << ", function " << f;
            }
            if (round % kKinds != kTelescope)
                widest[f] = std::max(widest[f], static_cast<double>(Real(made.e[f]) / most));
        }
    }
    for (const double w : widest) EXPECT_LT(w, 32 * 0x1p-24);
}

TEST(CameraBounds, HoldTheOrderOfTwoPlanes) {
    std::mt19937_64 random(kSeed + 2);
    int sure = 0;
    for (int round = 0; round < 400; ++round) {
        View view(random_camera(random), 1);
        const Point3& eye = view.scene.camera.position;
        TriangleMesh mesh;
        const Triangle t = triangle_before(random, eye, view, 0);
        // The other: elsewhere, or nearly the same.
        const double apart = round % 2 != 0 ? std::exp2(uniform(random, -54, -20)) : 0;
        Triangle other = triangle_before(random, eye, view, 0);
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
        const PlaneOrder order = orders.between(0, 1);
        // 1 / t - 1 / t', by a positive factor.
        const View local(view.scene.camera, fast.frame().scale);
        const RealVector difference =
            TruePlanes(local, first(0)).plane[3] - TruePlanes(local, first(1)).plane[3];
        const auto along = [&](const Vector3& v) { return dot(difference, RealVector(v)); };
        const Real coefficients[3] = {along(camera.right), along(camera.down),
                                      along(camera.forward)};
        const float found[3] = {order.a, order.b, order.c};
        int largest = 0;
        for (int i = 1; i < 3; ++i)
            if (abs(coefficients[i]) > abs(coefficients[largest])) largest = i;
        if (coefficients[largest] == 0) continue;
        const Real factor = Real(found[largest]) / coefficients[largest];
        ASSERT_GT(factor, 0) << "round " << round;
        for (int p = 0; p < 40; ++p) {
            const Pixel pixel(random);
            const RealVector d = local.direction(pixel.real_x(), pixel.real_y());
            const Real value = pixel.value(order.a, order.b, order.c);
            const Real exact = factor * dot(difference, d);
            ASSERT_LE(abs(value - exact), Real(order.e)) << "round " << round;
            sure += abs(value) > Real(order.e);
        }
    }
    EXPECT_GT(sure, 15000);
}

struct MetBlocks {
    int truly = 0;
    int found = 0;
};

// Whoever has a pixel whose ray meets the sphere.
void judge_blocks(const View& view, const CameraRays& camera, int tile_x, int tile_y,
                  const RealVector& f, const Real& r, std::uint32_t met, MetBlocks& blocks) {
    using Long = Vec3<long double>;
    const auto rounded = [](const RealVector& v) {
        return Long(static_cast<long double>(v.x), static_cast<long double>(v.y),
                    static_cast<long double>(v.z));
    };
    const Long from = rounded(f);
    const auto radius = static_cast<long double>(r);
    std::uint32_t truly = 0;
    for (int lane = 0; lane < kTileLanes; ++lane) {
        const Long d = rounded(view.direction(camera.center_x(tile_x + lane_x(lane)),
                                              camera.center_y(tile_y + lane_y(lane))));
        const Long across = cross(from, d);
        if (dot(d, d) * radius * radius >= dot(across, across)) truly |= 1U << lane / kBlockLanes;
    }
    ASSERT_EQ(truly & ~met, 0U);
    blocks.truly += std::popcount(truly);
    blocks.found += std::popcount(met);
}

TEST(CameraBounds, HoldTheFunctionsOfSpheres) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_conic);
        std::mt19937_64 random(kSeed + 3);
        int judged = 0;
        int hit = 0;
        MetBlocks blocks;
        double widest = 0;  // of 1 / t, relative, where the sphere is large in the picture
        for (int round = 0; round < 800; ++round) {
            View view(random_camera(random), 1);
            const Point3& eye = view.scene.camera.position;
            const int tile_x = static_cast<int>(random() % 120) * kTileSide;
            const int tile_y = static_cast<int>(random() % 67) * kTileSide;
            // Behind the tile, beside it, tangent to a ray of it, or around the eye.
            const int kind = round % 4;
            const Vector3 way = normalized(
                view.camera.direction(view.camera.center_x(tile_x) + uniform(random, 0, 4),
                                      view.camera.center_y(tile_y) + uniform(random, 0, 4)));
            const double far = std::exp2(uniform(random, -2, 6));
            double radius = std::exp2(uniform(random, -14, 1)) * far;
            Point3 center = eye + way * far;
            if (kind == 1) radius = std::exp2(uniform(random, -36, -14)) * far;  // tiny
            if (kind == 2)
                center = center + normalized(cross(way, uniform_point(random, 1))) * radius;
            if (kind == 3) center = eye + uniform_point(random, 0.5) * radius;
            Object object;
            object.shape = Sphere{center, radius};
            view.scene.objects = {object};
            const Primitives primitives = flatten(view.scene, LeafContent::kPrimitives);
            const FastScene fast(view.scene, primitives, OctreeType::kUniform, 1);
            const CameraRays camera(view.scene.camera, kPicture, fast.frame());
            CameraTables tables(fast, camera, isa);
            fill_tables(fast, 1, tables);
            const CameraSphere& sphere = tables.spheres[0];
            if (sphere.exactly) continue;
            ConicAnswers found;
            ask(camera, tile_x, tile_y, sphere, found);
            ++judged;
            const Real scale = fast.frame().scale;
            const RealVector f = (RealVector(eye) - RealVector(center)) * scale;
            const Real r = Real(radius) * scale;
            const Real gap = sqrt(dot(f, f)) - r;
            if (gap > 0) {
                ASSERT_GE(Real(sphere.nearest) * gap, 1) << "round " << round;
                if (kind == 0) {
                    EXPECT_LT(Real(sphere.nearest) * gap, 1 + 0x1p-20);
                }
            }
            judge_blocks(view, camera, tile_x, tile_y, f, r, found.met, blocks);
            for (int lane = 0; lane < ConicAnswers::kLanes; ++lane) {
                const Real x = Real(camera.center_x(tile_x + lane_x(lane)));
                const Real y = Real(camera.center_y(tile_y + lane_y(lane)));
                const RealVector d = view.direction(x, y);
                const RealVector across = cross(f, d);
                const Real discriminant = dot(d, d) * r * r - dot(across, across);
                const Real toward = dot(f, d);
                const Real off = abs(Real(found.discriminant[lane]) - discriminant);
                ASSERT_LE(off, Real(found.error)) << "round " << round << ", lane " << lane;
                ASSERT_LE(abs(Real(found.toward[lane]) - toward), Real(found.toward_error))
                    << "round " << round << ", lane " << lane;
                if (discriminant < 0) continue;
                const Real power = dot(f, f) - r * r;
                const Real root = sqrt(discriminant) * (power < 0 ? -1 : 1);
                const Real q = (root - toward) / power;
                ASSERT_LE(Real(found.low[lane]), q) << "round " << round << ", lane " << lane;
                ASSERT_GE(Real(found.high[lane]), q) << "round " << round << ", lane " << lane;
                ++hit;
                if (radius < 0.5 * far && discriminant > toward * toward / 64)
                    widest = std::max(
                        widest, static_cast<double>(Real(found.high[lane] - found.low[lane]) / q));
            }
        }
        EXPECT_GT(judged, 700);
        EXPECT_GT(hit, 6000);
        EXPECT_LT(widest, 0x1p-16);
        EXPECT_LT(blocks.found, blocks.truly * 1.2) << blocks.truly;
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
