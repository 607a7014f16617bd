// Color and ColorRGBA, unlit and other materials.
#include "scene/loading.h"

namespace nuvo {
namespace {

using Colors = std::vector<Color>;
using Strings = std::vector<std::string>;

const std::string kSquare = "<Coordinate point='0 0 0, 1 0 0, 1 1 0, 0 1 0'/>";
const std::string kFour = "<Color color='1 0 0 0 1 0 0 0 1 1 1 0'/>";

std::string face_set(const std::string& fields, const std::string& children) {
    return bare(
        shape("<IndexedFaceSet " + fields + ">" + kSquare + children + "</IndexedFaceSet>"));
}

Color color_at(const TriangleMesh& mesh, std::size_t triangle, int corner) {
    const auto& indices = mesh.color_triangles.empty() ? mesh.triangles : mesh.color_triangles;
    return mesh.colors.at(indices.at(triangle)[corner]);
}

TEST(LoaderColors, FollowThePointsUnlessTheyHaveAnIndex) {
    const TriangleMesh by_point = mesh_of(load(face_set("coordIndex='3 2 1 0'", kFour)));
    EXPECT_TRUE(by_point.color_triangles.empty());
    EXPECT_EQ(color_at(by_point, 0, 0), (Color{1, 1, 0}));
    EXPECT_EQ(color_at(by_point, 1, 2), (Color{1, 0, 0}));
    const TriangleMesh by_index =
        mesh_of(load(face_set("coordIndex='0 1 2 -1 0 2 3' colorIndex='3 3 3 -1 0 1 2'", kFour)));
    EXPECT_EQ(color_at(by_index, 0, 2), (Color{1, 1, 0}));
    EXPECT_EQ(color_at(by_index, 1, 1), (Color{0, 1, 0}));
}

TEST(LoaderColors, PerFaceAreCountedByFaceOrByTheirIndex) {
    // The second face has too few corners and is left out, but its color counts.
    const std::string faces = "colorPerVertex='false' coordIndex='0 1 2 -1 0 1 -1 0 2 3' ";
    const TriangleMesh in_order = mesh_of(load(face_set(faces, kFour)));
    EXPECT_EQ(color_at(in_order, 0, 1), (Color{1, 0, 0}));
    EXPECT_EQ(color_at(in_order, 1, 1), (Color{0, 0, 1}));
    const TriangleMesh by_index = mesh_of(load(face_set(faces + "colorIndex='3 2 1'", kFour)));
    EXPECT_EQ(color_at(by_index, 0, 0), (Color{1, 1, 0}));
    EXPECT_EQ(color_at(by_index, 1, 0), (Color{0, 1, 0}));
}

TEST(LoaderColors, WithAlphaAreReadOpaque) {
    const Scene scene =
        load(face_set("coordIndex='0 1 2'", "<ColorRGBA color='1 0 0 1 0 1 0 1 0 0 1 1'/>"));
    EXPECT_EQ(mesh_of(scene).colors, (Colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(load(face_set("coordIndex='0 1 2'", "<ColorRGBA color='1 0 0 1 0 1 0 0.5 0 0 1 1'/>"))
                  .warnings,
              Strings{"ColorRGBA@color: 1 with alpha below 1: drawn opaque (first at "
                      "Scene/Shape/IndexedFaceSet/ColorRGBA, line 1)"});
    EXPECT_EQ(refusal(face_set("coordIndex='0 1 2'", "<ColorRGBA color='1 0 0'/>")),
              "scene.x3d: Scene/Shape/IndexedFaceSet/ColorRGBA@color: 3 numbers are no list of "
              "fours (line 1)");
}

TEST(LoaderColors, TooFewAreRefused) {
    EXPECT_EQ(refusal(face_set("coordIndex='0 1 2'", "<Color color='1 0 0'/>")),
              "scene.x3d: Scene/Shape/IndexedFaceSet@color: entry 1: index 1 of 1 colors (line 1)");
    EXPECT_EQ(refusal(face_set("coordIndex='0 1 2' colorIndex='0 1'", kFour)),
              "scene.x3d: Scene/Shape/IndexedFaceSet@colorIndex: 2 entries, but entry 2 is needed "
              "(line 1)");
    EXPECT_TRUE(mesh_of(load(face_set("coordIndex='0 1 2'", "<Color/>"))).colors.empty());
}

TEST(LoaderColors, OfTrianglesBelongToTheirPoints) {
    const Scene set =
        load(bare(shape("<IndexedTriangleSet index='0 1 2 0 2 3' colorPerVertex='false'>" +
                        kSquare + kFour + "</IndexedTriangleSet>")));
    EXPECT_EQ(color_at(mesh_of(set), 1, 2), (Color{1, 1, 0}));
    EXPECT_EQ(set.warnings,
              Strings{"IndexedTriangleSet@colorPerVertex: 1 of false taken as true, as for all "
                      "sets of triangles (first at Scene/Shape/IndexedTriangleSet, line 1)"});
}

TEST(LoaderColors, OfUnusedPointsAreDropped) {
    const TriangleMesh mesh = mesh_of(load(face_set("coordIndex='0 2 3'", kFour)));
    EXPECT_EQ(mesh.colors, (Colors{{1, 0, 0}, {0, 0, 1}, {1, 1, 0}}));
}

std::string with_material(const std::string& appearance) {
    return bare("<Shape><Appearance>" + appearance + "</Appearance><Sphere/></Shape>");
}

TEST(LoaderMaterials, UnlitOnesShineInTheirEmissiveColor) {
    const Scene scene = load(with_material("<UnlitMaterial emissiveColor='0.1 0.2 0.3'/>"));
    EXPECT_FALSE(scene.materials.at(0).lit);
    EXPECT_EQ(scene.materials.at(0).emissive_color, (Color{0.1, 0.2, 0.3}));
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(load(with_material("<UnlitMaterial/>")).materials.at(0).emissive_color,
              (Color{1, 1, 1}));
    EXPECT_TRUE(load(with_material("<UnlitMaterial transparency='1'/>")).objects.empty());
}

TEST(LoaderMaterials, PhysicalOnesAreDrawnMattWithAWarning) {
    const Scene scene = load(with_material("<PhysicalMaterial baseColor='0.1 0.2 0.3'/>"));
    EXPECT_TRUE(scene.materials.at(0).lit);
    EXPECT_EQ(scene.materials.at(0).diffuse_color, (Color{0.1, 0.2, 0.3}));
    EXPECT_EQ(scene.materials.at(0).specular_color, (Color{0, 0, 0}));
    EXPECT_EQ(scene.warnings,
              Strings{"PhysicalMaterial: 1 drawn as a matt Material of its baseColor (first at "
                      "Scene/Shape/Appearance/PhysicalMaterial, line 1)"});
}

TEST(LoaderMaterials, TheBacksAreNotTaken) {
    const Scene scene = load(
        with_material("<Material containerField='backMaterial' diffuseColor='1 0 0'/><Material/>"));
    EXPECT_EQ(scene.materials.at(0).diffuse_color, (Color{0.8, 0.8, 0.8}));
    EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace nuvo
