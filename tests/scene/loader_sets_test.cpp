// Strips, fans, quadrilaterals and grids of heights.
#include "scene/loading.h"

namespace nuvo {
namespace {

using Triples = std::vector<IndexTriple>;
using Strings = std::vector<std::string>;

const std::string kSix = "<Coordinate point='0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0'/>";

std::string node(const std::string& kind, const std::string& fields,
                 const std::string& children = kSix) {
    return bare(shape("<" + kind + " " + fields + ">" + children + "</" + kind + ">"));
}

TEST(LoaderSets, EverySecondTriangleOfAStripIsTurned) {
    const Triples expected{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    EXPECT_EQ(mesh_of(load(node("IndexedTriangleStripSet", "index='0 1 2 3 4 5'"))).triangles,
              expected);
    EXPECT_EQ(mesh_of(load(node("TriangleStripSet", "stripCount='6'"))).triangles, expected);
    // So all of them are seen from one side.
    const TriangleMesh mesh = mesh_of(load(node("TriangleStripSet", "stripCount='6'")));
    for (std::size_t i = 0; i < 4; ++i) {
        const Triangle t = mesh.triangle(i);
        EXPECT_GT(cross(t.b - t.a, t.c - t.a).z, 0);
    }
}

TEST(LoaderSets, AFansTrianglesShareItsFirstPoint) {
    const Triples expected{{0, 1, 3}, {0, 3, 2}};
    EXPECT_EQ(mesh_of(load(node("IndexedTriangleFanSet", "index='0 1 3 2'"))).triangles, expected);
    EXPECT_EQ(mesh_of(load(node("TriangleFanSet", "fanCount='4'",
                                "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0'/>")))
                  .triangles,
              (Triples{{0, 1, 2}, {0, 2, 3}}));
}

TEST(LoaderSets, MinusOneEndsARunAndCountsFollowEachOther) {
    EXPECT_EQ(
        mesh_of(load(node("IndexedTriangleStripSet", "index='0 1 2 -1 2 3 4 5 -1'"))).triangles,
        (Triples{{0, 1, 2}, {2, 3, 4}, {4, 3, 5}}));
    EXPECT_EQ(mesh_of(load(node("TriangleStripSet", "stripCount='3 3'"))).triangles,
              (Triples{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(mesh_of(load(node("TriangleFanSet", "fanCount='3 3'"))).triangles,
              (Triples{{0, 1, 2}, {3, 4, 5}}));
}

TEST(LoaderSets, RunsThatDoNotFitAreWarnedOfOrRefused) {
    const Scene shorts = load(node("IndexedTriangleFanSet", "index='0 1 -1 0 1 2 -1'"));
    EXPECT_EQ(mesh_of(shorts).triangles, (Triples{{0, 1, 2}}));
    EXPECT_EQ(shorts.warnings,
              Strings{"IndexedTriangleFanSet@index: 1 with fewer than three corners left out "
                      "(first at Scene/Shape/IndexedTriangleFanSet, line 1)"});
    EXPECT_EQ(load(node("TriangleFanSet", "fanCount='4'")).warnings,
              Strings{"TriangleFanSet@fanCount: 1 leaving points over (first at "
                      "Scene/Shape/TriangleFanSet, line 1)"});
    EXPECT_EQ(refusal(node("TriangleStripSet", "stripCount='4 3'")),
              "scene.x3d: Scene/Shape/TriangleStripSet@stripCount: takes 3 of 2 points that are "
              "left (line 1)");
    EXPECT_EQ(refusal(node("TriangleStripSet", "stripCount='-1'")),
              "scene.x3d: Scene/Shape/TriangleStripSet@stripCount: takes -1 of 6 points that are "
              "left (line 1)");
    EXPECT_EQ(refusal(node("IndexedTriangleStripSet", "index='0 1 6'")),
              "scene.x3d: Scene/Shape/IndexedTriangleStripSet@index: entry 2: index 6 of 6 points "
              "(line 1)");
}

// Two triangles that meet at a right angle: normals +z and +y, smooth by default.
TEST(LoaderSets, StripsAndFansAreSmoothUnlessTheyAreFlat) {
    const std::string fold = "<Coordinate point='0 0 0 1 0 0 0 1 0 1 0 1'/>";
    for (const char* kind : {"IndexedTriangleStripSet", "IndexedTriangleFanSet"}) {
        const std::string index = kind[15] == 'S' ? "index='2 0 1 3'" : "index='0 1 2 -1 0 3 1'";
        const TriangleMesh smooth = mesh_of(load(node(kind, index, fold)));
        expect_near(smooth.normals.at(0), normalized(Vector3{0, 1, 1}));
        expect_near(smooth.normals.at(2), {0, 0, 1});
        expect_near(smooth.normals.at(3), {0, 1, 0});
        EXPECT_TRUE(
            mesh_of(load(node(kind, "normalPerVertex='false' " + index, fold))).normals.empty());
    }
}

TEST(LoaderSets, QuadrilateralsTakeFourPointsOrIndicesEach) {
    EXPECT_EQ(mesh_of(load(node("IndexedQuadSet", "index='0 1 3 2 2 3 5 4'"))).triangles,
              (Triples{{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}));
    const Scene quads = load(node("QuadSet", ""));
    EXPECT_EQ(mesh_of(quads).triangles, (Triples{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(quads.warnings, Strings{"QuadSet@coord: 1 with an incomplete last quadrilateral "
                                      "(first at Scene/Shape/QuadSet, line 1)"});
}

TEST(LoaderSets, AnElevationGridIsSeenFromAboveRowsAlongX) {
    const TriangleMesh grid = mesh_of(load(
        node("ElevationGrid",
             "xDimension='3' zDimension='2' xSpacing='2' zSpacing='5' height='0 1 2 3 4 5'", "")));
    EXPECT_EQ(
        grid.positions,
        (std::vector<Point3>{{0, 0, 0}, {2, 1, 0}, {4, 2, 0}, {0, 3, 5}, {2, 4, 5}, {4, 5, 5}}));
    EXPECT_EQ(grid.triangles, (Triples{{0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}}));
    for (std::size_t i = 0; i < 4; ++i) {
        const Triangle t = grid.triangle(i);
        EXPECT_GT(cross(t.b - t.a, t.c - t.a).y, 0);
    }
    EXPECT_TRUE(grid.normals.empty());  // creaseAngle 0: flat
}

TEST(LoaderSets, AnElevationGridCountsEachQuadrilateralOnceInItsNormals) {
    // A roof along z: the quadrilaterals' normals are (-1, 1, 0) and (1, 1, 0), the ridge's +y.
    const TriangleMesh roof = mesh_of(
        load(node("ElevationGrid",
                  "xDimension='3' zDimension='2' creaseAngle='3' height='0 1 0 0 1 0'", "")));
    ASSERT_EQ(roof.triangles[0][0], 0u);
    const auto normal = [&](std::size_t triangle, int corner) {
        return roof.normals.at(roof.normal_triangles.at(triangle)[corner]);
    };
    expect_near(normal(0, 0), normalized(Vector3{-1, 1, 0}));
    expect_near(normal(1, 2), {0, 1, 0});  // point 1, on the ridge
    expect_near(normal(2, 0), {0, 1, 0});
    expect_near(normal(3, 2), normalized(Vector3{1, 1, 0}));
}

TEST(LoaderSets, AnElevationGridsNormalsAndColorsArePerPointOrPerQuadrilateral) {
    const std::string grid = "xDimension='3' zDimension='2' height='0 0 0 0 0 0' ";
    const TriangleMesh faces =
        mesh_of(load(node("ElevationGrid", grid + "normalPerVertex='false' colorPerVertex='false'",
                          "<Normal vector='0 1 0 1 0 0'/><Color color='1 0 0 0 0 1'/>")));
    EXPECT_EQ(faces.normals[faces.normal_triangles[3][0]], (Vector3{1, 0, 0}));
    EXPECT_EQ(faces.colors[faces.color_triangles[1][2]], (Color{1, 0, 0}));
    EXPECT_EQ(faces.colors[faces.color_triangles[2][0]], (Color{0, 0, 1}));
    const TriangleMesh points = mesh_of(
        load(node("ElevationGrid", grid, "<Color color='1 0 0 0 1 0 0 0 1 1 1 0 0 1 1 1 0 1'/>")));
    EXPECT_EQ(points.colors.at(5), (Color{1, 0, 1}));
    EXPECT_TRUE(points.color_triangles.empty());
}

TEST(LoaderSets, AnElevationGridOfTheWrongSizeIsRefused) {
    const std::string place = "scene.x3d: Scene/Shape/ElevationGrid@";
    EXPECT_EQ(refusal(node("ElevationGrid", "xDimension='3' zDimension='2' height='1 2'", "")),
              place + "height: 2 numbers where 6 belong (line 1)");
    EXPECT_EQ(refusal(node("ElevationGrid",
                           "xDimension='2147483647' zDimension='2147483647' height='1 2'", "")),
              place + "height: 2 numbers where 4611686014132420609 belong (line 1)");
    EXPECT_EQ(refusal(node("ElevationGrid", "xDimension='-3'", "")),
              place + "xDimension: is negative (line 1)");
    EXPECT_EQ(load(node("ElevationGrid", "", "")).warnings,
              Strings{"ElevationGrid: 1 without triangles not drawn (first at "
                      "Scene/Shape/ElevationGrid, line 1)"});
}

}  // namespace
}  // namespace nuvo
