#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fast/camera/camera_tables.h"
#include "fast/simd/dispatch.h"
#include "fast_cases.h"

// Boxes of spheres that touch the ray of a pixel's centre with their outermost point, in pictures
// so wide that the roundings of floats are more than what a box has to spare for others.
namespace nuvo::testing {
namespace {

constexpr Resolution kPicture{60'000, 60'000};
constexpr unsigned kSeed = 20261191;

int first_of(std::uint32_t range) { return static_cast<int>(range & 0xffff); }
int end_of(std::uint32_t range) { return static_cast<int>(range >> 16); }

TEST(PixelBounds, HoldThePixelThatASphereTouches) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        std::mt19937_64 random(kSeed);
        int known = 0, tight = 0;
        for (int round = 0; round < 3000; ++round) {
            Scene scene;
            const Point3 eye = uniform_point(random, 1);
            scene.camera = camera_along(eye, uniform_point(random, 1));
            scene.camera.field_of_view_rad = uniform(random, 0.3, 2);
            if (round / 4 % 3 == 0) scene.camera = parallel_camera(scene.camera, 2);
            const CameraRays rays(scene.camera, kPicture, LocalFrame{{}, 1, 0.25});
            const int x = static_cast<int>(random() % 60'000);
            const int y = static_cast<int>(random() % 60'000);
            const Vector3 way = normalized(rays.direction(rays.center_x(x), rays.center_y(y)));
            // The sphere is on one side of the plane through the eye and the pixel's column or row.
            const bool by_column = round % 2 != 0;
            const double side = round % 4 < 2 ? 1 : -1;
            const Vector3 away = normalized(cross(way, by_column ? rays.down : rays.right)) * side;
            const Point3 start = rays.rays.ray(x, y).origin;
            const double far = std::exp2(uniform(random, -2, 6));
            const double radius = std::exp2(uniform(random, -8, -2)) * far;
            const Point3 center = start + way * far + away * radius;
            Object object;
            object.shape = Sphere{center, radius * (1 + 0x1p-36)};
            scene.objects = {object};
            const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
            const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
            const CameraRays camera(scene.camera, kPicture, fast.frame());
            CameraTables tables(fast, camera, isa);
            const PixelBox& box = tables.boxes[0];
            const std::string where =
                "seed " + std::to_string(kSeed) + ", round " + std::to_string(round);
            ASSERT_LE(first_of(box.columns), x) << where;
            ASSERT_GT(end_of(box.columns), x) << where;
            ASSERT_LE(first_of(box.rows), y) << where;
            ASSERT_GT(end_of(box.rows), y) << where;
            if (!std::isfinite(box.nearest)) continue;
            ++known;
            const std::uint32_t range = by_column ? box.columns : box.rows;
            const int pixel = by_column ? x : y;
            tight += pixel - first_of(range) <= 1 || end_of(range) - 1 - pixel <= 1;
        }
        EXPECT_GT(known, 2000);
        EXPECT_GT(tight, known * 99 / 100);
    }
}

}  // namespace
}  // namespace nuvo::testing
