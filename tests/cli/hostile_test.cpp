// Hostile and broken files: every one ends in time, in little memory, with exit 0 or 3 and one
// clear message, never by a signal.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/wait.h>

#include <random>

#include "cli/program_runner.h"
#include "gzip.h"

namespace nuvo::cli_test {
namespace {

constexpr int kRefused = 3;
#if defined(NUVO_SANITIZED)
constexpr double kSeconds = 30;
constexpr long kKilobytes = 3'000'000;
#else
constexpr double kSeconds = 10;
constexpr long kKilobytes = 1'000'000;
#endif

std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    all.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

std::string bare(const std::string& nodes) { return "<Scene>" + nodes + "</Scene>"; }

class Hostile : public ProgramTest {
  protected:
    /// Renders `text` and returns how that ended.
    Outcome end_of(const std::string& text, std::vector<std::string> flags = {}) const {
        put("hostile.x3d", text);
        fs::remove(folder_ / "hostile.bmp");
        flags.insert(flags.end(), {"--file=hostile", "--res=64,64", "--rep=1", "--quiet"});
        const pid_t child = start(flags);
        int status = 0;
        rusage used{};
        EXPECT_EQ(::wait4(child, &status, 0, &used), child);
        // Processor time: what else runs on the machine is no fault of the program's.
        const auto seconds = [](const timeval& t) {
            return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
        };
        const double time = seconds(used.ru_utime) + seconds(used.ru_stime);
        const Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                              file_text(base_ / "stdout"), file_text(base_ / "stderr")};
        EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == kRefused)
            << outcome.exit_code << outcome.err;
        EXPECT_LT(time, kSeconds);
        EXPECT_LT(used.ru_maxrss, kKilobytes);
        if (outcome.exit_code == kRefused) {
            EXPECT_EQ(outcome.err.rfind("nuvo: hostile.x3d: ", 0), 0u) << outcome.err;
            EXPECT_EQ(outcome.err.find('\n') + 1, outcome.err.size()) << outcome.err;
            EXPECT_FALSE(exists("hostile.bmp"));
        }
        return outcome;
    }
    /// What is left out otherwise is refused by --strict.
    void expect_strict_refusal(const std::string& text, const std::string& part) const {
        EXPECT_EQ(end_of(text).exit_code, 0);
        expect_refusal(text, part, {"--strict"});
    }
    void expect_refusal(const std::string& text, const std::string& part,
                        const std::vector<std::string>& flags = {}) const {
        const Outcome outcome = end_of(text, flags);
        EXPECT_EQ(outcome.exit_code, kRefused);
        EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " not in " << outcome.err;
    }
};

TEST_F(Hostile, AMillionNestedElements) {
    expect_refusal(bare(repeated("<Group>", 1'000'000) + repeated("</Group>", 1'000'000)),
                   "nested too deeply (limit 4096)");
}

