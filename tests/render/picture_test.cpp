#include <gtest/gtest.h>

#include <cmath>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

Image picture(const Scene& scene, const Profile& profile, Resolution resolution) {
    const Primitives primitives = flatten(scene, profile.leaves);
    return render(scene, primitives, build_tree(scene, primitives, profile), profile, resolution);
}

struct Probe {
    int x, y;
    int r, g, b;
};

void expect_probes(const std::string& name, const std::vector<Probe>& probes) {
    const Scene scene = x3d::read_file(std::string(NUVO_SOURCE_DIR "/testfiles/") + name + ".x3d");
    for (const Profile& profile : {exact_profile(), thesis_profile()}) {
        const Image image = picture(scene, profile, {480, 270});
        for (const Probe& p : probes) {
            const Rgb8 found = image.at(p.x, p.y);
            EXPECT_NEAR(found.r, p.r, 2) << name << ' ' << p.x << ' ' << p.y;
            EXPECT_NEAR(found.g, p.g, 2) << name << ' ' << p.x << ' ' << p.y;
            EXPECT_NEAR(found.b, p.b, 2) << name << ' ' << p.x << ' ' << p.y;
        }
    }
}

// Two independent browsers, Castle Game Engine 7 and X_ITE 15, agree on these pixels within 3 with
// their headlight off.
TEST(Picture, OfAppendixEIsThatOfTwoBrowsers) {
    expect_probes("appendixE", {{240, 40, 120, 0, 0}, {240, 60, 91, 0, 0}, {240, 135, 0, 0, 0}});
}
TEST(Picture, OfAppendixFIsThatOfTwoBrowsers) {
    expect_probes(
        "appendixF",
        {{240, 135, 255, 0, 0}, {240, 60, 80, 0, 0}, {240, 40, 16, 0, 0}, {240, 200, 113, 0, 0}});
}
TEST(Picture, OfAppendixGIsThatOfTwoBrowsers) {
    expect_probes("appendixG", {{190, 85, 0, 127, 0},
                                {290, 85, 127, 0, 0},
                                {290, 185, 0, 0, 127},
                                {190, 185, 64, 64, 64}});
}

// In float, 1e6 away from the origin and with a step of 0.1 smallest voxels, the pushed point went
// to and fro between two leaves for ever.
TEST(BadCases, TheNudgedWalkEndsWhereThePushedPointMakesNoHeadway) {
    const Scene scene = x3d::read_file(NUVO_SOURCE_DIR "/testfiles/hard/moved-by-1e6.x3d");
    Profile profile = thesis_profile();
    profile.step = 0.1;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const TraceCounts counts = count_events(scene, primitives, octree, profile, {160, 90});
    const std::uint64_t rays = counts.primary_rays + counts.shadow_rays;
    EXPECT_LE(counts.voxel_searches, rays * (octree.leaf_count() + 1));
}

// One white triangle in the plane z = 0 seen along the axis: at the middle of the picture the
// weights of a, b, c are 1/4, 1/4, 1/2.
Scene one_triangle(double eye_z) {
    Scene scene;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0.6, 0.8}};
    scene.objects.push_back({mesh});
    Material white;
    white.diffuse_color = {1, 1, 1};
    scene.materials = {white};
    scene.camera.position = {0, 0, eye_z};
    scene.camera.forward = {0, 0, eye_z > 0 ? -1.0 : 1.0};
    Light light;
    light.direction = scene.camera.forward;
    scene.lights = {light};
    return scene;
}

int middle_pixel(const Scene& scene) { return picture(scene, exact_profile(), {1, 1}).at(0, 0).r; }

// Equation 46 with its renormalisation: (0, 0.3, 0.9) / sqrt(0.9), so N . L = 0.9487.
TEST(Picture, BlendsTheFilesNormalsByTheWeightsOfTheCorners) {
    EXPECT_EQ(middle_pixel(one_triangle(10)), std::lround(255 * 0.9 / std::sqrt(0.9)));
}

TEST(Picture, FlatTrianglesTakeTheGeometricNormal) {
    Scene scene = one_triangle(10);
    std::get<TriangleMesh>(scene.objects[0].shape).normals.clear();
    EXPECT_EQ(middle_pixel(scene), 255);
}

TEST(Picture, AZeroNormalFallsBackToTheGeometricOne) {
    Scene scene = one_triangle(10);
    std::get<TriangleMesh>(scene.objects[0].shape).normals = {{}, {}, {}};
    EXPECT_EQ(middle_pixel(scene), 255);
}

TEST(Picture, TheBackIsSeenOnlyWhereTheShapeIsNotSolid) {
    Scene scene = one_triangle(-10);
    scene.background.sky_color = {{0.2, 0, 0}};
    EXPECT_EQ(middle_pixel(scene), 51);
    Profile drawn = exact_profile();
    drawn.back_faces = BackFaces::kDraw;
    EXPECT_EQ(picture(scene, drawn, {1, 1}).at(0, 0).r, 0);  // and unlit
    scene.objects[0].solid = false;
    EXPECT_EQ(middle_pixel(scene), std::lround(255 * 0.9 / std::sqrt(0.9)));
}

TEST(Picture, AHeadlightCastsNoShadow) {
    Scene scene = one_triangle(10);
    scene.objects.push_back({Sphere{{0, 0, 20}, 1}});  // behind the eye, in the light's way
    EXPECT_EQ(middle_pixel(scene), 0);
    scene.lights[0].casts_shadow = false;
    EXPECT_GT(middle_pixel(scene), 200);
}

TEST(Picture, ALightReachesItsScopeOnly) {
    Scene scene = one_triangle(10);
    scene.lights[0].scope = {1, 2};
    EXPECT_EQ(middle_pixel(scene), 0);
    scene.lights[0].scope = {0, 1};
    EXPECT_GT(middle_pixel(scene), 200);
}

}  // namespace
}  // namespace nuvo
