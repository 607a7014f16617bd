// Features of X3D as pixels that are worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

/// The camera stands at (0, 0, 10) and looks along -z; at z = 0 the picture is 10 units high and
/// wide, so pixel (x, y) of 100 x 100 looks at ((x + 0.5) / 10 - 5, 5 - (y + 0.5) / 10, 0).
const std::string kCamera = "<Viewpoint position='0 0 10' fieldOfView='0.9272952180016122'/>";

class Picture {
  public:
    explicit Picture(const std::string& nodes, const std::string& version = "3.3",
                     Precision precision = Precision::kExact) {
        const Scene scene = x3d::read_text(
            "<X3D version='" + version + "'><Scene>" + kCamera + nodes + "</Scene></X3D>", "scene");
        Profile profile = exact_profile();
        profile.type = OctreeType::kUniform;
        profile.precision = precision;
        const Primitives primitives = flatten(scene, profile.leaves);
        const Octree octree = build_tree(scene, primitives, profile);
        image_ = render(scene, primitives, octree, profile, {100, 100});
    }
    /// The pixel that looks at (x, y, 0).
    Rgb8 at(double x, double y) const {
        return image_.at(static_cast<int>(std::floor((x + 5) * 10)),
                         static_cast<int>(std::floor((5 - y) * 10)));
    }

  private:
    Image image_;
};

constexpr Rgb8 kBlack{0, 0, 0};
constexpr Rgb8 kWhite{255, 255, 255};

std::string unlit(const std::string& geometry) { return "<Shape>" + geometry + "</Shape>"; }
std::string lit(const std::string& geometry, const std::string& material = "") {
    return "<Shape><Appearance><Material diffuseColor='1 1 1' " + material + "/></Appearance>" +
           geometry + "</Shape>";
}
std::string turned(const std::string& rotation, const std::string& nodes) {
    return "<Transform rotation='" + rotation + "'>" + nodes + "</Transform>";
}

// The front of the box is at z = 1: there 1 unit is 10/9 at z = 0.
TEST(X3dPicture, ABoxCoversItsFront) {
    const Picture picture(unlit("<Box size='2 4 2'/>"));
    EXPECT_EQ(picture.at(1.05, 0.05), kWhite);
    EXPECT_EQ(picture.at(1.15, 0.05), kBlack);
    EXPECT_EQ(picture.at(-1.05, -2.15), kWhite);
    EXPECT_EQ(picture.at(0.05, 2.25), kBlack);
}

// A ray to (x, 0, 0) meets the cylinder of radius 2 about y at an angle t from its normal; the
// headlight shines along -z, and the mantle's normal there has z = sqrt(1 - (X/2)^2) with X the
// point's x: X = x (10 - Z) / 10, X^2 + Z^2 = 4.
TEST(X3dPicture, ACylindersMantleIsShadedRound) {
    const Picture picture(lit("<Cylinder radius='2' height='6'/>"));
    for (const double x : {0.05, 0.55, 1.05, 1.55, 1.95}) {
        const double s = x / 10, a = s * s + 1, b = -10 * s * s, c = 100 * s * s - 4;
        const double z = (-b + std::sqrt(b * b - a * c)) / a;
        EXPECT_NEAR(picture.at(x, 0.05).r, 255 * z / 2, 2) << x;
    }
    EXPECT_EQ(picture.at(2.15, 0.05), kBlack);  // its outline: 2 / sqrt(1 - 0.04) = 2.04
}

// Seen from the side, the mantle's normal at the middle is (0, r, h) / sqrt(r^2 + h^2).
TEST(X3dPicture, AConesMantleLeansBack) {
    const Picture picture(lit("<Cone bottomRadius='3' height='4'/>"));
    EXPECT_NEAR(picture.at(0.05, -0.55).r, 255 * 0.8, 2);
    EXPECT_EQ(picture.at(0.05, 2.15), kBlack);
    EXPECT_EQ(picture.at(1.75, 1.05), kBlack);
    // Its base from below is flat and faces the light.
    EXPECT_EQ(Picture(turned("1 0 0 -1.5707963267948966", lit("<Cone/>"))).at(0.55, 0.05), kWhite);
}

TEST(X3dPicture, AnElevationGridStandsWhereItsHeightsSay) {
    // A slope of 45 degrees towards the light, turned to face the viewer: brightness cos 45.
    const Picture picture(
        turned("1 0 0 1.5707963267948966",
               lit("<ElevationGrid xDimension='2' zDimension='2' xSpacing='3' zSpacing='3' "
                   "height='0 3 0 3'/>")));
    EXPECT_NEAR(picture.at(1.05, -1.05).r, 255 * std::sqrt(0.5), 1);
    EXPECT_EQ(picture.at(-0.15, -1.05), kBlack);
    EXPECT_EQ(picture.at(1.05, 0.15), kBlack);
}

