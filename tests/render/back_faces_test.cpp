// Of a solid only the front is there, to the camera and to lights: pixels worked out by hand, by
// every tracer.
#include <gtest/gtest.h>

#include <cmath>

#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

constexpr Rgb8 kBlue{0, 0, 255};
constexpr Rgb8 kRed{255, 0, 0};
constexpr Rgb8 kGreen{0, 255, 0};
constexpr Rgb8 kBlack{0, 0, 0};
constexpr Resolution kSize{32, 32};

Image by_octree(const Scene& scene, Profile profile) {
    const Primitives primitives = flatten(scene, profile.leaves);
    return render(scene, primitives, build_tree(scene, primitives, profile), profile, kSize);
}

/// The picture by the exact profile, on which all tracers agree.
Image picture(const std::string& nodes, BackFaces back_faces = BackFaces::kSolid) {
    const Scene scene = x3d::read_text(
        "<X3D version='4.0'><Scene><NavigationInfo headlight='false'/><Background skyColor='0 0 1'"
        "/>" +
            nodes + "</Scene></X3D>",
        "scene");
    Profile profile = exact_profile();
    profile.back_faces = back_faces;
    const Image exact = by_octree(scene, profile);
    const Primitives primitives = flatten(scene, profile.leaves);
    EXPECT_EQ(render_brute_force(scene, primitives, profile, kSize), exact) << nodes;
    FastOptions options;
    options.back_faces = back_faces;
    EXPECT_EQ(FastTracer(scene, primitives, options).render(kSize), exact) << nodes;
    profile.leaves = LeafContent::kShapes;
    EXPECT_EQ(by_octree(scene, profile), exact) << nodes;
    for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
        profile.precision = precision;
        EXPECT_EQ(by_octree(scene, profile).at(16, 16), exact.at(16, 16)) << nodes;
    }
    return exact;
}
Rgb8 middle(const std::string& nodes, BackFaces back_faces = BackFaces::kSolid) {
    return picture(nodes, back_faces).at(kSize.width / 2, kSize.height / 2);
}

std::string glowing(const std::string& color, const std::string& geometry,
                    const std::string& fields = "") {
    return "<Shape " + fields + "><Appearance><Material diffuseColor='0 0 0' emissiveColor='" +
           color + "'/></Appearance>" + geometry + "</Shape>";
}
std::string under(const std::string& fields, const std::string& nodes) {
    return "<Transform " + fields + ">" + nodes + "</Transform>";
}
std::string viewpoint(const std::string& position) {
    return "<Viewpoint position='" + position + "'/>";
}
/// A geometry with a field more.
std::string with(std::string geometry, const std::string& field) {
    return geometry.insert(geometry.find_first_of(" />"), " " + field);
}
/// Two units wide around 0 in the plane z = 0, its front to +z.
std::vector<std::string> squares() {
    const std::string points = "<Coordinate point='-1 -1 0 1 -1 0 1 1 0 -1 1 0'/>";
    return {"<IndexedFaceSet coordIndex='0 1 2 3'>" + points + "</IndexedFaceSet>",
            "<IndexedTriangleSet index='0 1 2 0 2 3'>" + points + "</IndexedTriangleSet>",
            "<TriangleStripSet stripCount='4'><Coordinate point='-1 -1 0 1 -1 0 -1 1 0 1 1 0'/>"
            "</TriangleStripSet>",
            "<IndexedQuadSet index='0 1 2 3'>" + points + "</IndexedQuadSet>"};
}

TEST(BackFaces, OfSolidsAreInvisibleFromWithin) {
    for (const char* geometry :
         {"<Box size='4 4 4'/>", "<Sphere radius='2'/>", "<Cylinder radius='2' height='4'/>",
          "<Cone bottomRadius='4' height='8'/>"})
        for (const char* place : {"", "scale='-1 1 1'", "scale='1 2 3'", "scale='-1 -2 -3'"}) {
            const std::string solid = viewpoint("0 0 0") + under(place, glowing("1 0 0", geometry));
            const std::string open =
                viewpoint("0 0 0") +
                under(place, glowing("1 0 0", with(geometry, "solid='false'")));
            EXPECT_EQ(middle(solid), kBlue) << geometry << place;
            EXPECT_EQ(middle(solid, BackFaces::kDraw), kRed) << geometry << place;
            EXPECT_EQ(middle(open), kRed) << geometry << place;
            EXPECT_EQ(middle(viewpoint("0 0 20") + under(place, glowing("1 0 0", geometry))), kRed)
                << geometry << place;
        }
}

