// Box, Cone and Cylinder as meshes.
#include <cmath>
#include <map>
#include <numbers>

#include "scene/loading.h"

namespace nuvo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kSides = 96;

TriangleMesh mesh_from(const std::string& geometry) { return mesh_of(load(bare(shape(geometry)))); }

/// Six times the volume that the mesh encloses when its triangles are seen counterclockwise from
/// outside (divergence theorem).
double volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle t = mesh.triangle(i);
        sum += dot(t.a, cross(t.b, t.c));
    }
    return sum / 6;
}

double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle t = mesh.triangle(i);
        sum += length(cross(t.b - t.a, t.c - t.a)) / 2;
    }
    return sum;
}

/// Every edge is met by two triangles, once in each direction.
void expect_closed(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const IndexTriple& t : mesh.triangles)
        for (const int c : {0, 1, 2}) ++edges[{t[c], t[(c + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

TEST(LoaderSolids, ABoxHasItsSizeAndFacesOutwards) {
    const TriangleMesh box = mesh_from("<Box size='1 2 4'/>");
    EXPECT_EQ(box.triangles.size(), 12u);
    EXPECT_EQ(box.bounds(), (Bounds3{{-0.5, -1, -2}, {0.5, 1, 2}}));
    EXPECT_DOUBLE_EQ(volume(box), 8);
    EXPECT_DOUBLE_EQ(area(box), 2 * (1 * 2 + 2 * 4 + 4 * 1));
    EXPECT_TRUE(box.normals.empty());  // flat
    expect_closed(box);
    EXPECT_EQ(mesh_from("<Box/>").bounds(), (Bounds3{{-1, -1, -1}, {1, 1, 1}}));
}

TEST(LoaderSolids, ACylinderIsAPrismOf96SidesThatFacesOutwards) {
    const TriangleMesh cylinder = mesh_from("<Cylinder radius='2' height='3'/>");
    // A quadrilateral a side, and the two caps as fans.
    EXPECT_EQ(cylinder.triangles.size(), 2 * kSides + 2 * (kSides - 2));
    const double base = kSides / 2.0 * 4 * std::sin(2 * kPi / kSides);  // area of the 96-gon
    EXPECT_NEAR(volume(cylinder), 3 * base, 1e-12);
    EXPECT_NEAR(area(cylinder), 2 * base + kSides * 2 * 2 * std::sin(kPi / kSides) * 3, 1e-11);
    expect_closed(cylinder);
    // Its edges stay this near to the circle: 0.29 pixels where the radius is 540.
    EXPECT_LT(540 * (1 - std::cos(kPi / kSides)), 0.29);
}

TEST(LoaderSolids, ACylindersNormalsAreRadialOnTheMantleAndFlatOnTheCaps) {
    const TriangleMesh cylinder = mesh_from("<Cylinder radius='2' height='3'/>");
    for (std::size_t i = 0; i < cylinder.triangles.size(); ++i)
        for (const int c : {0, 1, 2}) {
            const Point3 p = cylinder.positions[cylinder.triangles[i][c]];
            const Vector3 n = cylinder.normals.at(cylinder.normal_triangles.at(i)[c]);
            if (i < 2 * kSides)
                expect_near(n, Vector3{p.x, 0, p.z} / 2);
            else
                EXPECT_EQ(n, (Vector3{0, p.y > 0 ? 1.0 : -1.0, 0}));
        }
}

TEST(LoaderSolids, AConeIsAPyramidOf96SidesThatFacesOutwards) {
    const TriangleMesh cone = mesh_from("<Cone bottomRadius='2' height='3'/>");
    EXPECT_EQ(cone.triangles.size(), kSides + kSides - 2);
    const double base = kSides / 2.0 * 4 * std::sin(2 * kPi / kSides);
    EXPECT_NEAR(volume(cone), base, 1e-12);  // a third of base times height
    EXPECT_EQ(cone.bounds().max.y, 1.5);
    EXPECT_EQ(cone.bounds().min.y, -1.5);
    expect_closed(cone);
    for (std::size_t i = 0; i < kSides; ++i) {
        const IndexTriple& t = cone.triangles[i];
        const IndexTriple& n = cone.normal_triangles.at(i);
        Vector3 middle;
        for (const int c : {0, 1}) {
            // A normal stands at a right angle to the line from the rim to the apex (0, 1.5, 0).
            const Point3 p = cone.positions[t[c]];
            EXPECT_NEAR(dot(cone.normals[n[c]], Vector3{0, 1.5, 0} - p), 0, 1e-14);
            EXPECT_NEAR(length(cone.normals[n[c]]), 1, 1e-15);
            EXPECT_GT(dot(cone.normals[n[c]], p), 0);
            middle += p;
        }
        // The apex has each side's own normal, above the middle of its rim.
        EXPECT_NEAR(cross(cone.normals[n[2]], middle).y, 0, 1e-14);
        EXPECT_EQ(cone.positions[t[2]], (Point3{0, 1.5, 0}));
    }
}

TEST(LoaderSolids, PartsCanBeLeftOut) {
    EXPECT_EQ(mesh_from("<Cylinder top='false'/>").triangles.size(), 3 * kSides - 2);
    EXPECT_EQ(mesh_from("<Cylinder bottom='false' top='FALSE'/>").triangles.size(), 2 * kSides);
    EXPECT_EQ(mesh_from("<Cylinder side='false'/>").triangles.size(), 2 * (kSides - 2));
    EXPECT_EQ(mesh_from("<Cone side='false'/>").triangles.size(), kSides - 2);
    EXPECT_EQ(mesh_from("<Cone bottom='false'/>").triangles.size(), kSides);
    const TriangleMesh top = mesh_from("<Cylinder side='false' bottom='false'/>");
    EXPECT_EQ(top.bounds().min.y, 1);  // the points of what is left out are gone
    const Scene none = load(bare(shape("<Cone side='false' bottom='false'/>")));
    EXPECT_TRUE(none.objects.empty());
    EXPECT_EQ(none.shape_count, 1u);
    EXPECT_EQ(none.warnings,
              std::vector<std::string>{
                  "Cone: 1 without triangles not drawn (first at Scene/Shape/Cone, line 1)"});
}

TEST(LoaderSolids, MirrorsAndUnequalScalesKeepTheOutsideOutside) {
    for (const char* geometry : {"<Box/>", "<Cone/>", "<Cylinder/>"})
        for (const char* scale : {"1 1 1", "-1 1 1", "-1 -2 -3", "2 -3 1"}) {
            const Scene scene =
                load(bare("<Transform scale='" + std::string(scale) + "' rotation='1 2 3 1'>" +
                          shape(geometry) + "</Transform>"));
            const TriangleMesh& mesh = mesh_of(scene);
            EXPECT_GT(volume(mesh), 0) << geometry << scale;
            for (std::size_t i = 0; i < mesh.normal_triangles.size(); ++i) {
                const Triangle t = mesh.triangle(i);
                EXPECT_GT(
                    dot(mesh.normals[mesh.normal_triangles[i][0]], cross(t.b - t.a, t.c - t.a)), 0);
            }
        }
}

TEST(LoaderSolids, NegativeSizesAreRefusedAndZeroOnesWarnedOf) {
    EXPECT_EQ(refusal(bare(shape("<Box size='1 -1 1'/>"))),
              "scene.x3d: Scene/Shape/Box@size: is negative (line 1)");
    EXPECT_EQ(refusal(bare(shape("<Cone bottomRadius='-1'/>"))),
              "scene.x3d: Scene/Shape/Cone@bottomRadius: is negative (line 1)");
    EXPECT_EQ(refusal(bare(shape("<Cylinder height='-1'/>"))),
              "scene.x3d: Scene/Shape/Cylinder@height: is negative (line 1)");
    const Scene plane = load(bare(shape("<Box size='2 0 2'/>")));
    EXPECT_EQ(plane.warnings,
              std::vector<std::string>{"Box@size: 1 of zero (first at Scene/Shape/Box, line 1)"});
    EXPECT_EQ(mesh_of(plane).bounds(), (Bounds3{{-1, 0, -1}, {1, 0, 1}}));
}

}  // namespace
}  // namespace nuvo
