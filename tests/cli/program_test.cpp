#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "cli/program_runner.h"
#include "nuvo/app/options.h"

namespace nuvo::cli_test {
namespace {

using Program = ProgramTest;

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(Program, HelpIsTheTableOfFlags) {
    for (const char* help : {"-h", "--help"}) {
        const Outcome outcome = run({help, "--file=missing"});
        EXPECT_EQ(outcome.exit_code, 0);
        EXPECT_EQ(outcome.out, app::help_text());
        EXPECT_EQ(outcome.err, "");
    }
}

TEST_F(Program, VersionTellsWhatItIsMadeOf) {
    const Outcome outcome = run({"--version"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out.rfind("nuvo ", 0), 0u);
    EXPECT_EQ(outcome.out.substr(0, outcome.out.find('\n')).find(' ', 5), std::string::npos);
    for (const char* part : {"\ncommit     ", "\ncompiler   ", "\nkernels    ", "sse2", "Boost 1.",
                             "NLopt 2.", "GEOS 3.", "Highway 1.", "zlib 1.", "libpng 1.6."})
        EXPECT_TRUE(contains(outcome.out, part)) << part << "\n" << outcome.out;
}

TEST_F(Program, APictureInAPipeIsAllThatIsThere) {
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"a.x3d", "--rep=1", "--res=20x10", "--out=p.bmp"}).exit_code, 0);
    const Outcome piped = run({"a.x3d", "--rep=1", "--res=20x10", "--out=-", "--counters"});
    EXPECT_EQ(piped.exit_code, 0);
    EXPECT_TRUE(piped.out == content("p.bmp"));
    EXPECT_TRUE(contains(piped.err, "waited") && contains(piped.err, "picture    standard output"))
        << piped.err;
    // The scene from standard input, packed or not; the picture has no place but standard output.
    const Outcome filtered = run({"-", "--rep=1", "--res=20x10", "--quiet"}, "a.x3d");
    EXPECT_EQ(filtered.err, "");
    EXPECT_TRUE(filtered.out == content("p.bmp"));
    const Outcome json = run({"-", "--rep=1", "--res=20x10", "--out=q.bmp", "--json=-"}, "a.x3d");
    EXPECT_EQ(nlohmann::json::parse(json.out)["scene"]["shapes"], 2);
    EXPECT_TRUE(content("q.bmp") == content("p.bmp"));
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "p.bmp", "q.bmp"}));
}

TEST_F(Program, StandardInputIsNamedAndHeldToTheLimit) {
    put("a.x3d", kSmallScene);
    const Outcome large = run({"-", "--res=4,4", "--max-file-size=100"}, "a.x3d");
    EXPECT_EQ(large.exit_code, 3);
    EXPECT_TRUE(contains(large.err, "nuvo: standard input: file: is too large (limit 100)"));
    put("b.x3d", "<X3D><Scene>");
    const Outcome broken = run({"-", "--res=4,4"}, "b.x3d");
    EXPECT_EQ(broken.exit_code, 3);
    EXPECT_EQ(broken.err.rfind("nuvo: standard input: ", 0), 0u) << broken.err;
    EXPECT_EQ(broken.out, "");
    const Outcome full = finish(start({"a.x3d", "--rep=1", "--res=4,4", "--out=-"}, "/dev/full"));
    EXPECT_EQ(full.exit_code, 4);
    EXPECT_TRUE(contains(full.err, "standard output: cannot write")) << full.err;
}

/// Bytes of the pixel rows of a BMP whose width is a multiple of 4, top row first.
std::vector<std::string> rows_of(const std::string& bmp, std::size_t width) {
    std::vector<std::string> rows;
    for (std::size_t at = bmp.size(); at > 54; at -= 3 * width)
        rows.push_back(bmp.substr(at - 3 * width, 3 * width));
    return rows;
}

