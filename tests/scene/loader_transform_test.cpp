// Transforms, and spheres under them.
#include <cmath>

#include "scene/loading.h"

namespace nuvo {
namespace {

const std::string kPointsAtUnits =
    shape("<TriangleSet><Coordinate point='1 0 0 0 1 0 0 0 1'/></TriangleSet>");

std::string transformed(const std::string& fields, const std::string& children) {
    return "<Transform " + fields + ">" + children + "</Transform>";
}

Sphere sphere_under(const std::string& nodes) {
    return std::get<Sphere>(load(bare(nodes)).objects.at(0).shape);
}

TEST(LoaderTransform, TranslationsAddUpToTheBit) {
    const double x = 0.1 + 0.2 + 0.3;  // from the root inwards; 0.1 + (0.2 + 0.3) is another double
    ASSERT_NE(x, 0.1 + (0.2 + 0.3));
    const std::string chain = transformed(
        "translation='0.1 1e16 0'",
        transformed("translation='0.2 1 0'",
                    transformed("translation='0.3 1 0.7'", shape("<Sphere/>") + kPointsAtUnits)));
    const Scene scene = load(bare(chain));
    const Point3 moved{x, 1e16 + 1 + 1, 0.7};
    EXPECT_EQ(std::get<Sphere>(scene.objects.at(0).shape).center, moved);
    const TriangleMesh& mesh = mesh_of(scene, 1);
    EXPECT_EQ(mesh.positions.at(0), (Point3{1 + moved.x, moved.y, moved.z}));
    EXPECT_EQ(mesh.positions.at(1), (Point3{moved.x, 1 + moved.y, moved.z}));
    EXPECT_EQ(mesh.positions.at(2), (Point3{moved.x, moved.y, 1 + moved.z}));
}

TEST(LoaderTransform, RotationByZeroScaleOneAndCenterAloneChangeNoBit) {
    const Scene scene = load(bare(transformed(
        "rotation='0.3 0.7 0.1 0' scale='1 1 1' scaleOrientation='0.3 0.7 0.1 0.9' "
        "center='0.1 0.7 1e9'",
        shape("<TriangleSet><Coordinate point='0.1 0.2 0.3 1e-9 7 1e9 0 1 0'/></TriangleSet>"))));
    EXPECT_EQ(mesh_of(scene).positions,
              (std::vector<Point3>{{0.1, 0.2, 0.3}, {1e-9, 7, 1e9}, {0, 1, 0}}));
}

TEST(LoaderTransform, FieldsApplyInTheStandardsOrder) {
    // p = (2,0,0): less the centre (1,0,0); stretched (2,0,0); turned (0,2,0); back (1,2,0); moved.
    const Scene scene = load(bare(transformed(
        "translation='1 2 3' rotation='0 0 1 1.5707963267948966' scale='2 1 1' center='1 0 0'",
        shape("<TriangleSet><Coordinate point='2 0 0 1 0 0 1 1 0'/></TriangleSet>"))));
    const TriangleMesh& mesh = mesh_of(scene);
    expect_near(mesh.positions.at(0), {2, 4, 3});
    expect_near(mesh.positions.at(1), {2, 2, 3});
    expect_near(mesh.positions.at(2), {1, 2, 3});
}

TEST(LoaderTransform, ScaleOrientationTurnsTheAxesOfTheScale) {
    // The x axis of the scale lies along y.
    const Scene scene = load(bare(
        transformed("scale='2 1 1' scaleOrientation='0 0 5 1.5707963267948966'", kPointsAtUnits)));
    expect_near(mesh_of(scene).positions.at(0), {1, 0, 0});
    expect_near(mesh_of(scene).positions.at(1), {0, 2, 0});
    expect_near(mesh_of(scene).positions.at(2), {0, 0, 1});
}

TEST(LoaderTransform, TheOuterTransformIsAppliedLast) {
    const Scene scene = load(bare(transformed(
        "scale='2 2 2'", transformed("translation='1 0 0'", kPointsAtUnits) +
                             transformed("rotation='1 0 0 3.141592653589793'", kPointsAtUnits))));
    EXPECT_EQ(mesh_of(scene, 0).positions.at(0), (Point3{4, 0, 0}));
    EXPECT_EQ(mesh_of(scene, 0).positions.at(1), (Point3{2, 2, 0}));
    expect_near(mesh_of(scene, 1).positions.at(1), {0, -2, 0});
    expect_near(mesh_of(scene, 1).positions.at(2), {0, 0, -2});
}

TEST(LoaderTransform, AnAxisOfLengthZeroIsNoRotationWithAWarning) {
    const Scene scene = load(bare(transformed("rotation='0 -0 0 1'", kPointsAtUnits)));
    EXPECT_EQ(mesh_of(scene).positions.at(0), (Point3{1, 0, 0}));
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{"Transform@rotation: 1 about an axis of length zero taken "
                                       "as no rotation (first at Scene/Transform, line 1)"});
}

TEST(LoaderTransform, AnyLengthOfAxisTurnsAlike) {
    for (const char* axis : {"0 0 1e200", "0 0 1e-200"}) {
        const Scene scene = load(bare(transformed(
            "rotation='" + std::string(axis) + " 1.5707963267948966'", kPointsAtUnits)));
        expect_near(mesh_of(scene).positions.at(0), {0, 1, 0});
    }
}

TEST(LoaderSphere, UniformScalesMultiplyTheRadius) {
    const Sphere sphere = sphere_under(transformed(
        "scale='3 3 3' rotation='1 2 3 0.7'",
        transformed("scale='-0.1 0.1 -0.1' scaleOrientation='1 1 0 1' translation='1 0 0'",
                    shape("<Sphere radius='2'/>"))));
    EXPECT_EQ(sphere.radius, 2 * (3 * 0.1));
    EXPECT_NEAR(length(sphere.center), 3, 1e-14);
}

TEST(LoaderSphere, AnUnequalScaleAnywhereInTheChainMakesAnEllipsoid) {
    const Scene scene = load(bare(transformed(
        "translation='1 2 3' scale='2 1 4'",
        transformed("scale='3 3 3' translation='1 0 0'", shape("<Sphere radius='0.5'/>")))));
    const auto& ellipsoid = std::get<Ellipsoid>(scene.objects.at(0).shape);
    EXPECT_EQ(ellipsoid.center, (Point3{3, 2, 3}));
    EXPECT_EQ(ellipsoid.radius, 0.5);
    EXPECT_EQ(ellipsoid.linear, (Matrix3{{{6, 0, 0}, {0, 3, 0}, {0, 0, 12}}}));
}

TEST(LoaderSphere, OfRadiusZeroOrUnderAScaleOfZeroIsCountedButNotDrawn) {
    const Scene scene =
        load(bare(shape("<Sphere radius='0'/>") +
                  transformed("scale='1 0 1'", shape("<Sphere/>") + shape("<Sphere/>")) +
                  shape("<Sphere/>")));
    EXPECT_EQ(scene.shape_count, 4u);
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].shape_index, 3u);
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{
                  "Sphere@radius: 1 of zero: not drawn (first at Scene/Shape[1]/Sphere, line 1)",
                  "Sphere: 2 flattened by a scale of zero: not drawn (first at "
                  "Scene/Transform/Shape[1]/Sphere, line 1)"}));
}

TEST(LoaderTransform, AScaleOfZeroLeavesAFlatMeshWithAWarning) {
    const Scene scene = load(bare(transformed("scale='1 0 1'", kPointsAtUnits)));
    EXPECT_EQ(mesh_of(scene).positions, (std::vector<Point3>{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(LoaderTransform, WhatLeavesTheRangeOfDoubleIsRefused) {
    const std::string huge = "scale='1e200 1e200 1e200'";
    EXPECT_EQ(
        refusal(bare(transformed(huge, transformed(huge, shape("<Sphere/>"))))),
        "scene.x3d: Scene/Transform/Transform/Shape/Sphere@radius: beyond the range of double "
        "in world space (line 1)");
    EXPECT_EQ(refusal(bare(transformed(huge, transformed(huge, kPointsAtUnits)))),
              "scene.x3d: Scene/Transform/Transform/Shape/TriangleSet/Coordinate@point: beyond the "
              "range of double in world space (line 1)");
    EXPECT_NE(refusal(bare(transformed(huge, transformed(huge, "<PointLight/>")))), "");
    EXPECT_NE(refusal(bare(transformed(huge, transformed(huge, "<Viewpoint/>")))), "");
}

}  // namespace
}  // namespace nuvo
