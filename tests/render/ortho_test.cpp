// OrthoViewpoint as pixels that are worked out by hand, by every tracer.
#include <gtest/gtest.h>

#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

constexpr Resolution kSize{80, 40};

enum class Thesis { kToo, kNot };
Image picture(const std::string& nodes, Thesis by_thesis = Thesis::kToo) {
    const Scene scene =
        x3d::read_text("<X3D version='3.2'><Scene>" + nodes + "</Scene></X3D>", "scene");
    EXPECT_TRUE(scene.camera_given);
    const Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    const Image exact =
        render(scene, primitives, build_tree(scene, primitives, profile), profile, kSize);
    EXPECT_EQ(render_brute_force(scene, primitives, profile, kSize), exact);
    EXPECT_EQ(FastTracer(scene, primitives, {}).render(kSize), exact);
    if (by_thesis == Thesis::kNot) return exact;
    const Profile thesis = thesis_profile();
    const Primitives shapes = flatten(scene, thesis.leaves);
    EXPECT_EQ(render(scene, shapes, build_tree(scene, shapes, thesis), thesis, kSize), exact);
    return exact;
}

// 20 units wide and 10 high, a unit being 4 pixels: boxes are as large however far they are.
TEST(OrthoViewpoint, ShowsThingsInTheSameSizeAtAnyDistance) {
    const auto box = [](const char* place) {
        return std::string("<Transform translation='") + place +
               "'><Shape><Box/></Shape></Transform>";
    };
    const Image image = picture("<OrthoViewpoint fieldOfView='-5 -5 5 5'/>" + box("-6 0 5") +
                                box("6 0 -500") + box("0 0 20"));  // the last is behind
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
            const double wide = (x + 0.5 - 40) / 4, high = (20 - y - 0.5) / 4;
            const bool hit = std::abs(std::abs(wide) - 6) < 1 && std::abs(high) < 1;
            ASSERT_EQ(image.at(x, y).r, hit ? 255 : 0) << x << " " << y;
        }
}

TEST(OrthoViewpoint, TurnsAndScalesWithItsAncestors) {
    const Image image = picture(
        "<Transform rotation='0 1 0 1.5707963267948966' scale='2 2 2'><OrthoViewpoint "
        "position='0 0 9' fieldOfView='-1 0 1 2'/></Transform><Transform translation='0 2 -1'>"
        "<Shape><Box size='1 1 1'/></Shape></Transform>");
    // From +x, 4 units high and 8 wide, 10 pixels a unit: z = -1 is to the right, y = 2 the middle.
    EXPECT_EQ(image.at(50, 20).r, 255);
    EXPECT_EQ(image.at(46, 16).r, 255);
    EXPECT_EQ(image.at(54, 24).r, 255);
    EXPECT_EQ(image.at(44, 20).r, 0);
    EXPECT_EQ(image.at(56, 20).r, 0);
    EXPECT_EQ(image.at(50, 14).r, 0);
    EXPECT_EQ(image.at(50, 26).r, 0);
}

// Rays start in the plane z = 0: of what it cuts only the part below is there.
TEST(OrthoViewpoint, ShowsWhatLiesBeforeItsRaysStart) {
    const std::string view = "<OrthoViewpoint position='0 0 0' fieldOfView='-5 -5 5 5'/>";
    // y = z, rising through that plane; and a sphere and a box around where rays start.
    const Image slope = picture(
        view +
        "<Shape><IndexedFaceSet solid='false' coordIndex='0 1 2 3 -1'><Coordinate point='-4 "
        "-4 -4 4 -4 -4 4 4 4 -4 4 4'/></IndexedFaceSet></Shape>");
    const Image sphere = picture(view + "<Shape><Sphere radius='3' solid='false'/></Shape>");
    const Image box = picture(view + "<Shape><Box size='6 6 1' solid='false'/></Shape>");
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
            const double wide = (x + 0.5 - 40) / 4, high = (20 - y - 0.5) / 4;
            ASSERT_EQ(slope.at(x, y).r, std::abs(wide) < 4 && high < 0 && high > -4 ? 255 : 0)
                << x << " " << y;
            ASSERT_EQ(sphere.at(x, y).r, wide * wide + high * high < 9 ? 255 : 0) << x << " " << y;
            ASSERT_EQ(box.at(x, y).r, std::abs(wide) < 3 && std::abs(high) < 3 ? 255 : 0)
                << x << " " << y;
        }
}

// From where double arithmetic tells the pixels apart, and where it no longer does.
TEST(OrthoViewpoint, ShowsTheSameFromAnyDistance) {
    const auto from = [](const char* place) {
        return picture(
            std::string("<OrthoViewpoint fieldOfView='-5 -5 5 5' position='0 0 ") + place +
                "'/><DirectionalLight direction='-1 -1 -2'/><Shape><Appearance><Material/>"
                "</Appearance><Sphere radius='3'/></Shape><Shape><Box size='9 1 1'/></Shape>",
            Thesis::kNot);
    };
    const Image near = from("10");
    for (const char* place : {"1e3", "1e8", "1e13", "1e18"}) EXPECT_EQ(from(place), near) << place;
}

TEST(OrthoViewpoint, OfNoExtentIsTheStandards) {
    const std::string box = "<Shape><Box/></Shape>";
    const Image standard = picture("<OrthoViewpoint/>" + box);
    for (const char* field : {"1 1 -1 -1", "-1 -1 1", "-1 0 1 0", "-1 -1 1 1 1", "-1 -1 1 1"})
        EXPECT_EQ(picture(std::string("<OrthoViewpoint fieldOfView='") + field + "'/>" + box),
                  standard);
}

}  // namespace
}  // namespace nuvo
