// Extrusion and the flat shapes: corners by hand from ISO/IEC 19775-1 clauses 13 and 14.
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/loading.h"

namespace nuvo {
namespace {

TriangleMesh mesh(const std::string& geometry) { return mesh_of(load(bare(shape(geometry)))); }

double area(const TriangleMesh& m) {
    double sum = 0;
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const Triangle t = m.triangle(i);
        sum += length(cross(t.b - t.a, t.c - t.a)) / 2;
    }
    return sum;
}

/// By the divergence theorem: positive where a closed mesh is wound outwards.
double volume(const TriangleMesh& m) {
    double sum = 0;
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const Triangle t = m.triangle(i);
        sum += dot(t.a, cross(t.b, t.c)) / 6;
    }
    return sum;
}

TEST(LoaderExtrusion, TheDefaultIsABoxOfHeightOne) {
    const TriangleMesh box = mesh("<Extrusion/>");
    EXPECT_EQ(box.triangles.size(), 12u);
    EXPECT_EQ(box.bounds(), (Bounds3{{-1, 0, -1}, {1, 1, 1}}));
    EXPECT_DOUBLE_EQ(volume(box), 4);
    EXPECT_DOUBLE_EQ(area(box), 16);
    EXPECT_TRUE(box.normals.empty());
    EXPECT_DOUBLE_EQ(volume(mesh("<Extrusion ccw='false'/>")), -4);
}

TEST(LoaderExtrusion, CapsMayBeMissing) {
    EXPECT_DOUBLE_EQ(area(mesh("<Extrusion beginCap='false'/>")), 12);
    EXPECT_DOUBLE_EQ(area(mesh("<Extrusion beginCap='false' endCap='false'/>")), 8);
    // An open cross-section is closed by its caps only: two walls of length 2, triangles of area 2.
    EXPECT_DOUBLE_EQ(area(mesh("<Extrusion crossSection='1 1 1 -1 -1 -1'/>")), 2 * 2 + 2 * 2);
}

TEST(LoaderExtrusion, ScaleAndOrientationChangeAlongTheSpine) {
    // A frustum with sides 2 and 4 and height 3: V = h (a^2 + ab + b^2) / 3.
    EXPECT_DOUBLE_EQ(volume(mesh("<Extrusion spine='0 0 0 0 3 0' scale='1 1 2 2'/>")), 28);
    // Turned by a quarter about y, at both ends: the same box.
    expect_near(mesh("<Extrusion orientation='0 1 0 1.5707963267948966'/>").bounds().max,
                {1, 1, 1});
    expect_near(mesh("<Extrusion crossSection='2 1 2 -1 -2 -1 -2 1 2 1' "
                     "orientation='0 1 0 1.5707963267948966'/>")
                    .bounds()
                    .max,
                {1, 1, 2});
}

TEST(LoaderExtrusion, AStraightSpineInAnyDirection) {
    for (const Vector3& d : {Vector3{0, 1, 0},
                             {0, -1, 0},
                             {1, 0, 0},
                             {0, 0, 1},
                             {0, 0, -1},
                             {1, 2, 2},
                             {-3, 1, 0.5}}) {
        const Vector3 end = normalized(d) * 5;
        const std::string spine =
            std::to_string(end.x) + " " + std::to_string(end.y) + " " + std::to_string(end.z);
        EXPECT_NEAR(volume(mesh("<Extrusion spine='0 0 0 " + spine + "'/>")), 20, 1e-5) << spine;
    }
    // Along z the shortest turn from y brings the section's z to -y.
    const TriangleMesh along_z =
        mesh("<Extrusion spine='0 0 0 0 0 5' crossSection='1 0 0 3 -1 0 1 0'/>");
    expect_near(along_z.bounds().min, {-1, -3, 0});
    expect_near(along_z.bounds().max, {1, 0, 5});
}

TEST(LoaderExtrusion, ABentSpineMitresItsSections) {
    // An L in the plane z = 0: the section in the corner stands on the diagonal.
    const TriangleMesh bent = mesh(
        "<Extrusion spine='0 0 0 0 4 0 4 4 0' crossSection='0.5 0.5 0.5 -0.5 -0.5 -0.5 -0.5 0.5 "
        "0.5 0.5'/>");
    EXPECT_GT(volume(bent), 0);
    expect_near(bent.positions.at(4), {-0.5 * std::numbers::sqrt2 / 2,
                                       4 + 0.5 * std::numbers::sqrt2 / 2, bent.positions.at(4).z});
}

TEST(LoaderExtrusion, AClosedSpineIsARingWithoutASeam) {
    std::string spine;
    constexpr int kPoints = 64;
    for (int i = 0; i <= kPoints; ++i) {
        const double t = 2 * std::numbers::pi * (i % kPoints) / kPoints;
        spine += std::to_string(3 * std::cos(t)) + " 0 " + std::to_string(3 * std::sin(t)) + " ";
    }
    const TriangleMesh ring = mesh(
        "<Extrusion creaseAngle='4' beginCap='false' endCap='false' crossSection='0.5 0.5 0.5 "
        "-0.5 -0.5 -0.5 -0.5 0.5 0.5 0.5' spine='" +
        spine + "'/>");
    EXPECT_EQ(ring.positions.size(), 4u * kPoints);
    EXPECT_EQ(ring.normals.size(), 4u * kPoints);
    // Pappus: area of the section times the way of its middle, here of a 64-gon.
    const double way = 2 * kPoints * 3 * std::sin(std::numbers::pi / kPoints);
    EXPECT_NEAR(volume(ring), way, 0.01 * way);
}

