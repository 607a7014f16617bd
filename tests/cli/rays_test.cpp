#include <gtest/gtest.h>

#include <string>

#include "cli/program_runner.h"

// --rays: what is asked for a line, and what is answered.
namespace nuvo::cli_test {
namespace {

using Rays = ProgramTest;

TEST_F(Rays, AreAnsweredLineForLine) {
    put("a.x3d", kSmallScene);
    put("rays",
        "0 0 10 0 0 -1\n"       // the sphere, 9 away
        "0 0 10 0 0 -2\n"       // the same in units of 2
        "5 5 10 0 0 -1\n\n"     // past everything
        "1.5 -1.75 8 0 0 -1\n"  // the square's first triangle at z = -2
        "-1.5 1.75 8 0 0 -4\n"  // and its second
        "0 0 0 0 0 1\n");       // from the sphere's centre, where it shows its back
    const std::string fronts = "1 0 0 9\n1 0 0 4.5\n0 -1 -1 inf\n1 1 0 10\n1 1 1 2.5\n";
    const std::string expected = fronts + "0 -1 -1 inf\n";
    for (const char* type : {"--type=uniform", "--type=nonuniform"}) {
        const Outcome outcome = run({"--file=a", "--rays=rays", type});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out, expected);
        EXPECT_EQ(run({"--file=a", "--rays=rays", type, "--out=answers"}).exit_code, 0);
        EXPECT_EQ(content("answers"), expected);
        EXPECT_EQ(run({"--file=a", "--rays=rays", type, "--back-faces=draw"}).out,
                  fronts + "1 0 0 1\n");
    }
    EXPECT_FALSE(exists("a.bmp"));
}

TEST_F(Rays, AreToldWhereTheyHitAndOnWhichSide) {
    // A ball moved and stretched to semi-axes 2, 1, 1 around 5 0 0, and a triangle facing +z.
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape><Sphere radius='2'/></Shape>"
        "<Transform translation='5 0 0' scale='2 1 1'><Shape><Sphere/></Shape></Transform>"
        "<Shape><IndexedFaceSet coordIndex='0 1 2 -1'>"
        "<Coordinate point='20 0 1, 24 0 1, 20 4 1'/></IndexedFaceSet></Shape></Scene></X3D>");
    put("rays",
        "0,0,10, 0,0,-1\n"   // the sphere's pole
        "5,0,10, 0,0,-4\n"   // the ellipsoid's
        "21,1,10, 0,0,-1\n"  // the triangle
        "50,0,10, 0,0,-1 # none\n");
    for (const char* profile : {"--profile=exact", "--profile=fast"}) {
        const Outcome outcome = run({"a.x3d", "--rays=rays", "--answers=point,normal", profile});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out,
                  "1 0 0 8 0 0 2 0 0 1\n1 1 0 2.25 5 0 1 0 0 1\n1 2 0 9 21 1 1 0 0 1\n"
                  "0 -1 -1 inf nan nan nan nan nan nan\n");
        EXPECT_EQ(run({"a.x3d", "--rays=-", "--answers=normal", profile}, "rays").out.substr(0, 14),
                  "1 0 0 8 0 0 1\n");
    }
    ASSERT_EQ(run({"a.x3d", "--rays=rays", "--out=answers.npy"}).exit_code, 0);
    EXPECT_EQ(content("answers.npy").substr(0, 6), "\x93NUMPY");
    EXPECT_EQ(content("answers.npy").size(), 192u + 4 * 25);
    expect_refused({"a.x3d", "--answers=point"}, 2, {"--answers=point", "--rays"});
    expect_refused({"a.x3d", "--rays=rays", "--answers=color"}, 2, {"--answers=color", "normal"});
}

// A Shape's own name, that of what is around it, by USE, beside ones that are hidden or not drawn.
TEST_F(Rays, AreToldTheNameOfWhatTheyHit) {
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape><Sphere/></Shape>"
        "<Switch whichChoice='-1'><Shape DEF='Hidden'><Sphere/></Shape></Switch>"
        "<Transform DEF='Yard' translation='10 0 0'><Group><Shape><Text string='none'/></Shape>"
        "<Shape><Sphere/></Shape></Group><Transform translation='10 0 0'>"
        "<Shape DEF='the well'><Sphere/></Shape></Transform></Transform>"
        "<Transform translation='30 0 0'><Shape USE='the well'/></Transform>"
        "<Transform translation='40 0 0'><Transform USE='Yard'/></Transform></Scene></X3D>");
    put("rays",
        "0 0 9 0 0 -1\n10 0 9 0 0 -1\n20 0 9 0 0 -1\n30 0 9 0 0 -1\n50 0 9 0 0 -1\n"
        "60 0 9 0 0 -1\n5 0 9 0 0 -1\n");
    for (const char* profile : {"--profile=exact", "--profile=fast"})
        EXPECT_EQ(run({"a.x3d", "--rays=rays", "--answers=def", profile}).out,
                  "1 0 0 8 -\n1 3 0 8 Yard\n1 4 0 8 the_well\n1 5 0 8 the_well\n1 7 0 8 Yard\n"
                  "1 8 0 8 the_well\n0 -1 -1 inf -\n");
    EXPECT_EQ(run({"a.x3d", "--rays=rays", "--answers=def,point"}).out.substr(0, 16),
              "1 0 0 8 0 0 1 -\n");
}

}  // namespace
}  // namespace nuvo::cli_test
