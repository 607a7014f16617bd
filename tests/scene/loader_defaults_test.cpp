// The published program's defaults in place of the standard's, and Appearance inside a geometry.
#include <limits>

#include "scene/loading.h"

namespace nuvo {
namespace {

Scene load_as_published(const std::string& text) {
    return x3d::read_text(text, "scene.x3d", {.defaults = x3d::thesis_defaults()});
}

TEST(LoaderDefaults, OfTheThesisStandInForMissingFields) {
    const std::string text = bare("<Viewpoint/><PointLight/><SpotLight/>" + shape("<Sphere/>"));
    const Scene standard = load(text);
    EXPECT_NEAR(standard.camera.field_of_view_rad, 0.785398, 1e-6);
    EXPECT_EQ(standard.lights[0].ambient_intensity, 0);
    EXPECT_EQ(standard.lights[0].radius, 100);
    EXPECT_EQ(standard.materials[0].specular_color, (Color{0, 0, 0}));
    EXPECT_EQ(standard.materials[0].ambient_intensity, 0.2);

    const Scene published = load_as_published(text);
    EXPECT_EQ(published.camera.field_of_view_rad, 0.9);
    EXPECT_EQ(published.lights[0].ambient_intensity, 0.2);
    EXPECT_EQ(published.lights[0].radius, std::numeric_limits<double>::max());
    EXPECT_EQ(published.lights[1].beam_width, 1.57079632);
    EXPECT_EQ(published.lights[1].cut_off_angle, 0.78539816);
    EXPECT_EQ(published.materials[0].specular_color, (Color{1, 1, 1}));
    EXPECT_EQ(published.materials[0].shininess, 0.2);
}

TEST(LoaderDefaults, OfTheThesisYieldToFieldsButRadiusAndMaterialAmbient) {
    const Scene scene = load_as_published(
        bare("<Viewpoint fieldOfView='0.5'/><PointLight radius='3' ambientIntensity='0.7'/>"
             "<SpotLight beamWidth='0.1' cutOffAngle='0.3'/>"
             "<Shape><Appearance><Material specularColor='0 0.5 0' shininess='1' "
             "ambientIntensity='0.3'/></Appearance><Sphere/></Shape>"));
    EXPECT_EQ(scene.camera.field_of_view_rad, 0.5);
    EXPECT_EQ(scene.lights[0].ambient_intensity, 0.7);
    EXPECT_EQ(scene.lights[0].radius, std::numeric_limits<double>::max());
    EXPECT_EQ(scene.lights[1].beam_width, 0.1);
    EXPECT_EQ(scene.lights[1].cut_off_angle, 0.3);
    EXPECT_EQ(scene.materials[0].specular_color, (Color{0, 0.5, 0}));
    EXPECT_EQ(scene.materials[0].shininess, 1);
    EXPECT_EQ(scene.materials[0].ambient_intensity, 1);  // no factor
}

TEST(LoaderDefaults, OfTheThesisKeepCoincidentShapes) {
    const std::string text = bare(repeated(shape("<Sphere radius='2'/>"), 3));
    EXPECT_EQ(load(text).objects.size(), 1U);
    EXPECT_EQ(load(text).warnings.size(), 1U);
    EXPECT_EQ(load_as_published(text).objects.size(), 3U);
    EXPECT_TRUE(load_as_published(text).warnings.empty());
}

TEST(LoaderDefaults, OfTheThesisShadeFlatUnlessNormalsPerVertexAreStated) {
    const std::string rest =
        " index='0 1 2'><Coordinate point='0 0 0 1 0 0 0 1 0'/>"
        "<Normal vector='1 0 0 0 1 0 0 0 1'/></IndexedTriangleSet>";
    const std::string silent = bare(shape("<IndexedTriangleSet" + rest));
    const std::string stated = bare(shape("<IndexedTriangleSet normalPerVertex='true'" + rest));
    EXPECT_EQ(mesh_of(load(silent)).normals.size(), 3U);
    EXPECT_TRUE(mesh_of(load_as_published(silent)).normals.empty());
    EXPECT_EQ(mesh_of(load_as_published(stated)).normals.size(), 3U);
}

TEST(LoaderAppearance, InsideAGeometryCountsForItsShapeWithOneWarning) {
    const std::string appearance = "<Appearance><Material diffuseColor='0 0.5 1'/></Appearance>";
    const std::string triangle =
        "<Shape><IndexedTriangleSet index='0 1 2'><Coordinate point='0 0 0 1 0 0 0 1 0'/>" +
        appearance + "</IndexedTriangleSet></Shape>";
    const std::string sphere = "<Shape><Sphere>" + appearance + "</Sphere></Shape>";
    for (const Scene& scene :
         {load(bare(triangle + sphere)), load_as_published(bare(triangle + sphere))}) {
        ASSERT_EQ(scene.objects.size(), 2U);
        for (const Object& object : scene.objects)
            EXPECT_EQ(scene.materials[object.material].diffuse_color, (Color{0, 0.5, 1}));
        ASSERT_EQ(scene.warnings.size(), 1U);
        EXPECT_NE(scene.warnings[0].find("Appearance: 2 inside a geometry"), std::string::npos)
            << scene.warnings[0];
    }
    // The Shape's own comes first.
    const Scene both =
        load(bare("<Shape><Appearance><Material diffuseColor='1 0 0'/></Appearance>"
                  "<Sphere>" +
                  appearance + "</Sphere></Shape>"));
    EXPECT_EQ(both.materials[both.objects.at(0).material].diffuse_color, (Color{1, 0, 0}));
}

}  // namespace
}  // namespace nuvo