TEST_F(Hostile, AMillionUnclosedTags) {
    expect_refusal(bare(repeated("<Group>", 1'000'000)), "nested too deeply (limit 4096)");
    expect_refusal(repeated("<Group ", 1'000'000), "line 1");
    expect_refusal(repeated("<", 1'000'000), "line 1");
    expect_refusal("<Scene>" + repeated("<Shape/>", 100'000), "never closed");
}

TEST_F(Hostile, NestedAsDeeplyAsTheFlagsAllow) {
#if defined(NUVO_SANITIZED)
    GTEST_SKIP() << "a sanitizer makes the frames of the stack many times as large";
#endif
    // The largest --max-depth, for elements and by way of USE: the stack bears it.
    const std::size_t depth = 8192;
    const Outcome nested = end_of(bare(repeated("<Group>", depth - 3) + "<Shape><Sphere/></Shape>" +
                                       repeated("</Group>", depth - 3)),
                                  {"--max-depth=8192"});
    EXPECT_EQ(nested.exit_code, 0) << nested.err;
    EXPECT_EQ(
        end_of(bare(repeated("<Group>", depth) + repeated("</Group>", depth)), {"--max-depth=8192"})
            .exit_code,
        kRefused);
    std::string uses = "<Group DEF='g0'><Shape><Sphere/></Shape></Group>";
    for (int i = 1; i < 4000; ++i)
        uses += "<Transform DEF='g" + std::to_string(i) + "'><" +
                std::string(i == 1 ? "Group" : "Transform") + " USE='g" + std::to_string(i - 1) +
                "'/></Transform>";
    // 8 million elements when it is expanded.
    EXPECT_EQ(end_of(bare(uses), {"--max-depth=8192"}).exit_code, 0);
    EXPECT_EQ(end_of(bare(uses), {"--max-depth=8192", "--max-elements=7000000"}).exit_code,
              kRefused);
}

TEST_F(Hostile, UseDoublingToAHundredMillionShapes) {
    std::string nodes = "<Group DEF='g0'><Shape><Sphere/></Shape></Group>";
    for (int i = 1; i <= 27; ++i) {
        const std::string use = "<Group USE='g" + std::to_string(i - 1) + "'/>";
        nodes += "<Group DEF='g" + std::to_string(i) + "'>" + use + use + "</Group>";
    }
    expect_refusal(bare(nodes), "exceed the limit of");
}

TEST_F(Hostile, AMillionShapesInOnePlace) {
    std::string nodes = "<Group DEF='g0'><Shape><Cylinder/></Shape></Group>";
    for (int i = 1; i <= 13; ++i) {
        const std::string use = "<Group USE='g" + std::to_string(i - 1) + "'/>";
        nodes += "<Group DEF='g" + std::to_string(i) + "'>" + use + use + "</Group>";
    }
    EXPECT_EQ(end_of(bare(nodes)).exit_code, kRefused);  // 16383 cylinders: too many points
    nodes.replace(nodes.find("Cylinder"), 8, "Sphere");
    EXPECT_EQ(end_of(bare(nodes)).exit_code, 0);
}

TEST_F(Hostile, UseInsideItsOwnDefinition) {
    expect_refusal(bare("<Group DEF='a'><Group USE='a'/></Group>"), "inside its own DEF");
    expect_refusal(
        bare("<Transform DEF='a'><Group DEF='b'><Transform USE='a'/></Group></Transform>"),
        "inside its own DEF");
}

TEST_F(Hostile, InlinesOfItself) {
    expect_refusal(bare("<Inline url='hostile.x3d'/>"), "Inlines it");
}

TEST_F(Hostile, EntityBombs) {
    std::string bomb = "<!DOCTYPE X3D [<!ENTITY a0 'lol'>";
    for (int i = 1; i < 30; ++i)
        bomb += "<!ENTITY a" + std::to_string(i) + " '" +
                repeated("&a" + std::to_string(i - 1) + ";", 10) + "'>";
    bomb += "]>";
    EXPECT_EQ(end_of(bomb + bare("&a29;<Shape><Sphere/></Shape>")).exit_code, 0);
    expect_strict_refusal(bomb + bare("<Shape><Sphere radius='&a29;'/></Shape>"), "Sphere@radius");
}

TEST_F(Hostile, ExternalEntitiesOpenNothing) {
    put("secret.txt", "2");
    put("secret.dtd", "<!ENTITY e '2'>");
    const int watch = ::inotify_init1(IN_NONBLOCK);
    ASSERT_GE(watch, 0);
    for (const char* name : {"secret.txt", "secret.dtd"})
        ASSERT_GE(::inotify_add_watch(watch, (folder_ / name).c_str(), IN_OPEN | IN_ACCESS), 0);
    const std::string subset = "<!DOCTYPE X3D SYSTEM 'secret.dtd' [<!ENTITY % p SYSTEM 'file://" +
                               (folder_ / "secret.dtd").string() +
                               "'>%p;<!ENTITY e SYSTEM 'secret.txt'>]>";
    EXPECT_EQ(end_of(subset + bare("&e;<Shape><Sphere/></Shape>")).exit_code, 0);
    expect_strict_refusal(subset + bare("<Shape><Sphere radius='&e;'/></Shape>"), "Sphere@radius");
    char events[4096];
    EXPECT_EQ(::read(watch, events, sizeof events), -1);  // nothing has been opened,
    EXPECT_FALSE(file_text(folder_ / "secret.txt").empty());
    EXPECT_GT(::read(watch, events, sizeof events), 0);  // and that would have been seen
    ::close(watch);
}

TEST_F(Hostile, NumbersBeyondAllBounds) {
    const auto sphere = [](const std::string& radius) {
        return bare("<Shape><Sphere radius='" + radius + "'/></Shape>");
    };
    for (const char* number : {"nan", "-nan", "inf", "-inf", "1e400", "-1e400", "0x10", "1e", "--1",
                               "1e99999999999999999999"})
        expect_strict_refusal(sphere(number), "Sphere@radius");
    expect_strict_refusal(sphere(repeated("9", 100'000)), "beyond the range of double");
    for (const char* number : {"1e-400", "1e308", "4.9e-324", "1e150"})
        EXPECT_EQ(end_of(sphere(number)).exit_code, 0) << number;
    const auto faces = [](const std::string& index) {
        return bare("<Shape><IndexedFaceSet coordIndex='" + index +
                    "'><Coordinate point='0 0 0 1 0 0 0 1 0'/></IndexedFaceSet></Shape>");
    };
    for (const char* index : {"0 1 2147483647", "0 1 2147483648", "0 1 4294967296",
                              "0 1 -2147483648", "0 1 99999999999999999999"})
        expect_strict_refusal(faces(index), "IndexedFaceSet@coordIndex");
}

TEST_F(Hostile, PlacesBeyondDouble) {
    expect_strict_refusal(bare(repeated("<Transform scale='1e100 1e100 1e100'>", 4) +
                               "<Shape><Box/></Shape>" + repeated("</Transform>", 4)),
                          "beyond the range of double");
    EXPECT_EQ(
        end_of(bare(repeated("<Transform scale='1e-100 1e-100 1e-100'>", 4) +
                    "<Shape><Box/></Shape><Shape><Sphere/></Shape>" + repeated("</Transform>", 4)))
            .exit_code,
        0);
    EXPECT_EQ(end_of(bare("<Transform scale='0 1 0'><Shape><Box/></Shape><Shape><Sphere/></Shape>"
                          "<PointLight/><Viewpoint/></Transform>"))
                  .exit_code,
              0);
}

TEST_F(Hostile, AFaceOfAHundredThousandCornersAndAPointOfAHundredThousandFaces) {
    std::string comb;
    for (int i = 0; i < 100'000; ++i) comb += i % 2 == 0 ? "0 1 " : "2 3 ";
    const std::string points = "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 5'/></IndexedFaceSet>";
    expect_refusal(bare("<Shape><IndexedFaceSet convex='false' coordIndex='" + comb + "'>" +
                        points + "</Shape>"),
                   "limit of 20000000");
    expect_refusal(bare("<Shape><IndexedFaceSet creaseAngle='1' coordIndex='" +
                        repeated("0 1 2 -1 0 2 3 -1 ", 50'000) + "'>" + points + "</Shape>"),
                   "limit of 20000000");
    // Where convex is true it is a fan; a ray meets its triangles all at once.
    comb.resize(40'000);
    end_of(bare("<Shape><IndexedFaceSet coordIndex='" + comb + "'>" + points + "</Shape>"));
}

TEST_F(Hostile, AGridLargerThanItsHeights) {
    expect_strict_refusal(
        bare("<Shape><ElevationGrid xDimension='2147483647' zDimension='2147483647' "
             "height='1'/></Shape>"),
        "ElevationGrid@height");
}

TEST_F(Hostile, GzipBombs) {
    std::string bomb;
    const std::string blanks = packed(std::string(10'000'000, ' '));
    for (int i = 0; i < 100; ++i) bomb += blanks;
    ASSERT_LT(bomb.size(), 1'000'000u);
    expect_refusal(bomb, "unpacks to more bytes than allowed (limit 128000000)");
    // Packed twice, cut off, damaged.
    expect_refusal(packed(packed(bare(""))), "line 1");
    expect_refusal(bomb.substr(0, 5000), "packed by gzip, but cut off");
    bomb[2000] = static_cast<char>(~bomb[2000]);
    expect_refusal(bomb, "packed by gzip, but damaged");
}

TEST_F(Hostile, AMillionSpheresInAPackedFile) {
    EXPECT_EQ(end_of(packed(bare(repeated("<Shape><Appearance><Material diffuseColor='1 0 0'/>"
                                          "</Appearance><Sphere/></Shape>",
                                          200'000))))
                  .exit_code,
              0);
    EXPECT_EQ(end_of(packed(bare(repeated("<a/>", 1'000'000)))).exit_code, 0);
    expect_refusal(packed(bare(repeated("<a/>", 10'000'001))),
                   "too many elements (limit 10000000)");
    expect_refusal(packed(bare("<a " + repeated("b='' ", 1000) + "/>")), "the attribute b twice");
}

TEST_F(Hostile, RandomBytes) {
    const unsigned seed = 20261122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 20; ++round) {
        std::string bytes;
        for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(random() % 256);
        EXPECT_EQ(end_of(bytes).exit_code, kRefused);
        end_of("<Scene>" + bytes + "</Scene>");
        end_of("\x1f\x8b\x08" + bytes);
    }
    // A megabyte of them.
    std::string bytes;
    for (int i = 0; i < 1'000'000; ++i) bytes += static_cast<char>(random() % 256);
    EXPECT_EQ(end_of(bytes).exit_code, kRefused);
}

TEST_F(Hostile, EveryPrefixOfAValidFile) {
    const std::string text =
        "<?xml version='1.0'?>\n<!DOCTYPE X3D PUBLIC 'a' 'b'>\n<X3D version='3.3'><Scene>"
        "<Shape><Appearance><Material/></Appearance><Box size='1 2 3'/></Shape></Scene></X3D>";
    EXPECT_EQ(end_of(text).exit_code, 0);
    for (std::size_t size = 0; size < text.size(); ++size)
        EXPECT_EQ(end_of(text.substr(0, size)).exit_code, kRefused) << size;
}

}  // namespace
}  // namespace nuvo::cli_test
