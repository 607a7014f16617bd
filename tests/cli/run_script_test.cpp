#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

/// What scripts/run.sh and scripts/setup.sh say and choose, without installing or building.
class RunScript : public ProgramTest {
  protected:
    std::string bash(const std::string& commands) const {
        put("commands.sh", commands);
        const std::string out = (base_ / "out").string();
        const std::string line = "cd '" + folder_.string() + "' && bash commands.sh >'" + out +
                                 "' 2>&1 && echo done >>'" + out + "'";
        EXPECT_EQ(std::system(line.c_str()), 0) << file_text(out);
        return file_text(out);
    }
    std::string chosen(const std::string& arguments) const {
        return bash("source '" NUVO_SOURCE_DIR "/scripts/run.sh'\nchoose_options " + arguments +
                    "\necho \"${options[*]}\"\n");
    }
};

TEST_F(RunScript, WithoutASceneRendersTheReadmesPictureFast) {
    EXPECT_EQ(chosen(""), "--file=" NUVO_SOURCE_DIR
                          "/testfiles/showcase --profile=fast --threads=0 --rep=1\ndone\n");
}

TEST_F(RunScript, WhatTheUserChoseStays) {
    put("my.x3d", "");
    const std::string fast = "--profile=fast --threads=0 --rep=1\ndone\n";
    for (const char* scene : {"--file=my.x3d", "-file my", "my.x3d", "my", "--res=9,9 my.x3d"})
        EXPECT_EQ(chosen(scene), fast) << scene;
    EXPECT_EQ(chosen("my.x3d --threads=2"), "--profile=fast --rep=1\ndone\n");
    EXPECT_EQ(chosen("my.x3d --rep 7"), "--profile=fast --threads=0\ndone\n");
    EXPECT_EQ(chosen("my.x3d --profile=thesis"), "--rep=1\ndone\n");
    EXPECT_EQ(chosen("my.x3d --profile exact"), "--rep=1\ndone\n");
    EXPECT_EQ(chosen("my.x3d -profile=fast"), "--threads=0 --rep=1\ndone\n");
    EXPECT_EQ(chosen("my.x3d --walk=descent"), "\ndone\n");
    EXPECT_EQ(chosen("-h"), "\ndone\n");
    EXPECT_EQ(chosen("--version"), "\ndone\n");
}

TEST_F(RunScript, ProgressIsReadFromNinjaCtestAndApt) {
    const std::string said =
        bash("source '" NUVO_SOURCE_DIR
             "/scripts/setup.sh'\n"
             "printf '%s\\n' '[3/10] Building x' ' 4/77 Test  #4: A.B .. Passed' "
             "'Unpacking g++ (12.2) ...' 'warning: [5/6]' | nuvo_show_progress 'Busy'\n");
    for (const char* line : {"\rBusy: 3/10 ", "\rBusy: 4/77 ", "\rBusy: Unpacking g++ "})
        EXPECT_NE(said.find(line), std::string::npos) << said;
    EXPECT_EQ(said.find("5/6"), std::string::npos) << said;
}

TEST_F(RunScript, AFailureIsShownInFullAndElseOnlyTheTitle) {
    const std::string setup = "source '" NUVO_SOURCE_DIR "/scripts/setup.sh'\n";
    EXPECT_EQ(bash(setup + "nuvo_watch_quietly Title echo noise\n"), "Title\ndone\n");
    EXPECT_EQ(bash(setup + "nuvo_watch_quietly Title bash -c 'echo why; exit 3' || echo $?\n"),
              "Title\nwhy\n3\ndone\n");
}

}  // namespace
}  // namespace nuvo::cli_test
