// Shading normals: given and generated.
#include <cmath>

#include "scene/loading.h"

namespace nuvo {
namespace {

// A square in the plane y = 0 and a triangle in the plane x = 0, meeting at a right angle along the
// edge from (0,0,0) to (0,0,1). Their normals are +y and +x.
const std::string kFold = "<Coordinate point='0 0 0 0 0 1 1 0 1 1 0 0 0 1 0'/>";
const std::string kFoldIndex = "coordIndex='0 1 2 3 -1 0 4 1 -1'";
const Vector3 kX{1, 0, 0};
const Vector3 kY{0, 1, 0};
const Vector3 kBetween{std::sqrt(0.5), std::sqrt(0.5), 0};

std::string face_set(const std::string& fields, const std::string& children) {
    return shape("<IndexedFaceSet " + fields + ">" + children + "</IndexedFaceSet>");
}

std::string triangle_set(const std::string& fields, const std::string& children) {
    return shape("<IndexedTriangleSet " + fields + ">" + children + "</IndexedTriangleSet>");
}

/// The normal at corner 0..2 of a triangle.
Vector3 normal_at(const TriangleMesh& mesh, std::size_t triangle, int corner) {
    const auto& indices = mesh.normal_triangles.empty() ? mesh.triangles : mesh.normal_triangles;
    return mesh.normals.at(indices.at(triangle)[corner]);
}

TriangleMesh mesh_from(const std::string& nodes) { return mesh_of(load(bare(nodes))); }

TEST(LoaderNormals, AFaceSetIsFlatByDefault) {
    EXPECT_TRUE(mesh_from(face_set(kFoldIndex, kFold)).normals.empty());
    EXPECT_TRUE(mesh_from(face_set("creaseAngle='0' " + kFoldIndex, kFold)).normals.empty());
    EXPECT_TRUE(mesh_from(face_set("normalPerVertex='false' creaseAngle='4' " + kFoldIndex, kFold))
                    .normals.empty());
}

TEST(LoaderNormals, FacesThatMeetBelowTheCreaseAngleShareANormal) {
    for (const char* crease : {"1.6", "3", "3.2", "4.0000"}) {
        const TriangleMesh mesh =
            mesh_from(face_set("creaseAngle='" + std::string(crease) + "' " + kFoldIndex, kFold));
        // Triangles: (0,1,2), (0,2,3) of the square, (0,4,1).
        expect_near(normal_at(mesh, 0, 0), kBetween);
        expect_near(normal_at(mesh, 0, 1), kBetween);
        expect_near(normal_at(mesh, 0, 2), kY);
        // The square counts once at point 0, although two triangles of its fan meet there.
        expect_near(normal_at(mesh, 1, 0), kBetween);
        expect_near(normal_at(mesh, 1, 2), kY);
        expect_near(normal_at(mesh, 2, 0), kBetween);
        expect_near(normal_at(mesh, 2, 1), kX);
        expect_near(normal_at(mesh, 2, 2), kBetween);
    }
}

TEST(LoaderNormals, FacesThatMeetAboveTheCreaseAngleKeepTheirOwn) {
    const TriangleMesh mesh = mesh_from(face_set("creaseAngle='1.5' " + kFoldIndex, kFold));
    for (const int corner : {0, 1, 2}) {
        EXPECT_EQ(normal_at(mesh, 0, corner), kY);
        EXPECT_EQ(normal_at(mesh, 1, corner), kY);
        EXPECT_EQ(normal_at(mesh, 2, corner), kX);
    }
}

TEST(LoaderNormals, AnAverageIsNotWeightedByArea) {
    const std::string points = "<Coordinate point='0 0 0 0 0 1 50 0 0 0 0.01 0'/>";
    const TriangleMesh mesh =
        mesh_from(face_set("creaseAngle='4' coordIndex='0 1 2 -1 0 3 1'", points));
    expect_near(normal_at(mesh, 0, 0), kBetween);
}

TEST(LoaderNormals, ClockwiseFacesGenerateNormalsOnTheirOtherSide) {
    for (const char* crease : {"1.6", "4"}) {
        const TriangleMesh mesh = mesh_from(
            face_set("ccw='false' creaseAngle='" + std::string(crease) + "' " + kFoldIndex, kFold));
        expect_near(normal_at(mesh, 0, 0), -kBetween);
        const Triangle t = mesh.triangle(0);
        EXPECT_LT(cross(t.b - t.a, t.c - t.a).y, 0);
    }
}

TEST(LoaderNormals, NormalsThatCancelOutFallBackToTheFaces) {
    // One triangle from both sides.
    const TriangleMesh mesh = mesh_from(face_set("creaseAngle='4' coordIndex='0 1 2 -1 2 1 0'",
                                                 "<Coordinate point='0 0 0 0 0 1 1 0 0'/>"));
    for (const int corner : {0, 1, 2}) {
        EXPECT_EQ(normal_at(mesh, 0, corner), kY);
        EXPECT_EQ(normal_at(mesh, 1, corner), -kY);
    }
}

TEST(LoaderNormals, IndexedTrianglesAreSmoothByDefaultAndFlatPerFace) {
    const std::string index = "index='0 1 2 0 4 1'";
    const TriangleMesh smooth = mesh_from(triangle_set(index, kFold));
    expect_near(normal_at(smooth, 0, 0), kBetween);
    expect_near(normal_at(smooth, 0, 1), kBetween);
    EXPECT_EQ(normal_at(smooth, 0, 2), kY);
    EXPECT_EQ(normal_at(smooth, 1, 1), kX);
    EXPECT_TRUE(smooth.normal_triangles.empty());
    EXPECT_TRUE(mesh_from(triangle_set("normalPerVertex='false' " + index, kFold)).normals.empty());
}

TEST(LoaderNormals, TriangleSetsWithoutNormalsAreFlat) {
    EXPECT_TRUE(
        mesh_from(shape("<TriangleSet><Coordinate point='0 0 0 0 0 1 1 0 0'/></TriangleSet>"))
            .normals.empty());
}

TEST(LoaderNormals, GivenNormalsFollowTheirIndex) {
    const std::string normals = "<Normal vector='1 0 0 0 1 0 0 0 1'/>";
    const std::string triangle = "<Coordinate point='0 0 0 0 0 1 1 0 0'/>";
    const TriangleMesh by_point = mesh_from(face_set("coordIndex='2 0 1'", triangle + normals));
    EXPECT_EQ(normal_at(by_point, 0, 0), (Vector3{0, 0, 1}));
    EXPECT_EQ(normal_at(by_point, 0, 1), kX);
    const TriangleMesh by_index = mesh_from(face_set(
        "coordIndex='2 0 1 -1 0 1 2 -1' normalIndex='0 0 1 -1 2 1 0'", triangle + normals));
    EXPECT_EQ(normal_at(by_index, 0, 1), kX);
    EXPECT_EQ(normal_at(by_index, 0, 2), kY);
    EXPECT_EQ(normal_at(by_index, 1, 0), (Vector3{0, 0, 1}));
    const TriangleMesh set =
        mesh_from(shape("<TriangleSet>" + triangle + normals + "</TriangleSet>"));
    EXPECT_EQ(normal_at(set, 0, 2), (Vector3{0, 0, 1}));
}

TEST(LoaderNormals, GivenNormalsPerFaceAreCountedByFace) {
    const std::string normals = "<Normal vector='1 0 0 0 1 0 0 0 1'/>";
    // The second face is too short to draw but has its normal.
    const std::string fields = "normalPerVertex='false' coordIndex='0 1 2 3 -1 0 1 -1 0 4 1' ";
    const TriangleMesh by_order = mesh_from(face_set(fields, kFold + normals));
    EXPECT_EQ(normal_at(by_order, 0, 0), kX);
    EXPECT_EQ(normal_at(by_order, 1, 2), kX);
    EXPECT_EQ(normal_at(by_order, 2, 0), (Vector3{0, 0, 1}));
    const TriangleMesh by_index =
        mesh_from(face_set(fields + "normalIndex='2 0 1'", kFold + normals));
    EXPECT_EQ(normal_at(by_index, 1, 0), (Vector3{0, 0, 1}));
    EXPECT_EQ(normal_at(by_index, 2, 0), kY);
    const TriangleMesh triangles =
        mesh_from(triangle_set("normalPerVertex='false' index='0 1 2 0 4 1'", kFold + normals));
    EXPECT_EQ(normal_at(triangles, 1, 2), kY);
}

TEST(LoaderNormals, GivenNormalsAreNotTurnedByCcw) {
    const TriangleMesh mesh = mesh_from(
        face_set("ccw='false' coordIndex='0 1 2'",
                 "<Coordinate point='0 0 0 0 0 1 1 0 0'/><Normal vector='0 1 0 1 0 0 0 0 1'/>"));
    // The winding is swapped, and each corner keeps its normal.
    EXPECT_EQ(mesh.triangles.at(0), (IndexTriple{0, 2, 1}));
    EXPECT_EQ(normal_at(mesh, 0, 0), kY);
    EXPECT_EQ(normal_at(mesh, 0, 1), (Vector3{0, 0, 1}));
    EXPECT_EQ(normal_at(mesh, 0, 2), kX);
}

TEST(LoaderNormals, TransformByTheInverseTranspose) {
    const std::string geometry =
        face_set("coordIndex='0 1 2'",
                 "<Coordinate point='0 0 0 1 0 1 0 1 0'/><Normal vector='1 1 0 1 0 0 0 0 -3'/>");
    const TriangleMesh stretched =
        mesh_from("<Transform scale='2 1 1'>" + geometry + "</Transform>");
    expect_near(normal_at(stretched, 0, 0), normalized(Vector3{0.5, 1, 0}));
    EXPECT_EQ(normal_at(stretched, 0, 1), kX);
    EXPECT_EQ(normal_at(stretched, 0, 2), (Vector3{0, 0, -1}));
    // A mirror moves a normal as it moves the surface: x to -x. The corners are swapped.
    const TriangleMesh mirrored =
        mesh_from("<Transform scale='-1 1 1'>" + geometry + "</Transform>");
    expect_near(normal_at(mirrored, 0, 0), normalized(Vector3{-1, 1, 0}));
    EXPECT_EQ(normal_at(mirrored, 0, 2), -kX);
    const TriangleMesh tiny =
        mesh_from("<Transform scale='1e-200 1e-200 2e-200'>" + geometry + "</Transform>");
    EXPECT_EQ(normal_at(tiny, 0, 2), (Vector3{0, 0, -1}));
}

TEST(LoaderNormals, GeneratedNormalsAgreeWithTheGeometricNormalUnderMirrors) {
    for (const char* scale : {"1 1 1", "-1 1 1", "-1 -1 -1", "1 -2 3"})
        for (const char* ccw : {"true", "false"}) {
            const TriangleMesh mesh = mesh_from(
                "<Transform scale='" + std::string(scale) + "' rotation='1 2 3 1'>" +
                face_set("ccw='" + std::string(ccw) + "' creaseAngle='1.5' " + kFoldIndex, kFold) +
                "</Transform>");
            for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
                const Triangle t = mesh.triangle(i);
                expect_near(normal_at(mesh, i, 0), normalized(cross(t.b - t.a, t.c - t.a)), 1e-12);
            }
        }
}

TEST(LoaderNormals, TooFewNormalsAreRefused) {
    const std::string triangle = "<Coordinate point='0 0 0 0 0 1 1 0 0'/>";
    const std::string place = "scene.x3d: Scene/Shape/IndexedFaceSet@";
    EXPECT_EQ(
        refusal(bare(face_set("coordIndex='0 1 2'", triangle + "<Normal vector='1 0 0 1 0 0'/>"))),
        place + "normal: entry 2: index 2 of 2 normals (line 1)");
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1 2' normalIndex='0 0 7'",
                                    triangle + "<Normal vector='1 0 0 1 0 0'/>"))),
              place + "normalIndex: entry 2: index 7 of 2 normals (line 1)");
    EXPECT_EQ(refusal(bare(face_set("coordIndex='0 1 2' normalIndex='0 0'",
                                    triangle + "<Normal vector='1 0 0 1 0 0'/>"))),
              place + "normalIndex: 2 entries, but entry 2 is needed (line 1)");
}

TEST(LoaderNormals, AnEmptyNormalNodeCountsAsNone) {
    EXPECT_TRUE(mesh_from(face_set("coordIndex='0 1 2'",
                                   "<Coordinate point='0 0 0 0 0 1 1 0 0'/><Normal/>"))
                    .normals.empty());
}

}  // namespace
}  // namespace nuvo
