// The short form of scripts/fuzz.sh: fixed seeds, and all that was ever found.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "bytes.h"
#include "chooser.h"
#include "grammar.h"
#include "isolated.h"
#include "minimize.h"

namespace nuvo::fuzz {
namespace {

namespace fs = std::filesystem;

#if defined(NUVO_SANITIZED) || !defined(NDEBUG)
constexpr std::uint64_t kScenes = 20;
constexpr std::uint64_t kMutations = 2'000;
#else
constexpr std::uint64_t kScenes = 150;
constexpr std::uint64_t kMutations = 20'000;
#endif

void expect_clean(const Verdict& verdict, const std::string& name) {
    if (!verdict.findings.empty())
        ADD_FAILURE() << name << ": " << verdict.findings[0].text << " (and "
                      << verdict.findings.size() - 1 << " more)";
}

std::vector<fs::path> files_in(const char* folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(NUVO_SOURCE_DIR) / folder))
        if (entry.path().extension() == ".x3d") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// What once was found; docs/reliability.md tells what each was.
TEST(Fuzz, WhatOnceWasFoundStaysMended) {
    for (const fs::path& file : files_in("tests/fuzz/findings")) {
        const Verdict verdict = judge_file(file);
        EXPECT_FALSE(verdict.refused) << verdict.refusal;
        expect_clean(verdict, file.filename().string());
    }
}

TEST(Fuzz, RandomScenesAreTheSameByEveryPipeline) {
    constexpr std::uint64_t kSeed = 20'261'128;
    const fs::path scratch = fs::path(testing::TempDir()) / "nuvo-fuzz";
    fs::create_directories(scratch);
    int refused = 0;
    for (std::uint64_t i = 0; i < kScenes; ++i) {
        const Verdict verdict = judge(make_document(kSeed * 1'000'000'000 + i), scratch);
        refused += verdict.refused ? 1 : 0;
        expect_clean(verdict, "scripts/fuzz.sh seed " + std::to_string(kSeed) + " scene " +
                                  std::to_string(i));
    }
    EXPECT_LT(refused, static_cast<int>(kScenes) / 10);
    fs::remove_all(scratch);
}

void collect_names(const Element& element, std::set<std::string>& names) {
    names.insert(element.name);
    for (const Element& child : element.children) collect_names(child, names);
}

TEST(Fuzz, TheGrammarHoldsEveryKindOfGeometryAndLight) {
    std::set<std::string> names;
    for (std::uint64_t i = 0; i < 1000; ++i) collect_names(make_document(i).root, names);
    for (const char* name : {"Sphere",
                             "Box",
                             "Cone",
                             "Cylinder",
                             "IndexedFaceSet",
                             "ElevationGrid",
                             "TriangleSet",
                             "IndexedTriangleSet",
                             "TriangleStripSet",
                             "IndexedTriangleStripSet",
                             "TriangleFanSet",
                             "IndexedTriangleFanSet",
                             "QuadSet",
                             "IndexedQuadSet",
                             "DirectionalLight",
                             "PointLight",
                             "SpotLight",
                             "Inline",
                             "Switch",
                             "LOD",
                             "Background",
                             "NavigationInfo"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Fuzz, FilesOfInlinesAreReadAndSettingsKept) {
    Document document;
    document.root = {"Scene", {}, {{"Inline", {}, {{"Shape", {}, {{"Sphere", {}, {}}}}}}}};
    document.resolution = {7, 5};
    document.rays = {"0 0 9 0 0 -1"};
    const fs::path folder = fs::path(testing::TempDir()) / "nuvo-fuzz-inline";
    fs::create_directories(folder);
    EXPECT_EQ(load(document, folder).objects.size(), 1u);
    const Document settings = settings_of(text_of(document, "a"));
    EXPECT_EQ(settings.resolution, document.resolution);
    EXPECT_EQ(settings.rays, document.rays);
    fs::remove_all(folder);
}

TEST(Fuzz, TheMinimizerLeavesWhatTheFindingNeeds) {
    const auto has_large_sphere = [](const Document& document) {
        const std::string text = text_of(document, "a");
        const std::size_t place = text.find("<Sphere radius='");
        return place != std::string::npos && std::atof(text.c_str() + place + 16) > 2;
    };
    int tried = 0;
    for (std::uint64_t i = 0; tried < 5; ++i) {
        const Document document = make_document(i);
        if (!has_large_sphere(document)) continue;
        ++tried;
        const Document small = minimized(document, has_large_sphere, 5000);
        EXPECT_TRUE(has_large_sphere(small));
        EXPECT_LE(count_elements(small.root), 2u) << text_of(small, "a");  // root and sphere
        EXPECT_TRUE(small.rays.empty());
        EXPECT_EQ(small.resolution, (Resolution{1, 1}));
    }
}

TEST(FuzzBytes, TheCorpusIsTaken) {
    for (const Target& target : targets()) {
        const auto corpus = corpus_of(target);
        EXPECT_GE(corpus.size(), 5u) << target.name;
        for (const std::string& bytes : corpus) EXPECT_NO_THROW(target.take(bytes)) << bytes;
    }
}

TEST(FuzzBytes, MutationsOfTheCorpusAreTaken) {
    constexpr std::uint64_t kSeed = 7;
    for (const Target& target : targets()) {
        const auto corpus = corpus_of(target);
        for (std::uint64_t i = 0; i < kMutations; ++i) {
            const std::string bytes = mutated(corpus, target, kSeed * 1'000'000'000 + i);
            ASSERT_NO_THROW(target.take(bytes))
                << "seed " << kSeed << " number " << i << ": " << bytes;
        }
    }
}

}  // namespace
}  // namespace nuvo::fuzz
