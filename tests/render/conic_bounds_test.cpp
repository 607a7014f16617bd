// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/conic_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/primary/primary_lanes.h"
#include "fast/primary/sphere_lanes.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_CONIC_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_CONIC_BOUNDS_TEST_CPP_
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

// At the first block's pixels of a tile; `map` where the sphere is an ellipsoid's ball.
void ask_conic(const CameraRays& camera, int tile_x, int tile_y, const CameraSphere& sphere,
               const BallMap* map, ConicAnswers& out) {
    const TileRays rays(camera, tile_x, tile_y);
    SphereConics conics;
    const SeenQuadric one{&sphere, map};
    conics.fill(&one, 1, rays);
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

#include "camera_view.h"
#include "fast/simd/dispatch.h"
#include "true_ball.h"

// What spheres' functions say of a tile's pixels against the same in 60 digits, of spheres and of
// the balls that ellipsoids are mapped to.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261133;

struct MetBlocks {
    int truly = 0;
    int found = 0;
};

// Whoever has a pixel whose ray meets the sphere.
void judge_blocks(const View& view, int tile_x, int tile_y, const RealVector& center, const Real& r,
                  std::uint32_t met, MetBlocks& blocks) {
    using Long = Vec3<long double>;
    const auto rounded = [](const RealVector& v) {
        return Long(static_cast<long double>(v.x), static_cast<long double>(v.y),
                    static_cast<long double>(v.z));
    };
    const auto radius = static_cast<long double>(r);
    std::uint32_t truly = 0;
    for (int lane = 0; lane < kTileLanes; ++lane) {
        const int x = tile_x + lane_x(lane);
        const int y = tile_y + lane_y(lane);
        const Long d = rounded(view.direction(view.camera.center_x(x), view.camera.center_y(y)));
        const Long across = cross(rounded(view.start(x, y) - center), d);
        if (dot(d, d) * radius * radius >= dot(across, across)) truly |= 1U << lane / kBlockLanes;
    }
    ASSERT_EQ(truly & ~met, 0U);
    blocks.truly += std::popcount(truly);
    blocks.found += std::popcount(met);
}

// A scene of one quadric, as the camera sees it.
struct OneQuadric {
    OneQuadric(Scene& scene, const Shape& shape, InstructionSet isa)
        : primitives(flatten(with(scene, shape), LeafContent::kPrimitives)),
          fast(scene, primitives, OctreeType::kUniform, 1),
          camera(scene.camera, kPicture, fast.frame()),
          tables(fast, camera, isa) {}

    Primitives primitives;
    FastScene fast;
    CameraRays camera;
    CameraTables tables;

  private:
    static const Scene& with(Scene& scene, const Shape& shape) {
        Object object;
        object.shape = shape;
        scene.objects = {object};
        return scene;
    }
};

struct JudgedLanes {
    int hit = 0;
    // Of q where the sphere is large in the picture and not grazed: relative, or of parallel rays
    // in units of the local frame.
    double widest = 0;
};

// A sphere's functions at the first block's pixels. The sphere sees vectors as `seen` says.
template <typename Seen>
void judge_lanes(const ConicAnswers& found, const View& view, int tile_x, int tile_y,
                 const RealVector& center, const Real& r, const Seen& seen, bool wide,
                 JudgedLanes& lanes) {
    const CameraRays& camera = view.camera;
    for (int lane = 0; lane < ConicAnswers::kLanes; ++lane) {
        SCOPED_TRACE("lane " + std::to_string(lane));
        const int x = tile_x + lane_x(lane);
        const int y = tile_y + lane_y(lane);
        const RealVector d = seen(view.direction(camera.center_x(x), camera.center_y(y)));
        const RealVector f = seen(view.start(x, y) - center);
        const RealVector across = cross(f, d);
        const Real discriminant = dot(d, d) * r * r - dot(across, across);
        // Of a parallel projection from the plane through the anchor on.
        const Real toward =
            camera.parallel ? Real(-dot(f, d) - Real(camera.starts_at) * dot(d, d)) : dot(f, d);
        const Real power = camera.parallel ? dot(d, d) : Real(dot(f, f) - r * r);
        ASSERT_LE(abs(Real(found.discriminant[lane]) - discriminant), Real(found.error));
        ASSERT_LE(abs(Real(found.toward[lane]) - toward), Real(found.toward_error));
        if (discriminant < 0) continue;
        const Real root = sqrt(discriminant) * (power < 0 ? -1 : 1);
        const Real q = (root - toward) / power;
        ASSERT_LE(Real(found.low[lane]), q);
        ASSERT_GE(Real(found.high[lane]), q);
        ++lanes.hit;
        const Real tile = kTileSide * length(camera.right);
        const Real large = camera.parallel ? Real(tile * tile * power) : Real(toward * toward);
        if (wide && discriminant > large / 64)
            lanes.widest = std::max(lanes.widest,
                                    static_cast<double>(Real(found.high[lane] - found.low[lane]) /
                                                        (camera.parallel ? Real(1) : q)));
    }
}

TEST(ConicBounds, HoldForSpheres) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_conic);
        std::mt19937_64 random(kSeed + 3);
        int judged = 0;
        JudgedLanes lanes[2];  // in perspective, and of parallel rays
        MetBlocks blocks;
        for (int round = 0; round < 800; ++round) {
            SCOPED_TRACE("round " + std::to_string(round));
            View view(camera_of_round(random, round / 4), 1);
            const int tile_x = static_cast<int>(random() % 120) * kTileSide;
            const int tile_y = static_cast<int>(random() % 67) * kTileSide;
            // Behind the tile, beside it, tangent to a ray of it, or around the eye.
            const int kind = round % 4;
            const double x = view.camera.center_x(tile_x) + uniform(random, 0, 4);
            const double y = view.camera.center_y(tile_y) + uniform(random, 0, 4);
            const Vector3 way = normalized(view.camera.direction(x, y));
            const Point3 eye = start_of(view.camera, x, y);
            const double far = std::exp2(uniform(random, -2, 6));
            double radius = std::exp2(uniform(random, -14, 1)) * far;
            Point3 center = eye + way * far;
            if (kind == 1) radius = std::exp2(uniform(random, -36, -14)) * far;  // tiny
            if (kind == 2)
                center = center + normalized(cross(way, uniform_point(random, 1))) * radius;
            if (kind == 3) center = eye + uniform_point(random, 0.5) * radius;
            const OneQuadric one(view.scene, Sphere{center, radius}, isa);
            const CameraSphere& sphere = one.tables.spheres[0];
            if (sphere.floats_cannot_tell) continue;
            ConicAnswers found;
            ask(one.camera, tile_x, tile_y, sphere, nullptr, found);
            ++judged;
            const View local(view.scene.camera, one.fast.frame());
            const Real scale = one.fast.frame().scale;
            const RealVector local_center = RealVector(center) * scale;
            const Real r = Real(radius) * scale;
            judge_blocks(local, tile_x, tile_y, local_center, r, found.met, blocks);
            judge_lanes(
                found, local, tile_x, tile_y, local_center, r,
                [](const RealVector& v) { return v; }, radius < 0.5 * far,
                lanes[view.camera.parallel ? 1 : 0]);
        }
        EXPECT_GT(judged, 700);
        EXPECT_GT(lanes[0].hit, 4000);
        EXPECT_GT(lanes[1].hit, 800);
        EXPECT_LT(lanes[0].widest, 0x1p-16);
        EXPECT_LT(lanes[1].widest, 0x1p-13);
        EXPECT_LT(blocks.found, blocks.truly * 1.2) << blocks.truly;
    }
}