TEST_F(Program, SamplesAreTheMeanOfTheShiftedPictures) {
    // A view in parallel: moved by an n-th of a pixel it is the picture shifted, in exact numbers.
    constexpr int kWidth = 32, kHeight = 16, kSamples = 4;
    const auto scene = [](double x, double y) {
        return "<X3D version='3.3'><Scene><OrthoViewpoint fieldOfView='-4 -2 4 2' position='" +
               std::to_string(x) + " " + std::to_string(y) +
               " 10'/><NavigationInfo headlight='false'/>"
               "<DirectionalLight direction='-1 -1 -1'/><Background skyColor='0.1 0.4 0.9'/>"
               "<Shape><Appearance><Material diffuseColor='1 0.5 0.2'/></Appearance>"
               "<Sphere radius='1.3'/></Shape></Scene></X3D>";
    };
    std::vector<std::vector<int>> sums(kHeight, std::vector<int>(3 * kWidth));
    constexpr double kPixel = 8.0 / kWidth;
    for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) {
            put("s.x3d", scene(((i + 0.5) / kSamples - 0.5) * kPixel,
                               (0.5 - (j + 0.5) / kSamples) * kPixel));
            ASSERT_EQ(run({"s.x3d", "--rep=1", "--res=32,16"}).exit_code, 0);
            const auto rows = rows_of(content("s.bmp"), kWidth);
            for (std::size_t y = 0; y < kHeight; ++y)
                for (std::size_t b = 0; b < 3 * kWidth; ++b)
                    sums[y][b] += static_cast<unsigned char>(rows[y][b]);
        }
    }
    put("a.x3d", scene(0, 0));
    for (const char* profile : {"--profile=exact", "--profile=fast", "--threads=2"}) {
        ASSERT_EQ(run({"a.x3d", "--rep=2", "--res=32,16", "--samples=4", profile, "--json=a.json"})
                      .exit_code,
                  0);
        const auto rows = rows_of(content("a.bmp"), kWidth);
        std::set<int> seen;
        for (std::size_t y = 0; y < kHeight; ++y)
            for (std::size_t b = 0; b < 3 * kWidth; ++b) {
                const int mean = (2 * sums[y][b] + 16) / 32;  // of 16, halves upwards
                ASSERT_EQ(static_cast<unsigned char>(rows[y][b]), mean) << y << " " << b;
                seen.insert(mean);
            }
        EXPECT_GT(seen.size(), 20u);  // edges are mixed, not merely copied
        const auto json = nlohmann::json::parse(content("a.json"));
        EXPECT_EQ(json["counts"]["primary_rays"], kWidth * kHeight * 16);
        EXPECT_EQ(json["resolution"]["width"], kWidth);
    }
}

TEST_F(Program, TheCameraStandsWhereItIsTold) {
    // What a Viewpoint says: at 10 0 0, turned left by a quarter, looks along -x.
    const std::string shapes =
        "<DirectionalLight direction='-1 -0.3 -0.2'/><Shape><Appearance><Material/></Appearance>"
        "<Box size='1 2 3'/></Shape></Scene></X3D>";
    put("a.x3d", "<X3D version='3.0'><Scene><Viewpoint position='0 0 10'/>" + shapes);
    put("b.x3d",
        "<X3D version='3.0'><Scene><Viewpoint position='10 0 0' orientation='0 1 0 "
        "1.5707963267948966' fieldOfView='0.5'/>" +
            shapes);
    const std::string half_radian = "--fov=28.64788975654116";
    ASSERT_EQ(run({"b.x3d", "--rep=1", "--res=40,40"}).exit_code, 0);
    ASSERT_EQ(run({"a.x3d", "--rep=1", "--res=40,40", "--from=10,0,0", half_radian, "--out=f.bmp"})
                  .exit_code,
              0);
    ASSERT_EQ(run({"a.x3d", "--rep=1", "--res=40,40", "--from=10,0,0", "--at=2,0,0", half_radian,
                   "--out=g.bmp"})
                  .exit_code,
              0);
    EXPECT_TRUE(content("f.bmp") == content("b.bmp"));  // the box's middle is the origin
    EXPECT_TRUE(content("g.bmp") == content("b.bmp"));
    expect_refused({"a.x3d", "--res=4,4", "--from=1,2,3", "--at=1,2,3", "--out=n.bmp"}, 2,
                   {"--at=1,2,3"});
}

TEST_F(Program, ThePictureLandsBesideTheSceneHoweverItIsNamed) {
    put("a.x3d", kSmallScene);
    fs::create_directory(folder_ / "sub");
    fs::copy_file(folder_ / "a.x3d", folder_ / "sub" / "b.x3d");
    EXPECT_EQ(run({"--file=a", "--rep=1", "--res=13,7"}).exit_code, 0);
    EXPECT_EQ(run({"--file=sub/b.x3d", "--rep=1", "--res=13,7"}).exit_code, 0);
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "a.bmp", "sub"}));
    const std::string bytes = content("a.bmp");
    EXPECT_EQ(bytes.size(), 54u + 7u * 40u);  // rows of 39 bytes, padded
    EXPECT_EQ(bytes.substr(0, 2), "BM");
    EXPECT_EQ(static_cast<unsigned char>(bytes[18]), 13u);
    EXPECT_EQ(static_cast<unsigned char>(bytes[22]), 7u);
    EXPECT_TRUE(bytes == content("sub/b.bmp"));
}