TEST(BackFaces, AreThoseOfTheLocalSystem) {
    for (const std::string& square : squares())
        for (const bool mirrored : {false, true})
            for (const bool clockwise : {false, true})
                for (const bool behind : {false, true}) {
                    const std::string geometry = clockwise ? with(square, "ccw='false'") : square;
                    const std::string nodes =
                        std::string("<Viewpoint position='0 0 ") +
                        (behind ? "-10' orientation='0 1 0 3.14159265358979'/>" : "10'/>") +
                        under(mirrored ? "scale='-1 1 1'" : "", glowing("1 0 0", geometry));
                    EXPECT_EQ(middle(nodes), clockwise != behind ? kBlue : kRed) << nodes;
                    EXPECT_EQ(middle(nodes, BackFaces::kDraw), kRed) << nodes;
                }
}

TEST(BackFaces, OfAHeightFieldAreBelow) {
    const std::string grid =
        glowing("1 0 0",
                "<ElevationGrid xDimension='2' zDimension='2' height='0 0 0 0' xSpacing='2' "
                "zSpacing='2'/>");
    const auto seen = [&](const char* y, const char* angle) {
        return middle(std::string("<Viewpoint position='1 ") + y + " 1' orientation='1 0 0 " +
                      angle + "'/>" + grid);
    };
    EXPECT_EQ(seen("5", "-1.5707963267948966"), kRed);
    EXPECT_EQ(seen("-5", "1.5707963267948966"), kBlue);
}

TEST(BackFaces, ThatCoincideWithAFrontHideNothing) {
    const std::string square = squares().front();
    const std::string nodes = viewpoint("0 0 10") + glowing("1 0 0", with(square, "ccw='false'")) +
                              glowing("0 1 0", square);
    EXPECT_EQ(middle(nodes), kGreen);
    EXPECT_EQ(middle(nodes, BackFaces::kDraw), kRed);  // the first of those at equal distance
}

/// A white floor in the plane z = 0 with a lamp 3 above it, and what is around.
int lit_floor(const std::string& around, BackFaces back_faces = BackFaces::kSolid) {
    const std::string floor =
        "<Shape><Appearance><Material diffuseColor='1 1 1'/></Appearance><IndexedFaceSet "
        "solid='false' coordIndex='0 1 2 3'><Coordinate point='-3 -3 0 3 -3 0 3 3 0 -3 3 0'/>"
        "</IndexedFaceSet></Shape>";
    // Pixel (23, 23) of 32 looks at +-(7.5 / 16) 10 tan(pi / 8) = +-1.942 on both axes.
    return picture(viewpoint("0 0 10") + "<PointLight location='0 0 3'/>" + floor + around,
                   back_faces)
        .at(23, 23)
        .r;
}
const int kLitFloor = static_cast<int>(std::lround(255 * 3 / std::sqrt(9 + 2 * 1.942 * 1.942)));

TEST(BackFaces, OfSolidsAroundALampLetItsLightOut) {
    for (const char* geometry : {"<Sphere radius='0.2'/>", "<Box size='0.4 0.4 0.4'/>",
                                 "<Cylinder radius='0.2' height='0.4'/>"})
        for (const char* place : {"", "scale='-1 1 1'", "scale='1 2 3'", "scale='-1 -2 -3'"}) {
            const auto bulb = [&](const std::string& shape, const std::string& fields = "") {
                return under("translation='0 0 3'", under(place, glowing("1 1 0", shape, fields)));
            };
            EXPECT_NEAR(lit_floor(bulb(geometry)), kLitFloor, 1) << geometry << place;
            EXPECT_EQ(lit_floor(bulb(geometry), BackFaces::kDraw), 0) << geometry << place;
            const std::string open = with(geometry, "solid='false'");
            EXPECT_EQ(lit_floor(bulb(open)), 0) << geometry << place;
            EXPECT_NEAR(lit_floor(bulb(open, "castShadow='false'")), kLitFloor, 1)
                << geometry << place;
            // From outside it is a solid like any other.
            const std::string between =
                under("translation='0.6 -0.6 2' scale='2.5 2.5 1'", glowing("1 1 0", geometry));
            EXPECT_EQ(lit_floor(between), 0) << geometry;
        }
}

TEST(BackFaces, CastNoShadow) {
    for (const std::string& square : squares()) {
        const auto above = [&](const std::string& geometry, const std::string& fields = "") {
            return under("translation='0.6 -0.6 2' scale='0.5 0.5 1'",
                         glowing("0 0 0", geometry, fields));
        };
        EXPECT_EQ(lit_floor(above(square)), 0);  // its front is turned to the lamp
        const std::string turned = with(square, "ccw='false'");
        EXPECT_NEAR(lit_floor(above(turned)), kLitFloor, 1);
        EXPECT_EQ(lit_floor(above(turned), BackFaces::kDraw), 0);
        EXPECT_NEAR(lit_floor(above(square, "castShadow='false'")), kLitFloor, 1);
    }
}

