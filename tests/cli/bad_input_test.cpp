#include <gtest/gtest.h>

#include <string>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

constexpr int kUsage = 2;
constexpr int kRefused = 3;
constexpr int kCannotWrite = 4;

class BadInput : public ProgramTest {
  protected:
    void expect_scene_refused(const std::string& text, const std::vector<std::string>& parts) {
        put("bad.x3d", text);
        std::vector<std::string> all{"bad.x3d"};
        all.insert(all.end(), parts.begin(), parts.end());
        for (const char* name : {"--file=bad", "--file=bad.x3d"})
            expect_refused({name, "--rep=1", "--res=8,8"}, kRefused, all);
    }
    static bool takes_files(const fs::path& folder) {
        std::string name = (folder / "nuvo-XXXXXX").string();
        const int descriptor = ::mkstemp(name.data());
        if (descriptor < 0) return false;
        ::close(descriptor);
        return fs::remove(name);
    }
    /// Left out with a warning, and refused by --strict.
    void expect_left_out(const std::string& text, const std::vector<std::string>& parts) {
        put("bad.x3d", text);
        std::vector<std::string> all{"bad.x3d: "};
        all.insert(all.end(), parts.begin(), parts.end());
        const Outcome outcome = run({"--file=bad", "--rep=1", "--res=8,8"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        for (const std::string& part : all)
            EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
        EXPECT_NE(outcome.err.find("left out"), std::string::npos) << outcome.err;
        fs::remove(folder_ / "bad.bmp");
        expect_refused({"--file=bad", "--rep=1", "--res=8,8", "--strict"}, kRefused, all);
    }
    static std::string sphere(const std::string& radius) {
        return "<X3D version='3.3'><Scene><Shape><Sphere radius='" + radius +
               "'/></Shape></Scene></X3D>";
    }
};

TEST_F(BadInput, AMissingFileIsNamed) {
    expect_refused({"--file=missing", "--rep=1"}, kRefused, {"missing: "});
    expect_refused({"--file=no/such/folder/scene.x3d"}, kRefused, {"no/such/folder/scene.x3d: "});
}

TEST_F(BadInput, TheDefaultSceneMayBeMissing) {
    expect_refused({}, kRefused, {"testfiles/trianglemesh: "});
}

TEST_F(BadInput, AFolderIsNoScene) {
    fs::create_directory(folder_ / "scenes");
    expect_refused({"--file=scenes"}, kRefused, {"scenes: ", "folder"});
    fs::create_directory(folder_ / "odd.x3d");
    expect_refused({"--file=odd.x3d"}, kRefused, {"odd.x3d: "});
    expect_refused({"--file=odd"}, kRefused, {"odd.x3d: "});
}

TEST_F(BadInput, WhatIsNotXmlIsRefused) {
    expect_scene_refused("Once upon a time", {});
    expect_scene_refused("<X3D><Scene>", {});
    expect_scene_refused(std::string("\0\1\2\3", 4), {});
}

TEST_F(BadInput, AnEmptyFileIsRefused) {
    expect_scene_refused("", {});
    expect_scene_refused(" \n\n", {});
}

TEST_F(BadInput, ADocumentWithoutASceneIsRefused) {
    expect_scene_refused("<X3D version='3.0'><head/></X3D>", {"Scene"});
    expect_scene_refused("<html/>", {"html"});
}

TEST_F(BadInput, ABadNumberIsNamedWithElementAndAttribute) {
    expect_left_out(sphere("four"), {"Sphere", "radius", "four", "line 1"});
    expect_left_out(sphere("0.5m"), {"Sphere", "radius", "0.5m", "line 1"});
    expect_left_out(sphere("-1"), {"Sphere", "radius", "negative", "line 1"});
}

TEST_F(BadInput, NumbersThatAreNotFiniteAreNamed) {
    for (const char* number : {"nan", "NaN", "-nan", "inf", "1e400"})
        expect_left_out(sphere(number), {"Sphere", "radius", number});
}

TEST_F(BadInput, AnIndexOutOfRangeIsNamed) {
    expect_left_out(
        "<X3D version='3.0'><Scene><Shape><IndexedTriangleSet index='0 1 3'>"
        "<Coordinate point='0 0 0 1 0 0 0 1 0'/></IndexedTriangleSet></Shape></Scene></X3D>",
        {"IndexedTriangleSet", "index", "3"});
    expect_left_out(
        "<X3D version='3.0'><Scene><Shape><IndexedFaceSet coordIndex='0 1 9 -1'>"
        "<Coordinate point='0 0 0 1 0 0 0 1 0'/></IndexedFaceSet></Shape></Scene></X3D>",
        {"IndexedFaceSet", "coordIndex", "9"});
}

TEST_F(BadInput, SizesAndRepetitionsOutOfRangeAreUsageErrors) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--res=0,0"}, kUsage, {"--res=0,0", "16384"});
    expect_refused({"--file=a", "--res=99999999,1"}, kUsage, {"--res=99999999,1", "16384"});
    expect_refused({"--file=a", "--res=1,16385"}, kUsage, {"--res=1,16385", "16384"});
    expect_refused({"--file=a", "--rep=0"}, kUsage, {"--rep=0", "1000000"});
    expect_refused({"--file=a", "--rep=-1"}, kUsage, {"--rep=-1", "1000000"});
}

TEST_F(BadInput, AnUnknownFlagIsAUsageError) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--tpye=uniform"}, kUsage, {"--tpye=uniform", "--type?"});
    expect_refused({"--file=a", "--qqqqqqqqq"}, kUsage, {"--qqqqqqqqq"});
    expect_refused({"rep=5"}, kUsage, {"--rep=5"});
    expect_refused({"a.x3d", "--rse", "8x8"}, kUsage, {"--rse", "--res?"});
}