TEST_F(Program, ANameThatExistsIsTakenAsGiven) {
    put("a", kSmallScene);
    put("a.x3d", "not this one");
    EXPECT_EQ(run({"--file=a", "--rep=1", "--res=4,4"}).exit_code, 0);
    EXPECT_TRUE(exists("a.bmp"));
}

TEST_F(Program, OutReplacesWhatIsThere) {
    put("a.x3d", kSmallScene);
    put("picture", "old");
    EXPECT_EQ(run({"--file=a", "--rep=1", "--res=4,4", "--out=picture"}).exit_code, 0);
    EXPECT_EQ(content("picture").size(), 54u + 4u * 12u);
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "picture"}));
}

TEST_F(Program, TheEndingOfOutChoosesTheFormat) {
    put("a.x3d", kSmallScene);
    EXPECT_EQ(run({"--file=a", "--res=40,30", "-compare", "--out=p.png"}).exit_code, 0);
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "p.png", "p-difference.png"}));
    for (const char* name : {"p.png", "p-difference.png"})
        EXPECT_EQ(content(name).substr(0, 8), "\x89PNG\r\n\x1a\n") << name;
    // Refused before anything is read or drawn: the scene is missing, too.
    for (const char* out : {"p.jpg", "p.bmp.gz", "p."})
        expect_refused({"--file=missing", std::string("--out=") + out}, 2,
                       {std::string("--out=") + out, ".bmp or .png"});
}

TEST_F(Program, TheReportSaysWhatTheThesisSays) {
    put("a.x3d", kSmallScene);
    const Outcome outcome = run({"--file=a", "--rep=3", "--res=16,16"});
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* part : {"2 shapes, 2 triangles, 1 sphere, 2 lights", "depth ", " voxel",
                             "build", "trace", "average", "3 repetitions", "a.bmp"})
        EXPECT_TRUE(contains(outcome.out, part)) << part << "\n" << outcome.out;
}

