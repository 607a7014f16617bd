#include "nuvo/scene/framing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nuvo {
namespace {

constexpr Resolution kWide{160, 90};

Scene scene_of(Shape shape) {
    Scene scene;
    scene.objects.push_back({std::move(shape)});
    return scene;
}
Framing standard(const Scene& scene, Resolution resolution = kWide) {
    return framing(scene, Camera{}, resolution);
}
TriangleMesh square(double half, const Vector3& u, const Vector3& v, const Point3& middle) {
    TriangleMesh mesh;
    mesh.positions = {middle - (u + v) * half, middle + (u - v) * half, middle + (u + v) * half,
                      middle + (v - u) * half};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

// The picture's upper side lies tan(pi / 8) = 0.414 above the view at distance 1: a sphere around 0
// fits while its radius is below 10 sin(pi / 8) = 3.8268.
TEST(Framing, OfASphereChangesWhereItTouchesThePicture) {
    EXPECT_EQ(standard(scene_of(Sphere{{0, 0, 0}, 3.826})), Framing::kGood);
    EXPECT_EQ(standard(scene_of(Sphere{{0, 0, 0}, 3.828})), Framing::kCut);
    EXPECT_EQ(standard(scene_of(Ellipsoid{{0, 0, 0}, {}, 3.826})), Framing::kGood);
    EXPECT_EQ(standard(scene_of(Ellipsoid{{0, 0, 0}, {}, 3.828})), Framing::kCut);
    EXPECT_EQ(standard(scene_of(Sphere{{0, 0, 10}, 1})), Framing::kCut);  // the camera is within
}

// 10 * 0.41421 above the middle, and 16 / 9 of that to its right.
TEST(Framing, OfAMeshChangesWhereACornerLeavesThePicture) {
    const auto at = [](double x, double y) {
        TriangleMesh mesh;
        mesh.positions = {{0, 0, 0}, {x, 0, 0}, {0, y, 0}, {1e9, 0, 0}};  // the last is no corner
        mesh.triangles = {{0, 1, 2}};
        return standard(scene_of(mesh));
    };
    EXPECT_EQ(at(7.363, 4.142), Framing::kGood);
    EXPECT_EQ(at(7.364, 4.142), Framing::kCut);
    EXPECT_EQ(at(7.363, 4.143), Framing::kCut);
}

TEST(Framing, OfWhatIsOutsideIsNothing) {
    for (const Point3& center :
         {Point3{60, 0, 0}, Point3{0, -20, 0}, Point3{0, 0, 20}, Point3{30, 30, 30}})
        EXPECT_EQ(standard(scene_of(Sphere{center, 2})), Framing::kNothing);
    EXPECT_EQ(standard(Scene{}), Framing::kGood);
}

// A tenth of the picture's height at distance 10 is 0.828.
TEST(Framing, OfASmallThingIsTiny) {
    const auto of = [](double half) {
        return standard(scene_of(square(half, {1, 0, 0}, {0, 1, 0}, {0, 0, 0})));
    };
    EXPECT_EQ(of(0.413), Framing::kTiny);
    EXPECT_EQ(of(0.415), Framing::kGood);
}

TEST(FittedCamera, ShowsAllOfTheSceneAndNotTiny) {
    for (const double scale : {1e-12, 1.0, 1e12})
        for (const Vector3& move : {Vector3{0, 0, 0}, Vector3{60, -7, 1e3}}) {
            Scene scene;
            scene.objects.push_back({Sphere{(Point3{1, 2, 3} + move) * scale, 2 * scale}});
            scene.objects.push_back({Ellipsoid{
                (Point3{-5, 0, 1} + move) * scale, {{{1, 0, 0}, {1, 2, 0}, {0, 0, -3}}}, scale}});
            scene.objects.push_back(
                {square(3 * scale, {1, 0, 0}, {0, 1, 0}, (Point3{0, -6, 2} + move) * scale)});
            const std::optional<Camera> camera = fitted_camera(scene);
            ASSERT_TRUE(camera);
            for (const Resolution size : {Resolution{100, 100}, kWide, Resolution{90, 160}})
                EXPECT_EQ(framing(scene, *camera, size), Framing::kGood);
            EXPECT_EQ(camera->forward, (Vector3{0, 0, -1}));
        }
}

// A sphere of radius 1 touches a cone of half angle a, tan a = 0.9 tan(pi / 8), from a distance of
// 1 / sin a.
TEST(FittedCamera, LeavesATenthOfThePictureFree) {
    const double slope = 0.9 * std::tan(Camera{}.field_of_view_rad / 2);
    const Camera camera = fitted_camera(scene_of(Sphere{{60, 0, 0}, 1})).value();
    EXPECT_DOUBLE_EQ(camera.position.x, 60);
    EXPECT_NEAR(camera.position.y, 0, 1e-12);
    EXPECT_NEAR(camera.position.z, std::sqrt(1 + 1 / (slope * slope)), 1e-12);
}

TEST(FittedCamera, LooksDownAtWhatLiesFlat) {
    const Scene ground = scene_of(square(5, {1, 0, 0}, {0, 0, -1}, {0, 0, 0}));
    const Camera camera = fitted_camera(ground).value();
    EXPECT_NEAR(camera.forward.y, -0.5, 1e-15);
    EXPECT_NEAR(length(camera.forward), 1, 1e-15);
    EXPECT_NEAR(dot(camera.forward, camera.up), 0, 1e-15);
    EXPECT_EQ(framing(ground, camera, kWide), Framing::kGood);
}

TEST(FittedCamera, IsNoneWhereThereIsNothingToShow) {
    EXPECT_FALSE(fitted_camera(Scene{}));
    TriangleMesh point;
    point.positions = {{1, 1, 1}};
    point.triangles = {{0, 0, 0}};
    EXPECT_FALSE(fitted_camera(scene_of(point)));
    EXPECT_FALSE(fitted_camera(scene_of(Sphere{{1e308, 1e308, 0}, 1e308})));
}

}  // namespace
}  // namespace nuvo