TEST_F(BadInput, AUsageErrorComesBeforeTheSceneIsRead) {
    expect_refused({"--file=missing", "--rep=0"}, kUsage, {"--rep=0"});
}

TEST_F(BadInput, AFolderThatDoesNotExistTakesNoPicture) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--res=8,8", "--out=none/a.bmp"}, kCannotWrite, {"none/a.bmp: "});
    expect_refused({"--file=a", "--res=8,8", "--json=none/a.json"}, kCannotWrite,
                   {"none/a.json: "});
    expect_refused({"--file=a", "--res=8,8", "--out="}, kUsage, {"out"});
    expect_refused({"--file=a", "--res=8,8", "--out=."}, kCannotWrite, {".: "});
}

TEST_F(BadInput, AFolderThatTakesNoFilesIsFoundBeforeALongRender) {
    put("a.x3d", kSmallScene);
    put("file", "no folder");
    // Whoever runs this, root, too, cannot make these; the last two where they are no plain
    // folders, as they are in a root without them.
    std::vector<std::string> outs{"file/a.bmp", std::string(300, 'a') + ".bmp"};
    for (const char* folder : {"/proc", "/sys"})
        if (!takes_files(folder)) outs.push_back(std::string(folder) + "/a.bmp");
    // The largest picture a million times: ends at once only if the folder is tried first.
    for (const std::string& out : outs)
        expect_refused({"--file=a", "--res=16384,16384", "--rep=1000000", "--out=" + out},
                       kCannotWrite, {out + ": "});
}

TEST_F(BadInput, AFullDeviceIsAnError) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--rep=1", "--res=8,8", "--out=/dev/full"}, kCannotWrite,
                   {"/dev/full: "});
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(BadInput, FullStandardOutputIsAnError) {
    const Outcome outcome = finish(start({"-h"}, "/dev/full"));
    EXPECT_EQ(outcome.exit_code, kCannotWrite);
    EXPECT_NE(outcome.err.find("standard output"), std::string::npos);
}

TEST_F(BadInput, TheSceneIsNeverOverwritten) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--res=8,8", "--out=a.x3d"}, kUsage, {"a.x3d"});
    expect_refused({"--file=a", "--res=8,8", "--json=./a.x3d"}, kUsage, {"a.x3d"});
    expect_refused({"--file=a", "--res=8,8", "--json=a.bmp"}, kUsage, {"a.bmp"});
    EXPECT_EQ(content("a.x3d"), kSmallScene);
}

TEST_F(BadInput, RaysThatCannotBeReadAreNamedWithTheirLine) {
    put("a.x3d", kSmallScene);
    put("rays", "0 0 10 0 0 -1\n0 0 10 0 0\n");
    expect_refused({"--file=a", "--rays=rays", "--out=answers"}, kRefused, {"rays: line 2: "});
    put("rays", "0 0 10 0 0 -1\n\n0 0 10 0 0 0\n");
    expect_refused({"--file=a", "--rays=rays", "--out=answers"}, kRefused, {"rays: line 3: "});
    expect_refused({"--file=a", "--rays=none", "--out=answers"}, kRefused, {"none: "});
}

TEST_F(BadInput, TooLittleMemoryIsAnErrorWithAMessage) {
#if defined(NUVO_SANITIZED)
    GTEST_SKIP() << "a sanitizer reserves more than any limit";
#endif
    put("a.x3d", kSmallScene);
    constexpr rlim_t kBytes = 200'000'000;  // the picture alone takes four times that
    const Outcome outcome = finish(start({"--file=a", "--rep=1", "--res=16384,16384"}, "", kBytes));
    EXPECT_EQ(outcome.exit_code, kCannotWrite);
    EXPECT_EQ(outcome.err, "nuvo: out of memory\n");
    EXPECT_EQ(files(), std::set<std::string>{"a.x3d"});
}

TEST_F(BadInput, AControlCharacterInANameDoesNotBreakTheLine) {
    expect_refused({"--file=two\nlines"}, kRefused, {"two?lines: "});
}

}  // namespace
}  // namespace nuvo::cli_test