TEST_F(Program, QuietSilencesTheReportButNoWarning) {
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape><Text string='\"hello\"'/></Shape></Scene></X3D>");
    const Outcome outcome = run({"--file=a", "--rep=1", "--res=4,4", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(contains(outcome.err, "nuvo: warning: "));
    EXPECT_TRUE(contains(outcome.err, "Text"));
}

TEST_F(Program, TheOctreeIsPrintedBeforeTheReport) {
    put("a.x3d", grid_scene(3));
    const Outcome outcome =
        run({"--file=a", "--rep=1", "--res=4,4", "-showoctree", "--max-objects=2"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_GT(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 12);
    EXPECT_EQ(outcome.out.rfind("uniform octree\n", 0), 0u);
    EXPECT_TRUE(contains(outcome.out, "\nscene "));
}

TEST_F(Program, TheSameCommandTwiceGivesTheSameBytesAndSoDoesTheOtherType) {
    put("a.x3d", grid_scene(4));
    for (const char* profile : {"--profile=exact", "--profile=thesis"})
        for (const char* type : {"uniform", "nonuniform"})
            for (const char* time : {"1", "2"})
                ASSERT_EQ(run({"--file=a", "--rep=2", "--res=40,30", profile,
                               std::string("--type=") + type,
                               std::string("--out=") + (profile + 10) + type + time})
                              .exit_code,
                          0);
    for (const char* name :
         {"exactuniform", "exactnonuniform", "thesisuniform", "thesisnonuniform"})
        EXPECT_TRUE(content(std::string(name) + "1") == content(std::string(name) + "2")) << name;
    EXPECT_TRUE(content("exactuniform1") == content("exactnonuniform1"));
}

TEST_F(Program, JsonHoldsCountsAndEveryRawTime) {
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"--file=a", "--rep=4", "--res=20,10", "--json=a.json"}).exit_code, 0);
    const auto json = nlohmann::json::parse(content("a.json"));
    EXPECT_EQ(json["file"], "a.x3d");
    EXPECT_EQ(json["repetitions"], 4);
    EXPECT_EQ(json["build_seconds"].size(), 4u);
    EXPECT_EQ(json["trace_seconds"].size(), 4u);
    EXPECT_EQ(json["counts"]["primary_rays"], 200);
    EXPECT_EQ(json["scene"]["shapes"], 2);
    EXPECT_EQ(json["scene"]["triangles"], 2);
    EXPECT_EQ(json["scene"]["spheres"], 1);
    EXPECT_EQ(json["tree"]["voxels"].get<int>() % 7, 1);  // each cut turns one leaf into eight
    for (const char* key :
         {"parse_seconds", "write_seconds", "user_seconds", "system_seconds", "wall_seconds"})
        EXPECT_GE(json[key].get<double>(), 0) << key;
    for (const char* key :
         {"type", "costs", "leaves", "walk", "step", "precision", "bias", "midpoint"})
        EXPECT_TRUE(json["profile"].contains(key)) << key;
}

TEST_F(Program, JsonTellsWhatMadeTheFigures) {
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape><Text/></Shape><Shape><Sphere/></Shape></Scene></X3D>");
    const std::vector<std::string> arguments{"a.x3d", "--rep=1", "--res=8x8", "--json=a.json"};
    ASSERT_EQ(run(arguments).exit_code, 0);
    const auto json = nlohmann::json::parse(content("a.json"));
    const auto& provenance = json["provenance"];
    EXPECT_EQ(provenance["arguments"], arguments);
    EXPECT_TRUE(contains(run({"--version"}).out, provenance["commit"].get<std::string>()));
    EXPECT_TRUE(contains(provenance["libraries"]["Boost"].get<std::string>(), "1."));
    EXPECT_GE(provenance["cores"], 1);
    EXPECT_EQ(provenance["date"].get<std::string>().size(), 20u);
    EXPECT_EQ(json["warnings"].size(), json["scene"]["warnings"].get<std::size_t>());
    EXPECT_TRUE(contains(json["warnings"][0].get<std::string>(), "Text"));
    // More than the picture itself, and no more than any test may take.
    EXPECT_GT(json["peak_memory_bytes"], 8 * 8 * 3);
    EXPECT_LT(json["peak_memory_bytes"], 1'000'000'000);
    EXPECT_EQ(json["samples"], 1);
}

// Each number is of what its part holds; together they are what the system counts.
TEST_F(Program, JsonTellsTheMemoryByPart) {
#ifdef NUVO_SANITIZED
    GTEST_SKIP() << "a sanitizer holds memory of its own";
#endif
    constexpr int kSide = 400;
    std::string heights;
    for (int i = 0; i < kSide * kSide; ++i) heights += std::to_string(i * i % 7) + ' ';
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape><ElevationGrid xDimension='400' "
        "zDimension='400' height='" +
            heights + "'/></Shape></Scene></X3D>");
    for (const std::string profile : {"exact", "fast"}) {
        ASSERT_EQ(run({"a.x3d", "--profile=" + profile, "--rep=1", "--res=64x64", "--threads=1",
                       "--json=a.json"})
                      .exit_code,
                  0);
        const auto json = nlohmann::json::parse(content("a.json"));
        const auto& memory = json["memory"];
        double sum = 0;
        for (const char* part : {"peak_start_bytes", "scene_bytes", "primitives_bytes",
                                 "tracer_bytes", "picture_bytes"})
            sum += memory[part].get<double>();
        if (profile == "exact") {
            sum += json["tree"]["memory_bytes"].get<double>();
        } else {
            for (const char* part :
                 {"structure_bytes", "corner_bytes", "table_bytes", "kept_bytes"})
                sum += json["tiles"][part].get<double>();
        }
        const double peak = memory["peak_tracing_bytes"];
        // The rest is what building holds for a while, and what lies between blocks in use.
        EXPECT_GT(sum / peak, 0.6) << profile << ": " << memory.dump();
        EXPECT_LT(sum / peak, 1.1) << profile << ": " << memory.dump();
        EXPECT_LE(memory["peak_reading_bytes"], memory["peak_building_bytes"]);
        EXPECT_LE(memory["peak_building_bytes"], peak);
        EXPECT_LE(peak, json["peak_memory_bytes"].get<double>());
    }
}

TEST_F(Program, CountersAreAsked) {
    put("a.x3d", kSmallScene);
    const std::vector<std::string> plain{"--file=a", "--rep=1", "--res=4,4"};
    EXPECT_FALSE(contains(run(plain).out, "voxel searches"));
    std::vector<std::string> counting = plain;
    counting.push_back("--counters");
    EXPECT_TRUE(contains(run(counting).out, "voxel searches"));
}

TEST_F(Program, CompareFindsNoDifferenceInTheExactProfile) {
    put("a.x3d", grid_scene(4));
    for (const auto& [flag, pairs] : {std::pair{"-compare", 1}, std::pair{"-compare=brute", 3}}) {
        const Outcome outcome = run({"--file=a", "--res=48,36", flag});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
        std::istringstream lines(outcome.out);
        int equal_pairs = 0;
        for (std::string line; std::getline(lines, line);)
            equal_pairs += contains(line, " / ") && contains(line, " 0 differing pixels");
        EXPECT_EQ(equal_pairs, pairs) << outcome.out;
        // The cost of brute force is said before it is paid: a grid of 64 shapes.
        const bool forecast = contains(outcome.out, "brute force every ray against all 64 ");
        EXPECT_EQ(forecast, pairs == 3) << outcome.out;
    }
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "a.bmp", "a-difference.bmp"}));
    const std::string pixels = content("a-difference.bmp").substr(54);
    EXPECT_EQ(pixels, std::string(48 * 36 * 3, '\0'));
}