TEST(ConicBounds, HoldForEllipsoids) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_conic);
        std::mt19937_64 random(kSeed + 5);
        int judged = 0;
        JudgedLanes lanes[2];  // in perspective, and of parallel rays
        for (int round = 0; round < 600; ++round) {
            SCOPED_TRACE("round " + std::to_string(round));
            View view(camera_of_round(random, round / 3), 1);
            const int tile_x = static_cast<int>(random() % 120) * kTileSide;
            const int tile_y = static_cast<int>(random() % 67) * kTileSide;
            // Behind the tile, or around the eye.
            const bool around = round % 3 == 0;
            const double x = view.camera.center_x(tile_x) + uniform(random, 0, 4);
            const double y = view.camera.center_y(tile_y) + uniform(random, 0, 4);
            const Vector3 way = normalized(view.camera.direction(x, y));
            const Point3 eye = start_of(view.camera, x, y);
            const double far = std::exp2(uniform(random, -2, 6));
            const double size = std::exp2(uniform(random, around ? 0 : -10, 1)) * far;
            const Point3 center =
                around ? eye + uniform_point(random, 0.3) * size : eye + way * far;
            const Ellipsoid ellipsoid =
                random_ellipsoid(random, center, size, round % 2 == 0 ? -1 : -5);
            const OneQuadric one(view.scene, ellipsoid, isa);
            const FastScene& fast = one.fast;
            const CameraSphere& ball = one.tables.balls[0];
            if (ball.floats_cannot_tell) continue;
            const BallMap& map = fast.ball(0);
            ConicAnswers found;
            ask(one.camera, tile_x, tile_y, ball, &map, found);
            ++judged;
            const TrueBall exact(ellipsoid, fast.frame().scale, map.radius);
            const View local(view.scene.camera, fast.frame());
            const Real scale = fast.frame().scale;
            const Real r = Real(map.radius);
            const RealVector f = exact((RealVector(eye) - RealVector(center)) * scale);
            const bool inside = !view.camera.parallel && dot(f, f) < r * r;
            ASSERT_EQ(inside, ball.inverse_power < 0) << "round " << round;
            judge_lanes(
                found, local, tile_x, tile_y, RealVector(center) * scale, r,
                [&](const RealVector& v) { return exact(v); }, !around,
                lanes[view.camera.parallel ? 1 : 0]);
        }
        EXPECT_GT(judged, 500);
        EXPECT_GT(lanes[0].hit, 3000);
        EXPECT_GT(lanes[1].hit, 800);
        // The flattest and most skewed are stretched by about 2^6.
        EXPECT_LT(lanes[0].widest, 0x1p-12);
        EXPECT_LT(lanes[1].widest, 0x1p-11);
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
