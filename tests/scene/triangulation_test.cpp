// Concave polygons: convex="false".
#include <array>
#include <cmath>
#include <random>

#include "scene/loading.h"

namespace nuvo {
namespace {

using Polygon = std::vector<std::pair<int, int>>;

std::string face(const std::string& fields, const Polygon& polygon, const std::string& placing) {
    std::string points, index;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        points +=
            std::to_string(polygon[i].first) + " " + std::to_string(polygon[i].second) + " 0 ";
        index += std::to_string(i) + " ";
    }
    return bare("<Transform " + placing + ">" +
                shape("<IndexedFaceSet convex='false' " + fields + " coordIndex='" + index +
                      "-1'><Coordinate point='" + points + "'/></IndexedFaceSet>") +
                "</Transform>");
}

/// Twice the signed area, exact: the coordinates are small integers.
std::int64_t doubled_area(const Polygon& p) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto& [x, y] = p[i];
        const auto& [x2, y2] = p[(i + 1) % p.size()];
        sum += std::int64_t{x} * y2 - std::int64_t{y} * x2;
    }
    return sum;
}

/// The triangles cover the polygon: all turn as it does, and their areas add up to its area. (Each
/// point inside is then covered exactly once, by the polygon's winding number.)
void expect_covered(const TriangleMesh& mesh, const Polygon& polygon) {
    ASSERT_EQ(mesh.triangles.size(), polygon.size() - 2);
    std::int64_t sum = 0;
    for (const IndexTriple& t : mesh.triangles) {
        const std::int64_t area = doubled_area({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
        EXPECT_GE(area, 0);
        sum += area;
    }
    EXPECT_EQ(sum, doubled_area(polygon));
}

TEST(Triangulation, CoversConcavePolygons) {
    const Polygon arrow{{0, 0}, {4, 0}, {4, 4}, {2, 1}};
    const Polygon ell{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const Polygon straight_corners{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}, {0, 2}};
    const Polygon doubled{{0, 0}, {4, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
    // A square with a square hole, joined by a cut that is gone along twice.
    const Polygon keyhole{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                          {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    for (const Polygon& polygon : {arrow, ell, straight_corners, doubled, keyhole}) {
        const Scene scene = load(face("", polygon, ""));
        EXPECT_TRUE(scene.warnings.empty());
        expect_covered(mesh_of(scene), polygon);
    }
}

TEST(Triangulation, CoversRandomStarsFromEveryStartingCorner) {
    const unsigned seed = 20261122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 200; ++round) {
        Polygon star;
        const int corners = 4 + static_cast<int>(random() % 40);
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * 3.14159265358979 * i / corners;
            const double radius = 1000 + static_cast<double>(random() % 9000);
            star.push_back({static_cast<int>(std::lround(radius * std::cos(angle))),
                            static_cast<int>(std::lround(radius * std::sin(angle)))});
        }
        std::rotate(star.begin(), star.begin() + static_cast<long>(random() % star.size()),
                    star.end());
        expect_covered(mesh_of(load(face("", star, ""))), star);
    }
}

TEST(Triangulation, KeepsWindingInEveryPlaneAndUnderMirrors) {
    const Polygon arrow{{0, 0}, {4, 0}, {4, 4}, {2, 1}};
    for (const char* ccw : {"true", "false"})
        for (const char* placing :
             {"", "rotation='1 0 0 2'", "rotation='0 1 0 2'", "rotation='1 1 1 2.0943951'",
              "scale='-1 1 1'", "scale='1e200 1e200 1'", "scale='1e-200 1e-200 1'"}) {
            const std::string fields = std::string("ccw='") + ccw + "'";
            const TriangleMesh cut = mesh_of(load(face(fields, arrow, placing)));
            const TriangleMesh fan = mesh_of(load(face(fields, {{0, 0}, {4, 0}, {4, 4}}, placing)));
            const Triangle f = fan.triangle(0);
            for (std::size_t i = 0; i < cut.triangles.size(); ++i) {
                const Triangle t = cut.triangle(i);
                const Vector3 normal = cross(normalized(t.b - t.a), normalized(t.c - t.a));
                EXPECT_GT(dot(normal, cross(normalized(f.b - f.a), normalized(f.c - f.a))), 0)
                    << placing;
            }
        }
}

TEST(Triangulation, LeavesConvexPolygonsAsFans) {
    const TriangleMesh mesh = mesh_of(load(face("", {{0, 0}, {4, 0}, {5, 3}, {2, 6}, {0, 4}}, "")));
    EXPECT_EQ(mesh.triangles, (std::vector<IndexTriple>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Triangulation, CutsNormalsAndColorsAlike) {
    const Scene scene = load(bare(shape(
        "<IndexedFaceSet convex='false' coordIndex='0 1 2 3' normalIndex='3 2 1 0' "
        "colorIndex='1 2 3 0'><Coordinate point='0 0 0 4 0 0 4 4 0 2 1 0'/>"
        "<Normal vector='3 0 1 2 0 1 1 0 1 0 0 1'/><Color color='0 0 0 0.1 0 0 0.2 0 0 0.3 0 0'/>"
        "</IndexedFaceSet>")));
    const TriangleMesh& mesh = mesh_of(scene);
    for (std::size_t i = 0; i < 2; ++i)
        for (const int c : {0, 1, 2}) {
            const std::uint32_t corner = mesh.triangles[i][c];
            EXPECT_EQ(mesh.normal_triangles[i][c], 3 - corner);
            EXPECT_EQ(mesh.color_triangles[i][c], (corner + 1) % 4);
        }
}

TEST(Triangulation, PolygonsThatCrossThemselvesAreFansWithAWarning) {
    const Scene bow = load(face("", {{0, 0}, {2, 2}, {2, 0}, {0, 2}}, ""));
    EXPECT_EQ(mesh_of(bow).triangles, (std::vector<IndexTriple>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(bow.warnings,
              std::vector<std::string>{
                  "IndexedFaceSet@coordIndex: 1 with a polygon that crosses itself drawn as a fan "
                  "(first at Scene/Transform/Shape/IndexedFaceSet, line 1)"});
}

/// The warnings about one face of these points that claims to be convex.
std::size_t faces_called_concave(const std::string& points, int corners) {
    std::string index;
    for (int i = 0; i < corners; ++i) index += std::to_string(i) + " ";
    const Scene scene =
        load(bare(shape("<IndexedFaceSet coordIndex='" + index + "'><Coordinate point='" + points +
                        "'/></IndexedFaceSet>")));
    const std::string expected =
        "IndexedFaceSet@coordIndex: 1 with a face that is not convex, which is undefined without "
        "convex='false', drawn as a fan (first at Scene/Shape/IndexedFaceSet, line 1)";
    for (const std::string& warning : scene.warnings) EXPECT_EQ(warning, expected);
    return scene.warnings.size();
}

// 19775-1, 13.3.6: with convex TRUE, the default, what comes of a concave face is undefined.
TEST(Triangulation, FacesThatClaimToBeConvexAndAreNotAreWarnedOf) {
    const auto turned = [](const std::vector<std::array<double, 2>>& polygon, int plane) {
        std::string points;
        for (const auto& [x, y] : polygon) {
            const double all[][3] = {{x, y, 5}, {5, x, y}, {y, 5, x}, {x, x, y}, {x + y, y, x - y}};
            for (const double value : all[plane]) points += std::to_string(value) + " ";
        }
        return faces_called_concave(points, static_cast<int>(polygon.size()));
    };
    std::vector<std::array<double, 2>> star, round;
    for (int i = 0; i < 5; ++i)
        star.push_back({std::sin(i * 0.8 * M_PI), std::cos(i * 0.8 * M_PI)});
    for (int i = 0; i < 96; ++i)
        round.push_back({std::sin(i * M_PI / 48), std::cos(i * M_PI / 48)});
    for (int plane = 0; plane < 5; ++plane) {
        EXPECT_EQ(turned({{-2, -1}, {0, 0}, {2, -1}, {0, 2}}, plane), 1u) << plane;  // a dart
        EXPECT_EQ(turned({{0, 0}, {2, 2}, {2, 0}, {0, 2}}, plane), 1u) << plane;     // a bow
        EXPECT_EQ(turned({{0, 0}, {3, 3}, {2, 0}, {0, 2}}, plane), 1u) << plane;
        EXPECT_EQ(turned({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, plane), 1u) << plane;
        EXPECT_EQ(turned(star, plane), 1u) << plane;  // turns left everywhere, twice round
        EXPECT_EQ(turned(round, plane), 0u) << plane;
        EXPECT_EQ(turned({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, plane), 0u) << plane;
        EXPECT_EQ(turned({{0, 0}, {0, 1}, {2, 1}, {2, 0}}, plane), 0u) << plane;
        // Points in the middle of edges, put down to six digits, doubled ones, no area at all.
        EXPECT_EQ(turned({{0, 0}, {1, 0.000001}, {3, 0}, {3, 2}, {0, 2}}, plane), 0u) << plane;
        EXPECT_EQ(turned({{0, 0}, {2, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0}}, plane), 0u) << plane;
        EXPECT_EQ(turned({{0, 0}, {1, 0}, {2, 0}, {1, 0}}, plane), 0u) << plane;
    }
    // Bent quadrilaterals: the saddle is convex as seen along its area vector, the other is not.
    EXPECT_EQ(faces_called_concave("0 0 0 1 0 1 1 1 0 0 1 1", 4), 0u);
    EXPECT_EQ(faces_called_concave("-2 -1 0 0 0 1 2 -1 0 0 2 0", 4), 1u);
}

TEST(Triangulation, CornersTooManyToCutInTimeAreRefused) {
    Polygon comb;
    for (int i = 0; i < 7000; ++i) comb.push_back({i, i % 2 == 0 ? 0 : 5});
    comb.push_back({3500, 9000});
    EXPECT_NE(refusal(face("", comb, "")).find("the limit of 20000000"), std::string::npos);
}

}  // namespace
}  // namespace nuvo
