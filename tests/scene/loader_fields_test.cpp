// How numbers and truth values are read, and what is said of those that cannot be.
#include "scene/loading.h"

namespace nuvo {
namespace {

double radius_read_from(const std::string& text) {
    const Scene scene = load(bare(shape("<Sphere radius='" + text + "'/>")));
    return std::get<Sphere>(scene.objects.at(0).shape).radius;
}

std::string radius_refusal(const std::string& text) {
    return refusal(bare(shape("<Sphere radius='" + text + "'/>")));
}

TEST(LoaderFields, ReadsNumbersAsDouble) {
    EXPECT_EQ(radius_read_from("0.1"), 0.1);
    EXPECT_EQ(radius_read_from(" \n\t0.12345678901234567\r\n"), 0.12345678901234567);
    EXPECT_EQ(radius_read_from("+2"), 2);
    EXPECT_EQ(radius_read_from("+.5"), 0.5);
    EXPECT_EQ(radius_read_from("3."), 3);
    EXPECT_EQ(radius_read_from("1e-300"), 1e-300);
    EXPECT_EQ(radius_read_from("2E+2"), 200);
    EXPECT_EQ(radius_read_from("5e-324"), 5e-324);
}

TEST(LoaderFields, RefusesWhatIsNoNumber) {
    for (const char* word : {"abc", "0.5m", "nan", "NaN", "inf", "-inf", "infinity", "0x10", "+-1",
                             "--1", "1e", ".", "-", "+", "1..2", "1,5e", "1f"}) {
        const std::string message = radius_refusal(word);
        EXPECT_NE(message.find("scene.x3d: Scene/Shape/Sphere@radius: \""), std::string::npos)
            << word << ": " << message;
        EXPECT_NE(message.find("is not a number"), std::string::npos) << word << ": " << message;
    }
    EXPECT_EQ(radius_refusal("abc"),
              "scene.x3d: Scene/Shape/Sphere@radius: \"abc\" is not a number (line 1)");
    EXPECT_EQ(radius_refusal("1e400"),
              "scene.x3d: Scene/Shape/Sphere@radius: \"1e400\" is beyond the range of double "
              "(line 1)");
    EXPECT_EQ(radius_refusal("-1"), "scene.x3d: Scene/Shape/Sphere@radius: is negative (line 1)");
}

TEST(LoaderFields, RefusesTooFewAndTooManyNumbers) {
    EXPECT_EQ(radius_refusal(""),
              "scene.x3d: Scene/Shape/Sphere@radius: 0 numbers where 1 belong (line 1)");
    EXPECT_EQ(radius_refusal("1 2"),
              "scene.x3d: Scene/Shape/Sphere@radius: 2 numbers where 1 belong (line 1)");
    EXPECT_EQ(refusal(bare("<Group/><Transform translation='1 2'/>")),
              "scene.x3d: Scene/Transform@translation: 2 numbers where 3 belong (line 1)");
    EXPECT_EQ(refusal(bare("<Transform/><Transform rotation='0 0 1'/>")),
              "scene.x3d: Scene/Transform[2]@rotation: 3 numbers where 4 belong (line 1)");
    EXPECT_EQ(
        refusal(bare(shape("<TriangleSet><Coordinate point='1 2 3 4'/></TriangleSet>"))),
        "scene.x3d: Scene/Shape/TriangleSet/Coordinate@point: 4 numbers are no list of triples "
        "(line 1)");
}

TEST(LoaderFields, TakesCommasBlanksAndLineBreaksBetweenNumbers) {
    const Scene scene = load(
        bare("<Transform translation=',1,\r\n 2 ,,\t3,'>" + shape("<Sphere/>") + "</Transform>"));
    EXPECT_EQ(std::get<Sphere>(scene.objects.at(0).shape).center, (Point3{1, 2, 3}));
}

TEST(LoaderFields, TakesTruthValuesInBothCases) {
    for (const char* word : {"false", "FALSE", " false "})
        EXPECT_FALSE(
            load(bare(shape("<Sphere solid='" + std::string(word) + "'/>"))).objects.at(0).solid);
    for (const char* word : {"true", "TRUE"})
        EXPECT_TRUE(
            load(bare(shape("<Sphere solid='" + std::string(word) + "'/>"))).objects.at(0).solid);
    EXPECT_TRUE(load(bare(shape("<Sphere/>"))).objects.at(0).solid);
    EXPECT_EQ(refusal(bare(shape("<Sphere solid='yes'/>"))),
              "scene.x3d: Scene/Shape/Sphere@solid: \"yes\" is neither true nor false (line 1)");
}

TEST(LoaderFields, MessagesAreOneShortLine) {
    const std::string message = radius_refusal(std::string(500, 'x') + "\x01");
    EXPECT_LT(message.size(), 150u);
    EXPECT_EQ(message.find('\n'), std::string::npos);
    const std::string deep = refusal(bare(
        repeated("<Group>", 1000) + shape("<Sphere radius='\x07'/>") + repeated("</Group>", 1000)));
    EXPECT_LT(deep.size(), 300u);
    EXPECT_NE(deep.find("Scene/Group/Group"), std::string::npos);
    EXPECT_NE(deep.find("/.../"), std::string::npos);
    EXPECT_NE(deep.find("Group/Shape/Sphere@radius: \"?\" is not a number"), std::string::npos);
}

TEST(LoaderFields, ValuesOutsideAColorsRangeAreClampedWithOneWarningPerField) {
    const Scene scene = load(bare(
        "<Shape><Appearance><Material diffuseColor='2 -1 0.5' shininess='3' ambientIntensity='-1' "
        "specularColor='0 0 9' emissiveColor='1 1 1.5'/></Appearance><Sphere radius='2'/></Shape>"
        "<Shape><Appearance><Material shininess='1.5'/></Appearance><Sphere/></Shape>"));
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.diffuse_color, (Color{1, 0, 0.5}));
    EXPECT_EQ(material.shininess, 1);
    EXPECT_EQ(material.ambient_intensity, 0);
    EXPECT_EQ(material.specular_color, (Color{0, 0, 1}));
    EXPECT_EQ(material.emissive_color, (Color{1, 1, 1}));
    const std::string first =
        " clamped to 0..1 (first at Scene/Shape[1]/Appearance/Material, line 1)";
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{
                  "Material@diffuseColor: 1" + first, "Material@ambientIntensity: 1" + first,
                  "Material@specularColor: 1" + first, "Material@shininess: 2" + first,
                  "Material@emissiveColor: 1" + first}));
}

}  // namespace
}  // namespace nuvo
