#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>

#include "fast/camera/camera_tables.h"
#include "fast/primary/primary.h"
#include "fast/scene/slot_order.h"
#include "fast/simd/dispatch.h"
#include "fast/tile/exact_fallback.h"
#include "fast_cases.h"

// Pixel boxes of spheres, and triangles alone in a scene, against the exact predicates: each pixel
// and primitive of small pictures is asked for. And the order of slots against what it is for:
// neighbours near each other.

namespace nuvo::testing {
namespace {

constexpr Resolution kSize{37, 23};

struct Findings {
    long hits = 0;     // pixels that show a primitive if it is alone
    long outside = 0;  // of these, outside of its box or nearer than that says
    long boxed = 0;    // pixels of all boxes
};

bool within(std::uint32_t range, int pixel) {
    return static_cast<int>(range & 0xffff) <= pixel && pixel < static_cast<int>(range >> 16);
}

Findings compare(const Scene& scene, InstructionSet isa) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const CameraRays camera(scene.camera, kSize, fast.frame());
    CameraTables tables(fast, camera, isa);
    const ExactFallback fallback(fast, camera);
    Findings found;
    for (Slot slot = fast.triangle_end(); slot < fast.slot_end(); ++slot) {
        const PixelBox* const box = &tables.boxes[slot - fast.triangle_end()];
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                const bool boxed = within(box->columns, x) && within(box->rows, y);
                if (boxed) ++found.boxed;
                const auto hit = fallback.nearer(x, y, slot, kNoSlot);
                if (!hit) continue;
                ++found.hits;
                if (!boxed || hit->low > box->nearest) ++found.outside;
            }
    }
    return found;
}

// The pixels that show the scene's only primitive, and those that the primary stage gets wrong.
Findings compare_alone(const Scene& scene, InstructionSet isa) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const CameraRays camera(scene.camera, kSize, fast.frame());
    CameraTables tables(fast, camera, isa);
    const ExactFallback fallback(fast, camera);
    static_assert(kSize.width <= kMacroSide && kSize.height <= kMacroSide);
    const auto job =
        std::make_unique<PrimaryJob>(PrimaryJob{fast, camera, tables, fallback, true, {}});
    const auto macro = std::make_unique<MacroTile>();
    const auto quadrics = std::make_unique<EllipsoidNormals>();
    PrimaryStage(isa).trace(*job, *macro, quadrics.get());
    Findings found;
    for (int lane = 0; lane < MacroTile::kLanes; ++lane) {
        const int x = macro->tile_x(lane / kTileLanes) + lane_x(lane % kTileLanes);
        const int y = macro->tile_y(lane / kTileLanes) + lane_y(lane % kTileLanes);
        if (x >= kSize.width || y >= kSize.height) continue;
        const bool shown = fallback.nearer(x, y, 0, kNoSlot).has_value();
        if (shown) ++found.hits;
        if (shown != (macro->slot[lane] == 0)) ++found.outside;
    }
    return found;
}

// Triangles and spheres of many sizes before, beside and behind the camera and around it.
Scene scene_around_the_camera(unsigned seed) {
    std::mt19937_64 random(seed);
    Scene scene;
    const Point3 eye = uniform_point(random, 1);
    scene.camera = camera_along(eye, uniform_point(random, 1));
    for (int i = 0; i < 150; ++i) {
        const double size = std::exp2(uniform(random, -8, 1));
        Object object;
        const Point3 a = uniform_point(random, 4);
        if (i % 2 == 0) {
            object.shape = Sphere{a, size};
        } else {
            TriangleMesh mesh;
            mesh.positions = {a, a + uniform_point(random, size), a + uniform_point(random, size)};
            mesh.triangles = {{0, 1, 2}};
            object.shape = mesh;
        }
        scene.objects.push_back(object);
    }
    return scene;
}

TEST(FastBoxes, HoldEveryPixelThatShowsThePrimitive) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        Findings all;
        for (unsigned seed = 1; seed <= 8; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const Findings found = compare(scene_around_the_camera(seed), isa);
            EXPECT_EQ(found.outside, 0);
            all.hits += found.hits;
        }
        EXPECT_GT(all.hits, 2000);
    }
}