// The sphere's far half is a front to a lamp beyond it, so its near half stays in the sphere's own
// shadow, specular and ambient parts included.
TEST(BackFaces, TheSideOfASolidThatIsTurnedAwayStaysDark) {
    const std::string material =
        "<Appearance><Material diffuseColor='1 1 1' ambientIntensity='1' specularColor='1 1 1' "
        "shininess='0'/></Appearance>";
    for (const char* geometry : {"<Sphere/>", "<Box size='2 2 2'/>"})
        for (const char* light : {"<PointLight location='0 0 -5' ambientIntensity='1'/>",
                                  "<DirectionalLight direction='0 0 1' ambientIntensity='1'/>"})
            EXPECT_EQ(
                middle(viewpoint("0 0 10") + light + "<Shape>" + material + geometry + "</Shape>"),
                kBlack);
}

// A light grazes faces of an octahedron: exactly, or turned with it, so that rounded corners
// bend the faces to or from it. Whatever rounds their points, a face is lit as if it stood alone,
// or in the shadow of its neighbours.
TEST(BackFaces, OfAnOctahedronThatALightGrazesAreLitAllOrNone) {
    const auto picture_of = [](const std::string& turned, const std::string& index) {
        return picture(viewpoint("1.5 0.1 4") +
                       under(turned,
                             "<DirectionalLight direction='1 0 -1'/><Shape>"
                             "<Appearance><Material diffuseColor='1 1 1'/></Appearance>"
                             "<IndexedTriangleSet index='" +
                                 index +
                                 "'><Coordinate point='1 0 0 0 0 1 -1 0 0 0 1 0 0 -1 0 "
                                 "0 0 -1'/><Normal vector='1 0 0 0 0 1 -1 0 0 0 1 0 0 "
                                 "-1 0 0 0 -1'/></IndexedTriangleSet></Shape>"));
    };
    const std::vector<std::string> grazed = {"0 1 4", "3 1 0"};
    const std::string others = " 2 4 1 1 3 2 0 5 4 3 5 0 5 4 2 5 2 3";
    int dark_faces = 0;
    int lit_faces = 0;
    for (const char* turned :
         {"", "rotation='0.3 0.5 0.8 0.7'", "rotation='0 1 0 0.1'", "rotation='1 2 -1 0.3'"}) {
        std::string all = others;
        for (const std::string& face : grazed) all += " " + face;
        const Image solid = picture_of(turned, all);
        for (const std::string& face : grazed) {
            const Image alone = picture_of(turned, face);
            int dark = 0;
            int lit = 0;
            for (int y = 0; y < kSize.height; ++y)
                for (int x = 0; x < kSize.width; ++x) {
                    const Rgb8 color = alone.at(x, y);
                    if (color == kBlue || color == kBlack) continue;
                    const Rgb8 found = solid.at(x, y);
                    dark += found == kBlack;
                    lit += found == color;
                    EXPECT_TRUE(found == kBlack || found == color) << x << ' ' << y;
                }
            EXPECT_TRUE(dark == 0 || lit == 0) << turned << face << dark << ' ' << lit;
            if (dark + lit == 0) continue;
            if (turned == std::string()) {
                EXPECT_EQ(lit, 0) << "edges belong to what they bound";
            }
            (dark > 0 ? dark_faces : lit_faces) += 1;
        }
    }
    EXPECT_GT(dark_faces, 2);
    EXPECT_GT(lit_faces, 0);
}

// Seen from above through the top, the floor of a box that is wound inwards is lit by a lamp above.
TEST(BackFaces, OfABoxWoundInwardsShowItsLitInside) {
    const Image image = picture(
        "<PointLight location='0 3 2'/><Viewpoint position='0 4 4' orientation='1 0 0 -0.7854'/>"
        "<Shape><Appearance><Material diffuseColor='1 1 1'/></Appearance><IndexedFaceSet "
        "coordIndex='0 1 2 3 -1 4 7 6 5 -1 0 4 5 1 -1 1 5 6 2 -1 2 6 7 3 -1 3 7 4 0 -1'>"
        "<Coordinate point='-1 1 1 -1 1 -1 1 1 -1 1 1 1 -1 -1 1 -1 -1 -1 1 -1 -1 1 -1 1'/>"
        "</IndexedFaceSet></Shape>");
    // The middle meets the back wall, or the floor near it, at about (0, -1, -1).
    EXPECT_NEAR(image.at(16, 16).r, 204, 15);
}

}  // namespace
}  // namespace nuvo
