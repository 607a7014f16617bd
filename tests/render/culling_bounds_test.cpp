// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/culling_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/primary/triangle_culling.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

std::uint32_t kept_in_tile(const FastScene& scene, const CameraRays& camera, const MacroTile& tile,
                           const Slot* slots) {
    const Frustum frustum(camera, tile, scene.reach());
    return TriangleCulling(scene, camera, frustum).keeps(slots).bits();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <memory>

#include "camera_view.h"
#include "fast/simd/dispatch.h"

// Triangles that are culled before their corners are fetched, against the same question in 60
// digits: each turns an invisible back to the eye, lies beside all rays of the macro tile, or
// between the middles of its pixels.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261158;
constexpr int kTriangles = 48;

/// What a triangle is made for.
enum Kind { kAnywhere, kEdgeOn, kBesideTheTile, kTiny, kBetweenPixels, kKinds };

struct Found {
    int backs = 0;
    int beside = 0;
    int between = 0;
    int kept_backs = 0;  // of those that might have been culled
    int kept = 0;
};

/// Its own rays, and triangles in world space before and beside them.
struct CulledScene {
    Scene scene;
    Primitives primitives;
    std::unique_ptr<FastScene> fast;
    std::unique_ptr<CameraRays> camera;
    MacroTile tile{};

    CulledScene(std::mt19937_64& random, Kind kind, bool solid, bool parallel) {
        const double far = random() % 2 == 0 ? 1 : std::exp2(uniform(random, 0, 14));
        const Point3 eye = uniform_point(random, far);
        scene.camera = camera_along(eye, uniform_point(random, 1));
        if (parallel)
            scene.camera = parallel_camera(scene.camera, std::exp2(uniform(random, -2, 2)));
        // What the rays are does not depend on the scene.
        const View view(scene.camera, 1);
        tile.x = static_cast<int>(random() % kPicture.width) / kMacroSide * kMacroSide;
        tile.y = static_cast<int>(random() % kPicture.height) / kMacroSide * kMacroSide;
        TriangleMesh mesh;
        for (int i = 0; i < kTriangles; ++i) {
            const Triangle t = triangle(random, kind, view.camera);
            for (const Point3& corner : {t.a, t.b, t.c}) mesh.positions.push_back(corner);
            const auto first = static_cast<std::uint32_t>(3 * i);
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        scene.materials.emplace_back();
        scene.objects.push_back(Object{.shape = mesh, .solid = solid});
        primitives = flatten(scene, LeafContent::kPrimitives);
        fast = std::make_unique<FastScene>(scene, primitives, OctreeType::kUniform, 1);
        camera = std::make_unique<CameraRays>(scene.camera, kPicture, fast->frame());
    }

    /// Rays of the tile, in pixel coordinates.
    double middle_x() const { return middle(tile.x, kPicture.width); }
    double middle_y() const { return middle(tile.y, kPicture.height); }

    RealVector from_eye(const Point3& p) const {
        return (RealVector(p) - RealVector(camera->anchor)) * Real(fast->frame().scale);
    }
    bool shows_its_back(const Triangle& t) const {
        const RealVector a = from_eye(t.a);
        const RealVector way = camera->parallel ? RealVector(camera->forward) : a;
        return dot(cross(from_eye(t.b) - a, from_eye(t.c) - a), way) > 0;
    }
    /// Beyond a plane through the eye that has all rays of the tile on its other side.
    bool lies_beside(const Triangle& t) const {
        for (const double half : {0.5 * (kMacroSide - 1), 1.0 * kMacroSide})
            for (const double sign : {1.0, -1.0})
                if (all_beyond(t, camera->right, middle_x(), half, sign) ||
                    all_beyond(t, camera->down, middle_y(), half, sign))
                    return true;
        return false;
    }

    /// Before the eye, where the rays of none of the tile's columns or rows of pixels pass.
    bool lies_between(const Triangle& t) const {
        return has_no_pixel(t, camera->right, middle_x()) ||
               has_no_pixel(t, camera->down, middle_y());
    }

  private:
    // By which pixel coordinates shrink.
    Real depth_of(const RealVector& w) const {
        return camera->parallel ? Real(1) : dot(RealVector(camera->forward), w);
    }
    bool has_no_pixel(const Triangle& t, const Vector3& axis, double middle) const {
        const RealVector along(axis);
        Real low = 2 * kMacroSide;
        Real high = -low;
        for (const Point3& p : {t.a, t.b, t.c}) {
            const RealVector w = from_eye(p);
            const Real depth = depth_of(w);
            if (depth <= 0) return false;
            const Real pixel = dot(along, w) / dot(along, along) / depth - Real(middle) +
                               Real(0.5 * (kMacroSide - 1));
            low = std::min(low, pixel);
            high = std::max(high, pixel);
        }
        for (int pixel = 0; pixel < kMacroSide; ++pixel)
            if (low <= Real(pixel) && Real(pixel) <= high) return false;
        return true;
    }
    bool all_beyond(const Triangle& t, const Vector3& axis, double middle, double half,
                    double sign) const {
        const RealVector along(axis);
        const auto beyond = [&](const Point3& p) {
            const RealVector w = from_eye(p);
            const Real pixels = dot(along, w) / dot(along, along);
            const Real depth = depth_of(w);
            return Real(sign) * (pixels - Real(middle) * depth) > Real(half) * depth;
        };
        return beyond(t.a) && beyond(t.b) && beyond(t.c);
    }
    static double middle(int first, int size) { return first + 0.5 * kMacroSide - 0.5 * size; }

    Triangle triangle(std::mt19937_64& random, Kind kind, const CameraRays& rays) const {
        const auto toward = [&](double x, double y) {
            const double nearest = kind == kBetweenPixels ? -14 : -6;
            return start_of(rays, x, y) +
                   normalized(rays.direction(x, y)) * std::exp2(uniform(random, nearest, 3));
        };
        const double width = kind == kAnywhere ? 300 : 40;
        const auto point = [&] {
            const double x = middle_x() + uniform(random, -width, width);
            return toward(x, middle_y() + uniform(random, -width, width));
        };
        Triangle t;
        t.a = point();
        const double size = std::exp2(uniform(random, kind == kTiny ? -24 : -10, -2));
        t.b = t.a + uniform_point(random, size);
        t.c = t.a + uniform_point(random, size);
        if (kind == kEdgeOn) {  // in a plane through the eye, but for a little
            const Vector3 way = rays.parallel ? rays.forward : t.a - rays.anchor;
            t.b = t.a + way * uniform(random, 0.01, 1);
            t.c = t.a + way * uniform(random, -0.5, 0.5);
            if (random() % 2 == 0) t.c = t.b + uniform_point(random, size);
            // About as much as floats round corners by.
            t.c = t.c + uniform_point(random, std::exp2(uniform(random, -30, -16)));
        } else if (kind == kBesideTheTile) {  // around the tile's outermost rays
            const double side = random() % 2 == 0 ? 1 : -1;
            const auto near_side = [&] {
                const double x = middle_x() + side * (0.5 * kMacroSide + uniform(random, -1, 2));
                return toward(x, middle_y() + uniform(random, -40, 40));
            };
            t.b = near_side();
            t.c = near_side();
            t.a = near_side();
        } else if (kind == kBetweenPixels) {  // corners about the middle of a pixel
            const double x =
                middle_x() - 0.5 * (kMacroSide - 1) + static_cast<int>(random() % kMacroSide);
            const double y =
                middle_y() - 0.5 * (kMacroSide - 1) + static_cast<int>(random() % kMacroSide);
            const double around = std::exp2(uniform(random, -12, 0));
            const auto near_pixel = [&] {
                const double at_x = x + uniform(random, -0.25, 1) * around;
                return toward(at_x, y + uniform(random, -0.25, 1) * around);
            };
            t.a = near_pixel();
            t.b = near_pixel();
            t.c = near_pixel();
        }
        return t;
    }
};

TEST(CullingBounds, NothingIsCulledThatMayShow) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto kept_in = NUVO_FOR_ISA(isa, kept_in_tile);
        std::mt19937_64 random(kSeed);
        Found found[kKinds];
        for (int round = 0; round < 1600; ++round) {
            const auto kind = static_cast<Kind>(round % kKinds);
            const bool solid = round / kKinds % 3 != 0;
            const CulledScene culled(random, kind, solid, round / (3 * kKinds) % 3 == 0);
            // Triangles that turn out to be without area are none of the scene's.
            for (Slot first = 0; first + 16 <= culled.fast->triangle_end(); first += 16) {
                Slot slots[16];
                for (Slot i = 0; i < 16; ++i) slots[i] = first + i;
                const std::uint32_t kept =
                    kept_in(*culled.fast, *culled.camera, culled.tile, slots);
                for (Slot i = 0; i < 16; ++i) {
                    const Triangle t = culled.fast->triangle(slots[i]);
                    const bool back = solid && culled.shows_its_back(t);
                    if ((kept >> i & 1) != 0) {
                        ++(back ? found[kind].kept_backs : found[kind].kept);
                        continue;
                    }
                    const bool beside = culled.lies_beside(t);
                    ASSERT_TRUE(back || beside || culled.lies_between(t))
                        << "seed " << kSeed << ", round " << round << ", slot " << slots[i];
                    ++(back     ? found[kind].backs
                       : beside ? found[kind].beside
                                : found[kind].between);
                }
            }
        }
        for (const Kind kind : {kTiny, kBetweenPixels})
            EXPECT_GT(found[kind].between, 250) << "kind " << kind;
        for (const Kind kind : {kAnywhere, kTiny, kBesideTheTile}) {
            EXPECT_GT(found[kind].backs, 400) << "kind " << kind;
            EXPECT_GT(found[kind].beside, 400) << "kind " << kind;
            EXPECT_GT(found[kind].kept, 800) << "kind " << kind;
        }
        // Some that are so nearly seen edge-on that floats cannot tell, and some that they can.
        EXPECT_GT(found[kEdgeOn].kept_backs, 1000);
        EXPECT_GT(found[kEdgeOn].backs, 400);
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