TEST(X3dPicture, ConcavePolygonsLeaveTheirNotchOpen) {
    const std::string points =
        "<Coordinate point='-3 -3 0 3 -3 0 3 3 0 0 -2 0 -3 3 0'/></IndexedFaceSet>";
    const Picture cut(unlit("<IndexedFaceSet convex='false' coordIndex='0 1 2 3 4'>" + points));
    EXPECT_EQ(cut.at(0.05, 0.05), kBlack);
    EXPECT_EQ(cut.at(0.05, -2.55), kWhite);
    EXPECT_EQ(cut.at(2.55, 0.05), kWhite);
    EXPECT_EQ(cut.at(-2.55, 0.05), kWhite);
}

const std::string kSquare = "<Coordinate point='-2 -2 0 2 -2 0 2 2 0 -2 2 0'/>";

TEST(X3dPicture, ColorsBlendBetweenTheCornersOfTriangles) {
    // Red grows from left to right, and green from the bottom to the top of each triangle.
    const std::string node = "<IndexedFaceSet coordIndex='0 1 2 3'>" + kSquare +
                             "<Color color='0 0 0 1 0 0 1 1 0 0 1 0'/></IndexedFaceSet>";
    for (const Picture& picture :
         {Picture(unlit(node)), Picture(lit(node)), Picture(unlit(node), "3.3", Precision::kDouble),
          Picture(unlit(node), "3.3", Precision::kFloat)})
        for (const double x : {-1.45, -0.05, 1.05})
            for (const double y : {-1.25, 0.75, 1.95}) {
                EXPECT_NEAR(picture.at(x, y).r, 255 * (x + 2) / 4, 1) << x << " " << y;
                EXPECT_NEAR(picture.at(x, y).g, 255 * (y + 2) / 4, 1) << x << " " << y;
                EXPECT_EQ(picture.at(x, y).b, 0);
            }
}

TEST(X3dPicture, ColorsPerFaceAreUniform) {
    const Picture picture(
        unlit("<IndexedFaceSet colorPerVertex='false' coordIndex='0 1 2 -1 0 2 3'>" + kSquare +
              "<ColorRGBA color='1 0 0 1 0 0.2 1 1'/></IndexedFaceSet>"));
    EXPECT_EQ(picture.at(1.05, -1.05), (Rgb8{255, 0, 0}));
    EXPECT_EQ(picture.at(-1.05, 1.05), (Rgb8{0, 51, 255}));
}

TEST(X3dPicture, AColorReplacesTheDiffuseColorOnly) {
    // Emissive blue stays; the light shines straight at the square.
    const Picture picture(
        "<Shape><Appearance><Material diffuseColor='0 1 0' emissiveColor='0 0 0.2'/></Appearance>"
        "<IndexedFaceSet colorPerVertex='false' coordIndex='0 1 2 3'>" +
        kSquare + "<Color color='0.4 0 0'/></IndexedFaceSet></Shape>");
    EXPECT_EQ(picture.at(0.05, 0.05), (Rgb8{102, 0, 51}));
}

TEST(X3dPicture, UnlitShapesIgnoreEveryLight) {
    const std::string dark = "<NavigationInfo headlight='false'/>";
    EXPECT_EQ(Picture(dark + unlit("<Sphere/>")).at(0.05, 0.05), kWhite);
    EXPECT_EQ(Picture(dark + lit("<Sphere/>")).at(0.05, 0.05), kBlack);
    EXPECT_EQ(Picture(dark + "<Shape><Appearance><UnlitMaterial emissiveColor='0 0.2 0.4'/>"
                             "</Appearance><Sphere/></Shape>",
                      "4.0")
                  .at(0.05, 0.05),
              (Rgb8{0, 51, 102}));
    EXPECT_EQ(Picture(dark + lit("<Sphere/>", "emissiveColor='0.4 0 0'")).at(0.05, 0.05),
              (Rgb8{102, 0, 0}));
}

