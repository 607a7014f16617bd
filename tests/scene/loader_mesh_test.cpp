// Geometry nodes as triangles: indices, winding, order.
#include "scene/loading.h"

namespace nuvo {
namespace {

const std::string kSquare = "<Coordinate point='0 0 0, 1 0 0, 1 1 0, 0 1 0'/>";

std::string face_set(const std::string& fields, const std::string& children = kSquare) {
    return shape("<IndexedFaceSet " + fields + ">" + children + "</IndexedFaceSet>");
}

std::vector<IndexTriple> triangles_of(const std::string& nodes) {
    return mesh_of(load(bare(nodes))).triangles;
}

using Triples = std::vector<IndexTriple>;

TEST(LoaderMesh, PolygonsBecomeFans) {
    EXPECT_EQ(triangles_of(face_set("coordIndex='0 1 2 3 -1'")), (Triples{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangles_of(face_set("coordIndex='1 2 3 -1 3 0 1'")),
              (Triples{{1, 2, 3}, {3, 0, 1}}));
    EXPECT_EQ(triangles_of(face_set("coordIndex='0 1 2 -1, -1 2 3 0 -1'")),
              (Triples{{0, 1, 2}, {2, 3, 0}}));
}

TEST(LoaderMesh, FacesOfFewerThanThreeCornersAreLeftOutWithAWarning) {
    const Scene scene = load(bare(face_set("coordIndex='0 1 -1 2 -1 0 1 2 -1'")));
    EXPECT_EQ(mesh_of(scene).triangles, (Triples{{0, 1, 2}}));
    EXPECT_EQ(
        scene.warnings,
        std::vector<std::string>{"IndexedFaceSet@coordIndex: 2 with a face of fewer than three "
                                 "corners left out (first at Scene/Shape/IndexedFaceSet, line 1)"});
}

TEST(LoaderMesh, ZeroAreaTrianglesKeepTheirPlace) {
    const TriangleMesh mesh = mesh_of(load(bare(face_set("coordIndex='0 0 1 -1 0 1 2 3 -1'"))));
    EXPECT_EQ(mesh.triangles, (Triples{{0, 0, 1}, {0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(has_zero_area(mesh.triangle(0)));
    EXPECT_FALSE(has_zero_area(mesh.triangle(1)));
}

TEST(LoaderMesh, TriangleSetsTakeThreePointsOrIndicesEach) {
    const std::string five = "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0 5 5 5'/>";
    const Scene set = load(bare(shape("<TriangleSet>" + five + "</TriangleSet>")));
    EXPECT_EQ(mesh_of(set).triangles, (Triples{{0, 1, 2}}));
    EXPECT_EQ(mesh_of(set).positions, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
    EXPECT_EQ(set.warnings.size(), 1u);
    const Scene indexed = load(
        bare(shape("<IndexedTriangleSet index='2 1 0 3 2 1 0'>" + five + "</IndexedTriangleSet>")));
    EXPECT_EQ(mesh_of(indexed).triangles, (Triples{{2, 1, 0}, {3, 2, 1}}));
    EXPECT_EQ(indexed.warnings.size(), 1u);
}

TEST(LoaderMesh, PointsThatNoTriangleUsesAreDropped) {
    const TriangleMesh mesh = mesh_of(load(bare(shape(
        "<IndexedTriangleSet index='4 2 1'><Coordinate point='9 9 9 1 0 0 2 0 0 9 9 9 4 1 0'/>"
        "<Normal vector='0 0 9 0 0 1 0 1 0 0 0 9 1 0 0'/></IndexedTriangleSet>"))));
    EXPECT_EQ(mesh.positions, (std::vector<Point3>{{1, 0, 0}, {2, 0, 0}, {4, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (Triples{{2, 1, 0}}));
    EXPECT_EQ(mesh.normals, (std::vector<Vector3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
    EXPECT_TRUE(mesh.normal_triangles.empty());
    EXPECT_EQ(mesh.bounds(), (Bounds3{{1, 0, 0}, {4, 1, 0}}));
}

Vector3 geometric_normal(const std::string& nodes) {
    const Triangle t = mesh_of(load(bare(nodes))).triangle(0);
    return normalized(cross(t.b - t.a, t.c - t.a));
}

TEST(LoaderMesh, CornersTurnCounterclockwiseAroundTheGeometricNormal) {
    const std::string front = face_set("coordIndex='0 1 2 3'");
    const std::string back = face_set("ccw='false' coordIndex='0 1 2 3'");
    const auto mirrored = [](const std::string& nodes) {
        return "<Transform scale='1 -2 1'>" + nodes + "</Transform>";
    };
    EXPECT_EQ(geometric_normal(front), (Vector3{0, 0, 1}));
    EXPECT_EQ(geometric_normal(back), (Vector3{0, 0, -1}));
    // A mirror in y leaves the front of a face in the plane z = 0 in front.
    EXPECT_EQ(geometric_normal(mirrored(front)), (Vector3{0, 0, 1}));
    EXPECT_EQ(geometric_normal(mirrored(back)), (Vector3{0, 0, -1}));
    EXPECT_EQ(geometric_normal(mirrored(mirrored(front))), (Vector3{0, 0, 1}));
    // Three negative scales turn the front to -z.
    EXPECT_EQ(geometric_normal("<Transform scale='-1 -1 -1'>" + front + "</Transform>"),
              (Vector3{0, 0, -1}));
}

TEST(LoaderMesh, SwappedTrianglesKeepTheirIndex) {
    EXPECT_EQ(triangles_of(face_set("ccw='false' coordIndex='0 1 2 3'")),
              (Triples{{0, 2, 1}, {0, 3, 2}}));
}

TEST(LoaderMesh, SolidIsKept) {
    EXPECT_TRUE(load(bare(face_set("coordIndex='0 1 2'"))).objects.at(0).solid);
    EXPECT_FALSE(load(bare(face_set("solid='false' coordIndex='0 1 2'"))).objects.at(0).solid);
}

TEST(LoaderMesh, IndicesOutOfRangeAreRefused) {
    const std::string place = "scene.x3d: Scene/Shape/IndexedFaceSet@coordIndex: ";
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1 4'"))),
              place + "entry 2: index 4 of 4 points (line 1)");
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 -2 1'"))),
              place + "entry 1: index -2 of 4 points (line 1)");
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1 2147483648'"))),
              place + "\"2147483648\" is beyond 32-bit integers (line 1)");
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1.5 2'"))),
              place + "\"1.5\" is not an integer (line 1)");
    EXPECT_EQ(refusal(bare(shape("<IndexedTriangleSet index='0 1 -1'>" + kSquare +
                                 "</IndexedTriangleSet>"))),
              "scene.x3d: Scene/Shape/IndexedTriangleSet@index: entry 2: index -1 of 4 points "
              "(line 1)");
}

TEST(LoaderMesh, NotANumberAmongThePointsIsRefused) {
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1 2'", "<Coordinate point='0 0 nan'/>"))),
              "scene.x3d: Scene/Shape/IndexedFaceSet/Coordinate@point: \"nan\" is not a number "
              "(line 1)");
}

TEST(LoaderMesh, WithoutPointsOrTrianglesNothingIsDrawnButTheShapeCounts) {
    const Scene scene = load(
        bare(face_set("coordIndex='0 1 2'", "") + face_set("") + face_set("coordIndex='0 1 2'")));
    EXPECT_EQ(scene.shape_count, 3u);
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].shape_index, 2u);
    EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST(LoaderMesh, VerticesAreLimitedAtTheLimitUsesCounted) {
    // A set of 3 points, used 4 times.
    const std::string nodes = "<Group DEF='g'>" +
                              shape(
                                  "<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0'/>"
                                  "</TriangleSet>") +
                              "</Group>" + repeated("<Group USE='g'/>", 3);
    x3d::Limits limits;
    limits.vertices = 13;
    EXPECT_EQ(refusal(bare(nodes), limits), "");
    limits.vertices = 12;
    EXPECT_EQ(refusal(bare(nodes), limits), "");
    limits.vertices = 11;
    EXPECT_EQ(
        refusal(bare(nodes), limits),
        "scene.x3d: Scene/Group[1]/Shape/TriangleSet/Coordinate: the scene's meshes and round "
        "solids exceed the limit of 11 points, indices, normals and colors (--max-vertices) "
        "(line 1)");
}

}  // namespace
}  // namespace nuvo
