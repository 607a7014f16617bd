// Scenes that the fast tracer once got wrong, with their numbers, and random ones of their kinds:
// against the serial exact tracer or, where the octrees are in question, brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "fast_cases.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::testing {
namespace {

Scene read(const std::string& nodes) {
    return x3d::read_text("<X3D version='3.3'><Scene>" + nodes + "</Scene></X3D>", "scene");
}
std::string lit_shape(const std::string& geometry, const std::string& material = "") {
    return "<Shape><Appearance><Material " + material + "/></Appearance>" + geometry + "</Shape>";
}
std::string placed(const std::string& fields, const std::string& nodes) {
    return "<Transform " + fields + ">" + nodes + "</Transform>";
}

// The box of the sphere around the ellipsoid reached across the plane in which the lamp stands.
TEST(FastFaults, ALampBesideAThinEllipsoidCastsItsShadow) {
    expect_identical(
        read("<Viewpoint position='0 3 16' orientation='1 0 0 -0.3'/>"
             "<PointLight location='-7 5 1'/>" +
             placed("translation='-4 0 -1' scale='0.5 0.5 4'", lit_shape("<Sphere/>")) +
             placed("translation='0 -5 0'", lit_shape("<Box size='10 0.1 10'/>")) +
             placed("translation='0 0 -5'", lit_shape("<Box size='10 10 0.1'/>"))),
        {{160, 90}});
}

// Normals of a plane through the eye, whose squares are beyond floats: their length counted as 0
// and as known where a root is taken instead of an estimate.
TEST(FastFaults, SmoothTrianglesThatAllButHoldTheEyeAreLit) {
    for (const double third : {1e-3, 3e-18, 3e-19, 1e-25, 1e-36, 1e-40, 0.0}) {
        std::ostringstream corners;
        corners << "-9 0 1 9 0 1 0 " << third << " -30";
        expect_identical(
            read("<Viewpoint position='0 .001 0'/><DirectionalLight direction='0 -1 0'/>" +
                 lit_shape("<IndexedTriangleSet solid='false' index='0 1 2'>"
                           "<Coordinate point='" +
                           corners.str() + "'/></IndexedTriangleSet>")),
            {{16, 16}, {1, 2}});
    }
    expect_identical(read("<Viewpoint position='0 0 0' orientation='1 0 0 3.141592653589793'/>"
                          "<PointLight location='0 0 0'/>" +
                          lit_shape("<IndexedTriangleSet index='0 1 2'><Coordinate point='0 "
                                    "0.000999999999999442 -4.557 5 0.0010000000000005582 4.557 0 "
                                    "0.0010000000000005582 4.557'/></IndexedTriangleSet>")),
                     {{4, 4}, {1, 2}});
    expect_identical(
        read("<Viewpoint position='0 0 0' orientation='1 0 0 4.71238898038469' "
             "fieldOfView='3.1415926535478342'/><DirectionalLight direction='0 0 0.4'/>" +
             lit_shape("<IndexedTriangleSet index='0 1 2'><Coordinate point='-2 0 10 0 0 "
                       "10 0 -2 10'/></IndexedTriangleSet>")),
        {{200, 120}});
}

// Directions at the picture's edge whose squares are beyond floats, of spheres and, stretched, of
// ellipsoids.
TEST(FastFaults, QuadricsAroundTheEyeAreSeenAtAnyFieldOfView) {
    const std::string nearly_half = "fieldOfView='3.1415926535897927'/>";
    expect_identical(
        read("<Viewpoint position='0 0.6 0' " + nearly_half +
             "<DirectionalLight direction='1 1 0'/><DirectionalLight direction='-1 1 0'/>" +
             lit_shape("<Sphere solid='false'/>")),
        {{6000, 1}});
    expect_identical(read("<Viewpoint position='0 0.6 0' " + nearly_half +
                          "<PointLight location='0 1e30 0' radius='1e37' ambientIntensity='1'/>" +
                          lit_shape("<Sphere solid='false'/>", "ambientIntensity='1'")),
                     {{6000, 1}});
    for (const char* scale : {"0.01 1 1", "0.02 1 1", "1 0.01 1"})
        expect_identical(
            read("<Viewpoint position='0 0 0' " + nearly_half +
                 placed("scale='" + std::string(scale) + "'",
                        lit_shape("<Sphere solid='false'/>", "emissiveColor='1 0 0'"))),
            {{256, 1}, {3000, 1}, {1, 512}});
}

// A limit that no float is near: only on the axis itself there is light.
TEST(FastFaults, ASpotNarrowerThanFloatsLightsItsAxis) {
    for (const char* angle : {"1e-44", "7e-46", "1e-50", "1e-310"})
        expect_identical(
            read("<Viewpoint position='0 0 10'/><SpotLight location='0 0 5' direction='0 0 -1' "
                 "beamWidth='0' radius='100' cutOffAngle='" +
                 std::string(angle) + "'/>" +
                 lit_shape(
                     "<IndexedFaceSet coordIndex='0 1 2 3 -1'><Coordinate point='-3 -3 0 3 -3 0 3 "
                     "3 0 -3 3 0'/></IndexedFaceSet>")),
            {{5, 5}});
}

/// An ellipsoid before a floor and a wall, and a lamp near it, in it or behind.
Scene thin_ellipsoid_scene(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto number = [&](double low, double high) { return uniform(random, low, high); };
    Scene scene;
    scene.materials.resize(1);
    const auto add = [&](Shape shape) {
        Object object;
        object.shape = std::move(shape);
        object.shape_index = static_cast<std::uint32_t>(scene.objects.size());
        scene.objects.push_back(std::move(object));
    };
    Vector3 axes;
    for (int axis = 0; axis < 3; ++axis)
        axes[axis] = random() % 2 == 0 ? number(0.5, 4) : std::pow(10, number(-6, 0));
    // Turned about one of the axes, or not at all.
    const double turn = random() % 2 == 0 ? 0 : number(0, 3);
    const double c = std::cos(turn), s = std::sin(turn);
    Matrix3 linear{{{axes.x * c, -axes.y * s, 0}, {axes.x * s, axes.y * c, 0}, {0, 0, axes.z}}};
    const Point3 center{number(-4, 4), number(-3, 3), number(-3, 3)};
    add(Ellipsoid{center, linear, 1});
    const auto quad = [&](const Point3& p, const Vector3& u, const Vector3& v) {
        TriangleMesh mesh;
        mesh.positions = {p, p + u, p + u + v, p + v};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        add(std::move(mesh));
    };
    quad({-5, -5, -5}, {0, 0, 10}, {10, 0, 0});
    quad({-5, -5, -5}, {10, 0, 0}, {0, 10, 0});
    scene.shape_count = scene.objects.size();
    Light lamp;
    lamp.kind = Light::Kind::kPoint;
    lamp.radius = std::numeric_limits<double>::infinity();
    const Vector3 near{number(-1, 1), number(-1, 1), number(-1, 1)};
    lamp.location = center + near * std::pow(10, number(-3, 1));
    scene.lights = {lamp};
    scene.camera = camera_along({number(-6, 6), number(0, 6), 16}, {0, -0.1, -1});
    return scene;
}

TEST(FastFaults, LampsNearThinEllipsoidsCastTheirShadows) {
    const char* const given = std::getenv("NUVO_FAST_SEED");
    const std::uint64_t seed =
        given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
    for (std::uint64_t i = 0; i < 50; ++i) {
        SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed) + " scene " + std::to_string(i));
        expect_identical(thin_ellipsoid_scene(seed + i), {{64, 36}});
    }
}

