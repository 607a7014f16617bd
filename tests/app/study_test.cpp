#include "nuvo/app/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "nuvo/app/report.h"

namespace nuvo::app {
namespace {

StudyRow row(double seconds, double rms) {
    StudyRow made;
    made.trace.median = seconds;
    made.difference.rms = rms;
    return made;
}

std::vector<bool> frontier(std::vector<StudyRow> rows) {
    mark_frontier(rows);
    std::vector<bool> marks;
    for (const StudyRow& marked : rows) marks.push_back(marked.on_frontier);
    return marks;
}

TEST(Study, TheFrontierHoldsWhatNoRowBeats) {
    // Best, slower and worse, faster and worse, as fast and worse, slower and as good.
    EXPECT_EQ(frontier({row(2, 1), row(3, 2), row(1, 5), row(2, 3), row(4, 1)}),
              (std::vector<bool>{true, false, true, false, false}));
    EXPECT_EQ(frontier({row(1, 0), row(1, 0)}), (std::vector<bool>{true, true}));  // equal rows
    EXPECT_EQ(frontier({row(9, 9)}), (std::vector<bool>{true}));
}

TEST(Study, AMedianLiesInItsInterval) {
    const double odd[] = {5, 1, 3};
    EXPECT_EQ(median_interval(odd).median, 3);
    const double even[] = {4, 1, 2, 9};
    EXPECT_EQ(median_interval(even).median, 3);
    const double one[] = {7};
    const MedianInterval alone = median_interval(one);
    EXPECT_EQ(alone.low, 7);
    EXPECT_EQ(alone.median, 7);
    EXPECT_EQ(alone.high, 7);
    // Of three values all 27 samples are equally likely and 7 of them have the least as median,
    // far more than 2.5 %: the interval is the whole range.
    EXPECT_EQ(median_interval(odd).low, 1);
    EXPECT_EQ(median_interval(odd).high, 5);
}

// The interval is that of order statistics, all but: for the median of 101 values the 41st and the
// 61st, by the binomial distribution.
TEST(Study, AnIntervalIsThatOfTheOrderStatistics) {
    std::vector<double> values;
    for (int i = 1; i <= 101; ++i) values.push_back(i);
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::shuffle(values.begin(), values.end(), std::mt19937(seed));
    const MedianInterval interval = median_interval(values);
    EXPECT_EQ(interval.median, 51);
    EXPECT_NEAR(interval.low, 41, 3);
    EXPECT_NEAR(interval.high, 61, 3);
}

TEST(Study, NoCaseIsThereTwiceAndTheExactProfileIsFirst) {
    const std::vector<StudyCase> cases = study_cases(exact_profile());
    EXPECT_EQ(cases.front().profile, "exact");
    EXPECT_EQ(cases.front().change, "");
    std::set<std::string> seen;
    for (const StudyCase& what : cases) {
        Options options;
        options.profile = what.answers;
        EXPECT_TRUE(seen.insert(profile_flags_text(options)).second)
            << what.profile << ' ' << what.change;
    }
}

TEST(Study, EveryAnswerWorthComparingIsThereForBothProfiles) {
    for (const char* profile : {"exact", "thesis"}) {
        std::set<std::string> answers;
        for (const StudyCase& what : study_cases(exact_profile())) {
            if (what.profile != profile) continue;
            const Profile& p = what.answers;
            answers.insert(p.type == OctreeType::kUniform ? "uniform" : "nonuniform");
            answers.insert(p.walk == WalkChoice::kHash ? "hash" : "descent");
            answers.insert(p.step ? "step " + std::to_string(std::lround(std::log10(*p.step)))
                                  : "step exact");
            answers.insert("precision " + std::to_string(static_cast<int>(p.precision)));
            answers.insert(p.bias ? "bias " + std::to_string(std::lround(*p.bias * 1000))
                                  : "bias exact");
        }
        EXPECT_EQ(answers,
                  (std::set<std::string>{"uniform", "nonuniform", "hash", "descent", "step 0",
                                         "step -1", "step -2", "step -3", "step -4", "step -5",
                                         "step exact", "precision 0", "precision 1", "precision 2",
                                         "bias 0", "bias 4", "bias 40", "bias exact"}))
            << profile;
    }
}

TEST(Study, TheTileTracerIsThereOnBothOctrees) {
    std::set<OctreeType> types;
    for (const StudyCase& what : study_cases(exact_profile())) {
        EXPECT_EQ(what.profile == "fast", what.answers.tracer == TracerChoice::kTiles);
        if (what.profile == "fast") types.insert(what.answers.type);
    }
    EXPECT_EQ(types.size(), 2u);
}

TEST(Study, WhatTheTileTracerDoesNotTellIsNull) {
    StudyRow tiles = row(0.5, 0);
    tiles.what = {"fast", "", fast_profile()};
    StudyRow serial = row(0.5, 0);
    serial.wrong_primitives = 3;
    serial.wrong_shadows = 0;
    const auto json = nlohmann::json::parse(study_json(Options(), "s.x3d", {serial, tiles}));
    EXPECT_EQ(json["rows"][0]["wrong_primitives"], 3);
    EXPECT_EQ(json["rows"][0]["wrong_shadows"], 0);
    EXPECT_TRUE(json["rows"][1]["wrong_primitives"].is_null());
    EXPECT_TRUE(json["rows"][1]["wrong_shadows"].is_null());
}

TEST(Study, TheTypeGivenIsTheOneThatCasesChange) {
    Profile given = exact_profile();
    given.type = OctreeType::kNonuniform;
    given.midpoint = MidpointChoice::kSweep;
    given.max_objects = 3;
    int changed = 0;
    for (const StudyCase& what : study_cases(given)) {
        const bool changes = what.change.find("--type=uniform") != std::string::npos;
        changed += changes;
        EXPECT_EQ(what.change.find("nonuniform"), std::string::npos);
        EXPECT_EQ(what.answers.type, changes ? OctreeType::kUniform : OctreeType::kNonuniform);
        if (what.answers.tracer == TracerChoice::kTiles) continue;  // has no other midpoint
        EXPECT_EQ(what.answers.midpoint, MidpointChoice::kSweep);
        EXPECT_EQ(what.answers.max_objects, std::size_t{3});
    }
    EXPECT_GE(changed, 2);
}

TEST(Study, JsonHoldsNoInfinity) {
    StudyRow exact = row(0.5, 0);
    exact.what.profile = "exact";
    exact.difference.psnr_db = std::numeric_limits<double>::infinity();
    exact.trace_seconds = {0.25, 0.5};
    const auto json = nlohmann::json::parse(study_json(Options(), "s\xff.x3d", {exact}));
    EXPECT_TRUE(json["rows"][0]["psnr_db"].is_null());
    EXPECT_EQ(json["rows"][0]["trace_seconds"], (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(json["rows"][0]["profile"]["precision"], "exact");
    EXPECT_EQ(json["resolution"]["width"], 1920);
}

}  // namespace
}  // namespace nuvo::app
