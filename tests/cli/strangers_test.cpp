// Small files after those of strangers (testfiles/strangers), each with the picture it must give.
#include <gtest/gtest.h>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

struct Pixel {
    int x, y;
    int red, green, blue;
};
struct Case {
    const char* name;
    const char* warning;  // a part of what is said; empty: nothing
    std::vector<Pixel> pixels;
};

constexpr Pixel kGreenCenter{160, 120, 0, 255, 0};

// The values come from the standard's lighting equations: green balls lit along -z and seen from
// (0, 0, 10), where one unit at z = 0 is 29 pixels. A ray to (x, 0, 0) meets a ball of radius 1
// about (x, 0, 0) near (0.9 x, 0, 1), so that N.L is about sqrt(1 - (0.1 x)^2). view3dscene 4.2.0
// and X_ITE 15 draw the same.
const Case kCases[] = {
    {"castShadow_false", "", {{200, 120, 231, 231, 231}}},
    {"empty_attribute", "Transform@scale: 1 left out", {{160, 120, 204, 255, 204}}},
    {"grid_without_heights", "Shape: 1 left out", {kGreenCenter}},
    {"group_espdutransform", "", {kGreenCenter}},
    {"group_hanim", "", {kGreenCenter}},
    {"group_layerset", "", {kGreenCenter}},
    {"group_pickablegroup", "", {kGreenCenter}},
    {"lamp_in_its_bulb", "", {{200, 120, 231, 231, 231}}},  // N.L = 3 / sqrt(9 + 1.39 x 1.39)
    {"no_points_yet", "Shape: 1 left out", {kGreenCenter}},
    {"normalIndex_minus_one_per_face", "normalIndex", {{120, 120, 255, 255, 255}}},
    {"nothing_in_view", "the shapes lie between 58 -2 -2 and 62 2 2", {{160, 120, 0, 255, 0}}},
    {"one_lower_case_node", "appearance: 1 read as Appearance", {{247, 120, 0, 245, 0}}},
    {"proto_instance", "", {kGreenCenter}},
    {"root_x3d_lower_case", "x3d: 1 read as X3D", {kGreenCenter}},
    {"script_field_use_of_nothing", "Script: 1 not drawn", {kGreenCenter}},
    {"script_field_uses_ancestor", "Script: 1 not drawn", {kGreenCenter}},
    {"script_field_uses_itself", "Script: 1 not drawn", {kGreenCenter}},
    {"solid_box_from_inside",
     "the camera stands inside Shape 0",
     {{160, 120, 0, 0, 255}, {5, 5, 0, 0, 255}}},
    {"solid_mesh_wound_inwards", "", {{160, 120, 204, 204, 204}, {5, 5, 0, 0, 255}}},
    {"too_few_colors", "Color: 1 left out", {kGreenCenter}},
    {"unit_angle_degree", "", {kGreenCenter, {5, 5, 0, 0, 255}}},
    {"unit_angle_fov", "", {kGreenCenter, {5, 5, 0, 0, 255}}},
    {"use_before_def",
     "Shape@USE: 1 coming before its DEF",
     {{218, 120, 0, 251, 0}, {102, 120, 0, 249, 0}}},
    {"use_names_another_kind",
     "Shape@USE: 1 naming a node of another kind",
     {{102, 120, 0, 249, 0}, {218, 120, 0, 251, 0}}},
    {"viewpointgroup", "", {kGreenCenter, {5, 5, 0, 0, 255}}},
};

class Strangers : public ProgramTest {};

TEST_F(Strangers, FilesAreDrawn) {
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        const std::string file = std::string(NUVO_SOURCE_DIR "/testfiles/strangers/") + c.name;
        const Outcome outcome =
            run({"--file=" + file, "--res=320,240", "--rep=1", "--quiet", "--out=a.bmp"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        if (*c.warning == '\0')
            EXPECT_EQ(outcome.err, "");
        else
            EXPECT_NE(outcome.err.find(c.warning), std::string::npos) << outcome.err;
        const std::string bytes = content("a.bmp");
        ASSERT_EQ(bytes.size(), 54u + 320 * 240 * 3);
        for (const Pixel& pixel : c.pixels) {
            // 24 bits a pixel, blue first, rows from the bottom.
            const std::size_t at =
                54 + 3 * (static_cast<std::size_t>(239 - pixel.y) * 320 + pixel.x);
            const auto level = [&](std::size_t i) {
                return static_cast<int>(static_cast<unsigned char>(bytes[at + i]));
            };
            EXPECT_NEAR(level(2), pixel.red, 2) << pixel.x;
            EXPECT_NEAR(level(1), pixel.green, 2) << pixel.x;
            EXPECT_NEAR(level(0), pixel.blue, 2) << pixel.x;
        }
    }
}

}  // namespace
}  // namespace nuvo::cli_test