// Pixel boxes were empty: the square of a sphere's distance has no inverse among floats.
TEST(FastFaults, SmallThingsInWideScenesAreSeen) {
    for (const char* const far :
         {"1e12", "1e18", "1e19", "1e20", "1e22", "1e30", "3e38", "1e150"}) {
        SCOPED_TRACE(far);
        const std::string place = std::string("translation='") + far + " 0 0'";
        expect_identical(read(lit_shape("<Sphere/>") + placed(place, lit_shape("<Sphere/>"))),
                         {{48, 32}});
        expect_identical(read(lit_shape("<Box/>") + placed(place, lit_shape("<Box/>"))),
                         {{48, 32}});
        expect_identical(read(placed("scale='1 2 1'", lit_shape("<Sphere/>")) +
                              placed(place, lit_shape("<Box/>"))),
                         {{48, 32}});
        const std::string lamp =
            std::string("<PointLight radius='1e308' location='") + far + " 3 4'/>";
        expect_identical(read(lamp + lit_shape("<Sphere/>", "specularColor='1 1 1'")), {{48, 32}});
    }
}

TEST(FastFaults, ScenesOfTheLeastAndTheGreatestNumbersAreSeen) {
    for (const char* const scale :
         {"1e-320", "1e-310", "1e-200", "1e-170", "1e-100", "1e100", "1e150", "1e200", "1e300"}) {
        SCOPED_TRACE(scale);
        const std::string s = scale;
        expect_identical(
            read("<Viewpoint position='0 0 1" + s.substr(1) + "'/>" +
                 placed("scale='" + s + " " + s + " " + s + "'",
                        lit_shape("<Sphere radius='0.3'/>") +
                            placed("translation='0.2 0 -0.5' scale='0.5 0.1 0.5'",
                                   lit_shape("<Sphere/>")) +
                            placed("translation='0 -0.4 0'", lit_shape("<Box size='1 0.1 1'/>")))),
            {{48, 32}});
    }
}

