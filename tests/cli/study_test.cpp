#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

using Study = ProgramTest;
using Json = nlohmann::json;

// A sphere on a square, a thousandth of a unit large, lit from above: the published bias of 0.04
// takes every shadow ray past sphere and point light.
const char* const kTinyScene = R"(<X3D version="3.0"><Scene>
<Viewpoint position="0 0.004 0.01" orientation="1 0 0 -0.38"/>
<DirectionalLight direction="0 -1 0"/>
<PointLight location="0.001 0.004 0.001"/>
<Transform translation="0 0.0015 0"><Shape><Appearance><Material/></Appearance>
<Sphere radius="0.001"/></Shape></Transform>
<Shape><Appearance><Material/></Appearance><IndexedFaceSet solid="false" coordIndex="0 1 2 3 -1">
<Coordinate point="-0.004 0 0.004, 0.004 0 0.004, 0.004 0 -0.004, -0.004 0 -0.004"/>
</IndexedFaceSet></Shape></Scene></X3D>)";

/// The rows by profile and change.
std::map<std::pair<std::string, std::string>, Json> rows_of(const Json& json) {
    std::map<std::pair<std::string, std::string>, Json> rows;
    for (const Json& row : json["rows"]) rows[{row["profile"]["name"], row["change"]}] = row;
    return rows;
}

TEST_F(Study, TheExactRowsAreRightAndThePublishedBiasLosesTheShadowsOfASmallScene) {
    put("a.x3d", kTinyScene);
    const Outcome outcome = run({"--file=a", "--study=s.json", "--res=48,36", "--rep=2"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d", "s.json"}));
    const auto rows = rows_of(Json::parse(content("s.json")));
    ASSERT_GT(rows.size(), 30u);
    for (const auto& [name, row] : rows) {
        EXPECT_EQ(row["trace_seconds"].size(), 2u);
        EXPECT_EQ(row["build_seconds"].size(), 2u);
        EXPECT_GE(row["trace_seconds_median"], row["trace_seconds_interval"][0]);
        EXPECT_LE(row["trace_seconds_median"], row["trace_seconds_interval"][1]);
    }
    for (const char* change : {"", "--type=nonuniform", "--walk=descent"}) {
        const Json& row = rows.at({"exact", change});
        EXPECT_EQ(row["wrong_primitives"], 0) << change;
        EXPECT_EQ(row["wrong_shadows"], 0) << change;
        EXPECT_EQ(row["max_difference"], 0) << change;
        EXPECT_EQ(row["rms"], 0) << change;
        EXPECT_TRUE(row["psnr_db"].is_null()) << change;
    }
    for (const char* change : {"", "--type=nonuniform"}) {
        EXPECT_EQ(rows.at({"fast", change})["max_difference"], 0) << change;
        EXPECT_TRUE(rows.at({"fast", change})["psnr_db"].is_null()) << change;
    }
    // The sphere covers some percent of the 1728 pixels and shadows about as many.
    for (const auto& name : {std::pair<std::string, std::string>{"thesis", ""},
                             std::pair<std::string, std::string>{"exact", "--bias=0.04"}}) {
        EXPECT_GT(rows.at(name)["wrong_shadows"], 20) << name.first;
        EXPECT_GT(rows.at(name)["rms"], 1) << name.first;
        EXPECT_LT(rows.at(name)["psnr_db"], 60) << name.first;
    }
}

TEST_F(Study, TheTableHasALineARowAndTheFrontierIsMarked) {
    put("a.x3d", kSmallScene);
    const Outcome outcome = run({"--file=a", "--study", "--res=16,12", "--rep=1"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("\nexact   --precision=double"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\nthesis  --bias=exact"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find(" *\n"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(files(), (std::set<std::string>{"a.x3d"}));
}

TEST_F(Study, WhatItChoosesItselfIsRefused) {
    put("a.x3d", kSmallScene);
    for (const char* flag : {"--precision=double", "--profile=thesis", "--out=o", "-compare"})
        expect_refused({"--file=a", "--study", flag}, 2, {"--study"});
    expect_refused({"--file=a", "--study=a.x3d"}, 2, {"would be overwritten"});
    expect_refused({"--file=a", "--study=missing/s.json"}, 4, {"missing"});
}

TEST_F(Study, TheStagesOfThePredicatesAreCountedForTheExactOnesOnly) {
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"--file=a", "--rep=1", "--res=20,10", "--json=a.json"}).exit_code, 0);
    const Json predicates = Json::parse(content("a.json"))["predicates"];
    EXPECT_GT(predicates["tests"], 0);
    EXPECT_LT(predicates["wider"], predicates["tests"]);
    EXPECT_LT(predicates["exact"], predicates["tests"]);
    ASSERT_EQ(run({"--file=a", "--rep=1", "--res=20,10", "--json=a.json", "--precision=double"})
                  .exit_code,
              0);
    EXPECT_FALSE(Json::parse(content("a.json")).contains("predicates"));
    EXPECT_NE(run({"--file=a", "--rep=1", "--res=4,4", "--counters"}).out.find("\npredicates "),
              std::string::npos);
}

// A ray through the edge that two triangles share: the cheap stage cannot decide.
TEST_F(Study, AnEdgeUnderThePixelsCentreTakesExactArithmetic) {
    // 3 x 3 pixels: the middle one looks along the z axis, at the square's diagonal.
    put("b.x3d", R"(<X3D version="3.0"><Scene><Viewpoint position="0 0 10"/><Shape>
<IndexedFaceSet coordIndex="0 1 2 3 -1"><Coordinate point="-2 -2 0, 2 -2 0, 2 2 0, -2 2 0"/>
</IndexedFaceSet></Shape></Scene></X3D>)");
    ASSERT_EQ(run({"--file=b", "--rep=1", "--res=3,3", "--json=b.json"}).exit_code, 0);
    EXPECT_GT(Json::parse(content("b.json"))["predicates"]["exact"], 0);
}

}  // namespace
}  // namespace nuvo::cli_test