TEST(LoaderExtrusion, EqualPointsAndEmptySectionsEndWell) {
    for (const char* fields :
         {"spine='0 0 0 0 0 0 0 1 0'", "spine='0 0 0 0 1 0 0 1 0'", "spine='0 0 0 0 0 0'",
          "spine='0 0 0 0 1 0 0 0 0'", "spine='0 0 0 0 0 0 0 0 0 0 0 0'", "scale='0 0'",
          "crossSection='0 0 0 0 0 0'", "spine='0 0 0 0 1 0 0 2 0 0 1 0'",
          "spine='1e300 0 0 -1e300 0 0 0 1e300 0'", "spine='0 0 0 1e-320 0 0 0 1 0'"}) {
        const Scene scene =
            load(bare(shape("<Extrusion creaseAngle='1' " + std::string(fields) + "/>")));
        for (const Object& object : scene.objects)
            for (const Point3& p : std::get<TriangleMesh>(object.shape).positions)
                EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
                    << fields;
    }
    for (const char* fields : {"spine='0 0 0'", "crossSection='1 1'"})
        EXPECT_EQ(load(bare(shape("<Extrusion " + std::string(fields) + "/>"))).objects.size(), 0u)
            << fields;
    // A doubled point does not change the solid.
    EXPECT_DOUBLE_EQ(volume(mesh("<Extrusion spine='0 0 0 0 0 0 0 1 0 0 1 0'/>")), 4);
}

TEST(LoaderExtrusion, IsCountedBeforeItIsMade) {
    std::string many;
    for (int i = 0; i < 6000; ++i) many += "0 " + std::to_string(i) + " ";
    std::string spine;
    for (int i = 0; i < 6000; ++i) spine += "0 " + std::to_string(i) + " 0 ";
    EXPECT_NE(refusal(bare(shape("<Extrusion crossSection='" + many + "' spine='" + spine + "'/>")))
                  .find("exceed the limit of 20000000 points"),
              std::string::npos);
}

TEST(LoaderExtrusion, ConcaveSectionsAreCut) {
    // An L-shaped section of area 3 and height 1.
    const std::string section = "crossSection='0 0 0 2 1 2 1 1 2 1 2 0 0 0'";
    EXPECT_NEAR(volume(mesh("<Extrusion convex='false' " + section + "/>")), 3, 1e-12);
    EXPECT_NEAR(area(mesh("<Extrusion convex='false' " + section + "/>")), 2 * 3 + 8, 1e-12);
}

TEST(LoaderFlatShapes, ARectangleFacesForward) {
    const TriangleMesh rectangle = mesh("<Rectangle2D size='3 4'/>");
    EXPECT_EQ(rectangle.bounds(), (Bounds3{{-1.5, -2, 0}, {1.5, 2, 0}}));
    EXPECT_DOUBLE_EQ(area(rectangle), 12);
    const Triangle t = rectangle.triangle(0);
    EXPECT_GT(cross(t.b - t.a, t.c - t.a).z, 0);
    EXPECT_EQ(mesh("<Rectangle2D/>").bounds(), (Bounds3{{-1, -1, 0}, {1, 1, 0}}));
    EXPECT_EQ(load(bare(shape("<Rectangle2D size='-1 1'/>"))).objects.size(), 0u);
}

TEST(LoaderFlatShapes, ADiskMayHaveAHole) {
    const double ratio = 96 / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / 96);
    EXPECT_NEAR(area(mesh("<Disk2D outerRadius='2'/>")), 4 * std::numbers::pi * ratio, 1e-12);
    EXPECT_NEAR(area(mesh("<Disk2D innerRadius='1' outerRadius='2'/>")),
                3 * std::numbers::pi * ratio, 1e-12);
    const Triangle t = mesh("<Disk2D innerRadius='1' outerRadius='2'/>").triangle(0);
    EXPECT_GT(cross(t.b - t.a, t.c - t.a).z, 0);
    EXPECT_EQ(load(bare(shape("<Disk2D innerRadius='2' outerRadius='1'/>"))).objects.size(), 0u);
}

TEST(LoaderFlatShapes, TrianglesTakeThreePointsEach) {
    const TriangleMesh triangles = mesh("<TriangleSet2D vertices='0 0 2 0 0 1 5 5 6 5 5 6 9 9'/>");
    EXPECT_EQ(triangles.triangles.size(), 2u);
    EXPECT_EQ(triangles.positions.at(1), (Point3{2, 0, 0}));
    EXPECT_EQ(triangles.positions.at(2), (Point3{0, 1, 0}));
}

TEST(LoaderFlatShapes, AreSeenFromBothSidesUnlessSolid) {
    for (const char* name : {"Rectangle2D", "Disk2D", "TriangleSet2D vertices='0 0 1 0 0 1'"}) {
        const std::string node = name;
        EXPECT_FALSE(load(bare(shape("<" + node + "/>"))).objects.at(0).solid) << name;
        EXPECT_TRUE(load(bare(shape("<" + node + " solid='true'/>"))).objects.at(0).solid) << name;
    }
}

}  // namespace
}  // namespace nuvo