// One corner at 1e300: bounds without end were the largest float with the portable kernels.
TEST(FastFaults, ABoundThatFloatsCannotTellIsInfinite) {
    expect_identical(read("<Shape><IndexedTriangleSet index='1 4 0'><Coordinate point='0 3 2 2 2 0 "
                          "0 0 0 0 2 0 4 1e+300 0'/></IndexedTriangleSet></Shape>" +
                          lit_shape("<IndexedTriangleSet index='3 2 1'><Coordinate point='0 2 0 0 "
                                    "0 3 4 3 3 0 3 0'/></IndexedTriangleSet>")),
                     {{160, 90}});
}

TEST(FastFaults, AnyShininessGivesTheLobeOfItsPower) {
    for (const char* const shininess : {"0", "4.9e-324", "1e-310", "1e-60", "1e-40", "1e-10", "1"})
        for (const char* const lamp : {"<PointLight/>", "<PointLight location='0 0 30'/>",
                                       "<DirectionalLight direction='1 0 0'/>"}) {
            SCOPED_TRACE(std::string(shininess) + lamp);
            expect_identical(
                read(lamp +
                     lit_shape("<Sphere/>",
                               std::string("specularColor='1 0 0' shininess='") + shininess + "'")),
                {{64, 36}});
        }
}

// Functions of the pixel are evaluated from the middle of a tile, here outside of the picture.
TEST(FastFaults, NoHoleInPicturesOfAFewPixels) {
    const Scene scene = read(
        "<Viewpoint position='0.7697578213477838 2.0313460604237585 0.3012340865605383' "
        "orientation='-0.9351123846874054 0.3543512776952188 0.0 1.4330045889660161' "
        "fieldOfView='1.5'/><NavigationInfo headlight='true'/>"
        "<Shape><Appearance><Material emissiveColor='1 1 1'/></Appearance>"
        "<IndexedFaceSet solid='false' coordIndex='0 1 2 -1 0 2 3 -1'><Coordinate point='"
        "0.474903766516265 0.4929440593926113 -0.3912034140116729 0.946970759834761 "
        "0.31284824718090665 -0.38782563330191033 -0.474903766516265 -0.4929440593926113 "
        "0.3912034140116729 -0.6143388971559569 0.7116480306225796 0.35252969921333066'/>"
        "</IndexedFaceSet></Shape>");
    std::vector<Resolution> sizes;
    for (int width = 1; width <= 20; ++width)
        for (int height = 1; height <= 20; height += width % 3 + 1)
            sizes.push_back({width, height});
    expect_identical(scene, sizes);
}

