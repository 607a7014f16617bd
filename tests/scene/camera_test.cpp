#include "nuvo/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nuvo {
namespace {

void expect_near(const Vector3& actual, const Vector3& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-15);
}

/// Looks along -z with an image plane that reaches half as far as it is away.
Camera half_camera() {
    Camera camera;
    camera.field_of_view_rad = 2 * std::atan(0.5);
    return camera;
}

TEST(RayGenerator, TheMiddleOfThePictureLooksStraightAhead) {
    const Ray ray = RayGenerator(Camera{}, {480, 270}).ray_at(240, 135);
    EXPECT_EQ(ray.origin, (Point3{0, 0, 10}));
    EXPECT_EQ(ray.direction, (Vector3{0, 0, -1}));
    EXPECT_EQ(RayGenerator(Camera{}, {3, 3}).ray(1, 1).direction, (Vector3{0, 0, -1}));
}

// 4 units wide and 2 high, its middle 1 to the right of the position and 3 above.
TEST(RayGenerator, AWindowIsSeenByParallelRays) {
    Camera camera;
    camera.window = {{-1, 2}, {3, 4}};
    for (const Resolution size : {Resolution{400, 200}, Resolution{40, 20}}) {
        const RayGenerator rays(camera, size);
        const Ray corner = rays.ray_at(0, 0);
        EXPECT_EQ(corner.origin, (Point3{-1, 4, 10}));
        EXPECT_EQ(corner.direction, (Vector3{0, 0, -1}));
        EXPECT_EQ(rays.ray_at(size.width, size.height).origin, (Point3{3, 2, 10}));
        EXPECT_EQ(rays.ray_at(size.width, size.height).direction, (Vector3{0, 0, -1}));
    }
    // A picture of another shape shows more on one axis, about the same middle.
    EXPECT_EQ(RayGenerator(camera, {400, 100}).ray_at(0, 0).origin, (Point3{-3, 4, 10}));
    EXPECT_EQ(RayGenerator(camera, {100, 100}).ray_at(0, 0).origin, (Point3{-1, 5, 10}));
}

TEST(RayGenerator, FieldOfViewIsTheVerticalAngleOfAWidePicture) {
    const RayGenerator wide(half_camera(), {400, 200});
    expect_near(wide.ray_at(200, 0).direction, normalized(Vector3{0, 0.5, -1}));
    expect_near(wide.ray_at(200, 200).direction, normalized(Vector3{0, -0.5, -1}));
    expect_near(wide.ray_at(0, 100).direction, normalized(Vector3{-1, 0, -1}));
    expect_near(wide.ray_at(400, 0).direction, normalized(Vector3{1, 0.5, -1}));
}

TEST(RayGenerator, FieldOfViewIsTheHorizontalAngleOfATallPicture) {
    const RayGenerator tall(half_camera(), {100, 300});
    expect_near(tall.ray_at(0, 150).direction, normalized(Vector3{-0.5, 0, -1}));
    expect_near(tall.ray_at(50, 0).direction, normalized(Vector3{0, 1.5, -1}));
}

TEST(RayGenerator, RaysPassThroughPixelCentersRowsFromTheTop) {
    const RayGenerator rays(half_camera(), {4, 2});
    // Pixels are half as wide as the plane is high over two: 0.5 each way.
    expect_near(rays.ray(0, 0).direction, normalized(Vector3{-0.75, 0.25, -1}));
    expect_near(rays.ray(3, 1).direction, normalized(Vector3{0.75, -0.25, -1}));
    EXPECT_EQ(rays.ray(2, 1).direction, rays.ray_at(2.5, 1.5).direction);
}

TEST(RayGenerator, FollowsTheCamerasAxes) {
    Camera camera = half_camera();
    camera.position = {1, 2, 3};
    camera.right = {0, 0, -1};
    camera.forward = {-1, 0, 0};
    const Ray ray = RayGenerator(camera, {200, 200}).ray_at(200, 100);
    EXPECT_EQ(ray.origin, (Point3{1, 2, 3}));
    expect_near(ray.direction, normalized(Vector3{-1, 0, -0.5}));
}

TEST(RayGenerator, DirectionsAreUnitVectors) {
    const RayGenerator rays(Camera{}, {37, 23});
    // normalized() rounds each component about four times, and squaring doubles that; this dot
    // product rounds three times more.
    const double roundings = 11 * std::numeric_limits<double>::epsilon() / 2;
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 37; ++x)
            EXPECT_NEAR(dot(rays.ray(x, y).direction, rays.ray(x, y).direction), 1, roundings);
}

}  // namespace
}  // namespace nuvo
