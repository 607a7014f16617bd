// --profile=fast, as the user meets it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program_runner.h"
#include "nuvo/app/choices.h"

namespace nuvo::cli_test {
namespace {

constexpr int kUsage = 2;

class Fast : public ProgramTest {
  protected:
    /// The picture's bytes.
    std::string picture(std::vector<std::string> flags) const {
        flags.insert(flags.end(), {"--file=a", "--rep=1", "--out=picture.bmp"});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return content("picture.bmp");
    }
};

std::string isa_flag(InstructionSet isa) {
    return "--isa=" + std::string(app::name_of(app::kInstructionSets, isa));
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(Fast, ThePictureIsTheExactOneToTheByteHoweverItIsMade) {
    for (const std::string& scene : {std::string(kSmallScene), grid_scene(4)}) {
        put("a.x3d", scene);
        const std::string expected = picture({"--res=61,47"});
        for (const char* type : {"--type=uniform", "--type=nonuniform"})
            for (const char* threads : {"--threads=0", "--threads=1", "--threads=7"})
                for (const InstructionSet isa : supported_instruction_sets())
                    EXPECT_TRUE(picture({"--res=61,47", "--profile=fast", type, threads,
                                         isa_flag(isa)}) == expected)
                        << type << threads << isa_flag(isa);
        EXPECT_TRUE(picture({"--res=61,47", "--tracer=tiles"}) == expected);
        EXPECT_TRUE(picture({"--res=61,47", "--profile=fast", "--tracer=serial"}) == expected);
    }
}

TEST_F(Fast, CompareStandsBesideTheSerialTracerAndBruteForce) {
    put("a.x3d", grid_scene(4));
    const Outcome outcome =
        run({"--file=a", "--res=48,36", "-compare=brute", "--profile=fast", "--json=c.json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    const auto json = nlohmann::json::parse(content("c.json"));
    std::vector<std::string> names;
    for (const auto& pass : json["passes"]) names.push_back(pass["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"uniform", "nonuniform", "serial", "brute force"}));
    EXPECT_TRUE(json["passes"][0].contains("tiles") && json["passes"][1].contains("tiles"));
    EXPECT_TRUE(json["passes"][2].contains("tree"));
    ASSERT_EQ(json["pairs"].size(), 6u);
    for (const auto& pair : json["pairs"]) EXPECT_EQ(pair["differing_pixels"], 0) << pair;
}

TEST_F(Fast, RaysAreAnsweredAsTheExactProfileAnswers) {
    put("a.x3d", kSmallScene);
    std::string rays;
    for (int i = -20; i < 20; ++i)
        for (int k = -20; k < 20; ++k)
            rays += std::to_string(0.15 * i) + " " + std::to_string(0.1 * k) + " 10 0 0.01 -1\n";
    put("rays", rays);
    const std::string expected = run({"--file=a", "--rays=rays"}).out;
    EXPECT_TRUE(contains(expected, "\n1 0 0 ") && contains(expected, "\n1 1 0 ") &&
                contains(expected, "\n0 -1 -1 inf"));
    for (const char* type : {"--type=uniform", "--type=nonuniform"}) {
        const Outcome outcome = run({"--file=a", "--rays=rays", "--profile=fast", type});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_TRUE(outcome.out == expected) << type;
    }
}

TEST_F(Fast, TheReportSaysHowThePictureWasMade) {
    put("a.x3d", grid_scene(3));
    const Outcome outcome = run({"--file=a", "--rep=2", "--res=40,30", "--profile=fast",
                                 "--threads=2", "--isa=sse2", "--counters"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* part : {"profile    --profile=fast --tracer=tiles --back-faces",
                             "as measured on the scene", "27 spheres", " references, ",
                             "tiles      2 threads, sse2, ", "MB of tables", "stages     tables",
                             "counts     1200 primary and ", "wall       build ", "2 repetitions"})
        EXPECT_TRUE(contains(outcome.out, part)) << part << "\n" << outcome.out;
}

TEST_F(Fast, TheRaysAreCountedAsTheSerialTracerCountsThem) {
    put("a.x3d", grid_scene(4));
    for (const char* profile : {"exact", "fast"})
        ASSERT_EQ(run({"--file=a", "--rep=1", "--res=64,48", std::string("--profile=") + profile,
                       std::string("--json=") + profile})
                      .exit_code,
                  0);
    const auto exact = nlohmann::json::parse(content("exact"));
    const auto fast = nlohmann::json::parse(content("fast"));
    EXPECT_EQ(fast["counts"]["primary_rays"], 64 * 48);
    EXPECT_GT(fast["counts"]["shadow_rays"], 0);
    EXPECT_EQ(fast["counts"]["shadow_rays"], exact["counts"]["shadow_rays"]);
    EXPECT_EQ(fast["counts"].size(), 2u);
    EXPECT_FALSE(fast.contains("tree"));
    EXPECT_GT(fast["tiles"]["structure_bytes"], 0);
    EXPECT_GT(fast["stage_seconds"]["primary"], 0);
    EXPECT_EQ(fast["build_wall_seconds"].size(), 1u);
}

// Each thread's stack is taken out of the limit.
TEST_F(Fast, WhereThreadsAreRefusedThereAreFewer) {
#if defined(NUVO_SANITIZED)
    GTEST_SKIP() << "a sanitizer reserves more than any limit";
#endif
    put("a.x3d", grid_scene(4));
    const std::string expected = picture({"--res=1280,960"});
    constexpr rlim_t kTwoGigabytes = rlim_t{1} << 31;
    const Outcome outcome = finish(start({"--file=a", "--rep=1", "--out=few.bmp", "--res=1280,960",
                                          "--profile=fast", "--threads=1024"},
                                         "", kTwoGigabytes));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(content("few.bmp") == expected);
}

TEST_F(Fast, WhatCannotBeObeyedIsRefusedInOneLine) {
    put("a.x3d", kSmallScene);
    expect_refused({"--file=a", "--profile=fast", "--walk=hash"}, kUsage,
                   {"--walk=hash", "--profile=fast"});
    expect_refused({"--file=a", "--profile=fast", "-showoctree"}, kUsage,
                   {"-showoctree", "--profile=fast"});
    expect_refused({"--file=a", "--threads=2", "--profile=thesis"}, kUsage,
                   {"--threads=2", "--profile=fast"});
    expect_refused({"--file=a", "--isa=sse2"}, kUsage, {"--isa=sse2", "--profile=fast"});
    for (const auto& choice : app::kInstructionSets) {
        const auto sets = supported_instruction_sets();
        if (std::find(sets.begin(), sets.end(), choice.value) != sets.end()) continue;
        expect_refused({"--file=a", "--profile=fast", isa_flag(choice.value)}, kUsage,
                       {isa_flag(choice.value), "this machine has", "sse2"});
    }
}

}  // namespace
}  // namespace nuvo::cli_test