// Edges through the middle of the only pixel, seen from anywhere.
TEST(FastFaults, NoHoleAtTheEdgesOfOnePixel) {
    std::mt19937_64 random(20);
    for (int i = 0; i < 300; ++i) {
        const Vector3 a = uniform_point(random, 1), b = uniform_point(random, 1),
                      d = uniform_point(random, 1);
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].lit = false;
        scene.materials[0].emissive_color = {1, 1, 1};
        TriangleMesh mesh;
        mesh.positions = {a, b, -a, d};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        Object object;
        object.shape = std::move(mesh);
        object.solid = false;
        scene.objects.push_back(object);
        scene.shape_count = 1;
        const Point3 eye = uniform_point(random, 3);
        scene.camera = camera_along(eye, -eye);
        scene.camera.field_of_view_rad = 1.5;
        SCOPED_TRACE(i);
        expect_identical(scene, {{1, 1}, {2, 3}});
    }
}

// Slabs were infinite as floats and let a ray into the boxes of unused lanes, again and again.
TEST(FastFaults, RaysFromAnywhereEnd) {
    for (const char* const size : {"1e-20", "1e-60", "1e-150", "1e-250", "1"}) {
        const Scene scene = read(
            lit_shape(std::string("<Sphere radius='") + size + "'/>") +
            placed(std::string("translation='0 0 -") + size + "'",
                   lit_shape(std::string("<Box size='") + size + " " + size + " " + size + "'/>")));
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        std::vector<Ray> rays;
        for (const double distance : {1e-3, 10.0, 1e20, 1e60, 1e150, 1e300})
            for (const double slant : {0.0, 1e-300, 1e-100, 1e-20, 1e-9, 0.5})
                for (const double length : {1.0, 1e-310, 1e-200, 1e200})
                    for (int axis = 0; axis < 3; ++axis) {
                        Vector3 d{slant, slant, slant};
                        d[axis] = -1;
                        Point3 o;
                        o[axis] = distance;
                        rays.push_back({o, d * length});
                    }
        const std::vector<RayAnswer> expected =
            closest_hits(scene, primitives, nullptr, exact_profile(), rays);
        for (const InstructionSet isa : supported_instruction_sets()) {
            FastTracer tracer(scene, primitives, {OctreeType::kUniform, 1, isa});
            const std::vector<RayAnswer> found = tracer.closest_hits(rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EXPECT_EQ(found[i].hit, expected[i].hit) << size << " ray " << i;
                EXPECT_EQ(found[i].shape, expected[i].shape) << size << " ray " << i;
            }
        }
    }
}

// Narrow cones and wide ones, from near and far; the pixel's angle against the cone's.
TEST(FastFaults, SpotsOfAnyWidthGiveTheSameBytes) {
    struct Cone {
        const char* location;
        const char* width;
        const char* cut_off;
    };
    for (const Cone& cone : {Cone{"0 0 1e7", "0", "2e-7"},
                             {"0 0 1e8", "1e-8", "2e-8"},
                             {"0 0 1000", "0", "0.002"},
                             {"0 0 1000", "0.001", "0.00101"},
                             {"0 0 3", "0", "1.5707963267948966"},
                             {"0 0 3", "0.7", "0.8"},
                             {"0 0 1.001", "0.1", "1.2"}}) {
        SCOPED_TRACE(std::string(cone.location) + " " + cone.cut_off);
        expect_identical(
            read(std::string("<SpotLight radius='1e30' direction='0 0 -1' location='") +
                 cone.location + "' beamWidth='" + cone.width + "' cutOffAngle='" + cone.cut_off +
                 "'/>" + lit_shape("<Box size='6 6 2'/>")),
            {{80, 60}});
    }
}

}  // namespace
}  // namespace nuvo::testing