// The back of a square that faces away: the headlight does not reach its normal unless both sides
// count.
TEST(X3dPicture, OnlyShapesThatAreNotSolidAreLitFromBehind) {
    const std::string away = "coordIndex='3 2 1 0'>" + kSquare + "</IndexedFaceSet>";
    EXPECT_EQ(Picture(lit("<IndexedFaceSet " + away)).at(0.05, 0.05), kBlack);
    EXPECT_EQ(Picture(lit("<IndexedFaceSet solid='false' " + away)).at(0.05, 0.05), kWhite);
    EXPECT_EQ(Picture(lit("<IndexedFaceSet ccw='false' " + away)).at(0.05, 0.05), kWhite);
    EXPECT_EQ(
        Picture("<Transform scale='-1 1 1'>" + lit("<IndexedFaceSet " + away) + "</Transform>")
            .at(0.05, 0.05),
        kBlack);  // a mirror turns the picture, not the side
}

TEST(X3dPicture, GivenNormalsAreBlendedAndRenormalised) {
    // Normals lean to the left and right by 45 degrees at the edges: in the middle they face the
    // light, and at x = 1 they are (1, 0, 2) / sqrt 5.
    const Picture picture(lit("<IndexedFaceSet coordIndex='0 1 2 3'>" + kSquare +
                              "<Normal vector='-1 0 1 1 0 1 1 0 1 -1 0 1'/></IndexedFaceSet>"));
    EXPECT_NEAR(picture.at(0.05, 0.35).r, 255, 1);
    const double x = 1.05 / 2;
    EXPECT_NEAR(picture.at(1.05, 0.35).r, 255 / std::sqrt(x * x + 1), 1);
}

TEST(X3dPicture, SwitchLodAndVisibleChooseWhatIsSeen) {
    const auto square = [](const std::string& color) {
        return "<Shape><IndexedFaceSet colorPerVertex='false' coordIndex='0 1 2 3'>" + kSquare +
               "<Color color='" + color + "'/></IndexedFaceSet></Shape>";
    };
    const std::string both = square("1 0 0") + square("0 0 1");
    EXPECT_EQ(Picture("<Switch whichChoice='1'>" + both + "</Switch>").at(0.05, 0.05),
              (Rgb8{0, 0, 255}));
    EXPECT_EQ(Picture("<LOD range='9'>" + both + "</LOD>").at(0.05, 0.05), (Rgb8{0, 0, 255}));
    EXPECT_EQ(Picture("<LOD range='11'>" + both + "</LOD>").at(0.05, 0.05), (Rgb8{255, 0, 0}));
    EXPECT_EQ(Picture("<Group visible='false'>" + both + "</Group>").at(0.05, 0.05), kBlack);
}

// Two squares beside each other, a sun in the group of the right one.
TEST(X3dPicture, ASunLightsItsGroupOnlyFromVersion31On) {
    const std::string face =
        lit("<IndexedFaceSet coordIndex='0 1 2 3'>" + kSquare + "</IndexedFaceSet>");
    const std::string nodes = "<Transform translation='-2.5 0 0'>" + face +
                              "</Transform><Transform translation='2.5 0 0'><DirectionalLight/>" +
                              face + "</Transform>";
    EXPECT_EQ(Picture(nodes, "3.3").at(-2.45, 0.05), kBlack);
    EXPECT_EQ(Picture(nodes, "3.3").at(2.45, 0.05), kWhite);
    EXPECT_EQ(Picture(nodes, "3.0").at(-2.45, 0.05), kWhite);
}

// The upper end of a sky of two bands: the zenith is red, the horizon (90 degrees) blue.
TEST(X3dPicture, ABackgroundOfBandsIsLinearInTheAngle) {
    const Picture picture(
        "<Background skyColor='1 0 0 0 0 1' skyAngle='1.5707963267948966' groundColor='0 1 0'/>");
    const double up = std::atan2(4.05, std::hypot(10, 0.05));  // above the horizon
    EXPECT_NEAR(picture.at(0.05, 4.05).r, 255 * up / 1.5707963267948966, 1);
    EXPECT_EQ(picture.at(0.05, -1.05), (Rgb8{0, 255, 0}));
    // No ground beyond its last angle, here two thirds of the way from the nadir to the horizon; a
    // rotation by pi about x exchanges zenith and nadir.
    const std::string fields =
        "<Background skyColor='1 0 0 0 0 1' skyAngle='3.141592653589793' groundColor='0 1 0 0 1 0' "
        "groundAngle='1.0471975511965976'/>";
    EXPECT_NEAR(Picture(fields).at(0.05, -4.05).b, 255 * (0.5 + up / 3.141592653589793), 1);
    EXPECT_EQ(Picture(fields).at(0.05, -4.05).g, 0);
    EXPECT_NEAR(Picture("<Transform rotation='1 0 0 3.141592653589793'>" + fields + "</Transform>")
                    .at(0.05, -4.05)
                    .r,
                255 * (0.5 + up / 3.141592653589793), 1);
}

}  // namespace
}  // namespace nuvo