TEST(FastBoxes, LeaveNoPixelOfATriangleOut) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        long hits = 0;
        for (unsigned seed = 1; seed <= 16; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const Scene scene = scene_around_the_camera(seed);
            for (const Object& object : scene.objects) {
                if (!std::holds_alternative<TriangleMesh>(object.shape)) continue;
                Scene alone;
                alone.camera = scene.camera;
                alone.objects = {object};
                const Findings found = compare_alone(alone, isa);
                EXPECT_EQ(found.outside, 0);
                hits += found.hits;
            }
        }
        EXPECT_GT(hits, 100);
    }
}

TEST(FastBoxes, AreTightAroundDistantPrimitives) {
    std::mt19937_64 random(7);
    Scene scene;
    scene.camera = camera_along({0, 0, 10}, {0, 0, -1});
    for (int i = 0; i < 200; ++i) {
        Object object;
        object.shape = Sphere{uniform_point(random, 3), uniform(random, 0.01, 1)};
        scene.objects.push_back(object);
    }
    const Findings found = compare(scene, resolved(InstructionSet::kBest));
    EXPECT_EQ(found.outside, 0);
    EXPECT_GT(found.hits, 1000);
    // A disc fills pi / 4 of its square; rounding to pixels loses more of small ones.
    EXPECT_LT(static_cast<double>(found.boxed), 1.5 * static_cast<double>(found.hits));
}

Scene many_spheres(int count) {
    std::mt19937_64 random(11);
    Scene scene;
    scene.camera = camera_along({0, 0, 9}, {0, 0, -1});
    Light light;
    light.kind = Light::Kind::kPoint;
    light.location = {1, 5, 9};
    scene.lights.push_back(light);
    scene.materials.resize(1);
    for (int i = 0; i < count; ++i) {
        Object object;
        object.shape = Sphere{uniform_point(random, 3), 0.02};
        object.shape_index = static_cast<std::uint32_t>(i);
        scene.objects.push_back(object);
    }
    return scene;
}

double mean_step(const Scene& scene, const std::vector<PrimitiveId>& ids) {
    double sum = 0;
    for (std::size_t i = 1; i < ids.size(); ++i)
        sum += length(std::get<Sphere>(scene.objects[ids[i]].shape).center -
                      std::get<Sphere>(scene.objects[ids[i - 1]].shape).center);
    return sum / static_cast<double>(ids.size());
}

TEST(SlotOrder, PutsManyShapesNearTheirNeighbours) {
    const Scene scene = many_spheres(40'000);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    std::vector<PrimitiveId> ids(primitives.sources.size());
    for (PrimitiveId id = 0; id < ids.size(); ++id) ids[id] = id;
    std::vector<PrimitiveId> sorted = ids;
    sort_in_space(primitives, {{-4, -4, -4}, {4, 4, 4}}, sorted);
    // Random points of a cube are 0.66 of its side apart, next ones along the curve about 1.5 of a
    // cell with one point, which here is 1 / 34 of the side.
    EXPECT_LT(mean_step(scene, sorted), 0.1 * mean_step(scene, ids));
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, ids);
}

TEST(SlotOrder, LeavesFewShapesInDocumentOrder) {
    const Scene scene = many_spheres(100);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    std::vector<PrimitiveId> ids = {5, 3, 99, 0};
    sort_in_space(primitives, {{-4, -4, -4}, {4, 4, 4}}, ids);
    EXPECT_EQ(ids, (std::vector<PrimitiveId>{5, 3, 99, 0}));
}

TEST(SlotOrder, DoesNotChangeThePicture) {
    Scene scene = many_spheres(33'000);
    // In the same places: of equal hits the first in the document counts.
    scene.materials.resize(2);
    scene.materials[1].diffuse_color = {0.1, 0.9, 0.2};
    for (std::size_t i = 1; i < 3000; i += 2) {
        scene.objects[i].shape = scene.objects[i - 1].shape;
        scene.objects[i].material = 1;
    }
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const Image expected = exact_picture(scene, primitives, {90, 70});
    for (const InstructionSet isa : supported_instruction_sets()) {
        FastOptions options;
        options.threads = 2;
        options.isa = isa;
        EXPECT_EQ(difference(expected, FastTracer(scene, primitives, options).render({90, 70})),
                  "");
    }
}

}  // namespace
}  // namespace nuvo::testing