TEST_F(Program, CompareEndsWithOneWherePicturesDiffer) {
    put("a.x3d", grid_scene(4));
    // A step of 10^9 voxels leaves the tree at the first face: most spheres are never reached.
    const Outcome outcome = run({"--file=a", "--res=48,36", "-compare=brute", "--profile=thesis",
                                 "--max-objects=1", "--step=1e9", "--out=c.bmp", "--json=c.json"});
    EXPECT_EQ(outcome.exit_code, 1) << outcome.out << outcome.err;
    EXPECT_NE(content("c-difference.bmp").substr(54), std::string(48 * 36 * 3, '\0'));
    const auto json = nlohmann::json::parse(content("c.json"));
    ASSERT_EQ(json["pairs"].size(), 3u);
    EXPECT_GT(json["pairs"][1]["differing_pixels"], 0);  // uniform against brute force
    EXPECT_GT(json["pairs"][1]["max_difference"], 0);
}

TEST_F(Program, TheErrorIsThatOfThePictureAgainstTheExactProfiles) {
    put("a.x3d", grid_scene(4));
    const std::vector<std::string> flags{"--file=a", "--rep=1", "--res=48,36", "--json=a.json"};
    auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), flags.begin(), flags.end());
        EXPECT_EQ(run(more).exit_code, 0);
        return nlohmann::json::parse(content("a.json"));
    };
    EXPECT_FALSE(with({}).contains("error"));
    for (const char* profile : {"--profile=exact", "--profile=fast"})
        EXPECT_EQ(with({"--error", profile})["error"]["differing_pixels"], 0) << profile;
    // As in CompareEndsWithOneWherePicturesDiffer.
    const auto wrong =
        with({"--error", "--profile=thesis", "--max-objects=1", "--step=1e9"})["error"];
    EXPECT_GT(wrong["differing_pixels"], 0);
    EXPECT_GT(wrong["rms"], 0);
    EXPECT_GT(wrong["psnr_db"], 0);
}

TEST_F(Program, AShapeThatDrawsNothingStillCounts) {
    put("a.x3d",
        "<X3D version='3.0'><Scene><Shape/><Shape DEF='S'><Sphere/></Shape>"
        "<Transform translation='4 0 0'><Shape USE='S'/></Transform></Scene></X3D>");
    put("rays", "0 0 10 0 0 -1\n4 0 10 0 0 -1\n");
    EXPECT_EQ(run({"--file=a", "--rays=rays"}).out, "1 1 0 9\n1 2 0 9\n");
}

TEST_F(Program, ASceneWithoutShapesIsItsBackground) {
    put("a.x3d", "<Scene><Background skyColor='0 0 1' groundColor='0 0 1'/></Scene>");
    for (const char* type : {"--type=uniform", "--type=nonuniform"}) {
        ASSERT_EQ(run({"--file=a", "--rep=1", "--res=4,1", type, "--json=a.json"}).exit_code, 0);
        std::string blue;
        for (int i = 0; i < 4; ++i) blue += std::string("\xff\0\0", 3);
        EXPECT_EQ(content("a.bmp").substr(54), blue);
        EXPECT_TRUE(nlohmann::json::accept(content("a.json")));
    }
}

/// True once the process has a handler for `signal`, so that the test need not guess a time.
bool catches(pid_t process, int signal) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("SigCgt:", 0) == 0)
            return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    return false;
}

TEST_F(Program, ASignalLeavesTheOldPictureAndNoOther) {
    put("a.x3d", grid_scene(4));
    put("a.bmp", "old");
    const std::pair<int, int> cases[] = {
        {SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}, {SIGQUIT, 131}, {SIGKILL, -1}};
    for (const auto& [signal, exit_code] : cases) {
        const pid_t child = start({"--file=a", "--res=400,400", "--rep=1000000"});
        for (int i = 0; i < 1000 && !catches(child, SIGINT); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // into the rendering
        ASSERT_EQ(::kill(child, signal), 0);
        EXPECT_EQ(finish(child).exit_code, exit_code);
        EXPECT_EQ(content("a.bmp"), "old");
        EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "a.bmp"}));
    }
}

}  // namespace
}  // namespace nuvo::cli_test
