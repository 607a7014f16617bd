#include <gtest/gtest.h>

#include <sstream>

#include "classes.h"
#include "leaks.h"
#include "run.h"

namespace nuvo::hard {
namespace {

TEST(HardCases, EveryRayOfEveryClassIsWhatExactArithmeticSays) {
    RunOptions options;
    options.rays = 60'000;
    options.seed = 20'240'601;
    options.rays_per_scene = 100;
    std::ostringstream report;
    const std::vector<ClassTally> tallies = run(options, report);
    EXPECT_EQ(tallies.size(), hard_classes().size());
    EXPECT_TRUE(print(report, tallies)) << report.str();
    for (const ClassTally& tally : tallies) {
        // Both outcomes occur, or the class is not hard.
        EXPECT_GT(tally.float_exact.hits, tally.float_exact.rays / 5) << tally.name;
        EXPECT_GT(tally.full_double.hits, tally.full_double.rays / 5) << tally.name;
    }
}

TEST(HardCases, RaysMeetTheFrontsOfSolidsOnly) {
    RunOptions options;
    options.rays = 30'000;
    options.seed = 35;
    options.rays_per_scene = 100;
    options.solid = true;
    std::ostringstream report;
    EXPECT_TRUE(print(report, run(options, report))) << report.str();
}

TEST(HardCases, FastSingleRaysAreWhatExactArithmeticSays) {
    for (const bool solid : {false, true}) {
        RunOptions options;
        options.rays = 30'000;
        options.seed = 77;
        options.rays_per_scene = 100;
        options.fast = true;
        options.solid = solid;
        std::ostringstream report;
        const std::vector<ClassTally> tallies = run(options, report);
        EXPECT_EQ(tallies.size(), hard_classes().size());
        EXPECT_TRUE(print(report, tallies)) << report.str();
    }
}

TEST(HardCases, TheOracleSeesTheErrorsOfPlainTests) {
    RunOptions options;
    options.rays = 10'000;
    options.seed = 5;
    options.rays_per_scene = 100;
    options.precision = Precision::kDouble;
    std::ostringstream report;
    Tally sum;
    for (const ClassTally& tally : run(options, report))
        (sum += tally.float_exact) += tally.full_double;
    EXPECT_GT(sum.missed, 0U);
    EXPECT_GT(sum.false_hits, 0U);
    EXPECT_GT(sum.wrong_primitive, 0U);
    EXPECT_GT(sum.tie_breaks, 0U);
    EXPECT_GT(sum.worst_t, 1e-10);
}

TEST(HardCases, NoRayLeaksOutOfAClosedMesh) {
    std::ostringstream report;
    const LeakCount count = count_leaks(100'000, 7, 0, report);
    EXPECT_EQ(count.rays, 100'000U);
    EXPECT_EQ(count.leaks, 0U) << report.str();
}

}  // namespace
}  // namespace nuvo::hard
