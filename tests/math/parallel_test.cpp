#include "nuvo/math/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace nuvo {
namespace {

TEST(ForEachIndex, MeetsEveryIndexOnce) {
    for (const int threads : {1, 2, 7})
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
            std::vector<std::atomic<int>> met(count);
            std::atomic<bool> in_range = true;
            for_each_index(threads, count, [&](std::size_t i, int thread) {
                ++met[i];
                if (thread < 0 || thread >= threads) in_range = false;
            });
            for (const auto& times : met) ASSERT_EQ(times, 1);
            EXPECT_TRUE(in_range);
        }
}

TEST(ForEachPart, PartsFollowEachOtherWithoutGaps) {
    for (const int threads : {1, 2, 7})
        for (const std::size_t count : {std::size_t{0}, std::size_t{5}, std::size_t{100'000}}) {
            std::vector<std::atomic<int>> met(count);
            for_each_part(threads, count, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++met[i];
            });
            for (const auto& times : met) ASSERT_EQ(times, 1);
        }
}

TEST(ForEachIndex, EachThreadWorksAloneUnderItsNumber) {
    std::vector<std::atomic<int>> busy(4);
    std::atomic<bool> shared = false;
    for_each_index(4, 5000, [&](std::size_t, int thread) {
        if (++busy[static_cast<std::size_t>(thread)] != 1) shared = true;
        --busy[static_cast<std::size_t>(thread)];
    });
    EXPECT_FALSE(shared);
}

TEST(ForEachIndex, ThrowsWhatACallThrewAndStops) {
    for (const int threads : {1, 3}) {
        std::atomic<int> calls = 0;
        const auto fail_at_ten = [&](std::size_t i, int) {
            ++calls;
            if (i == 10) throw std::runtime_error("ten");
        };
        EXPECT_THROW(for_each_index(threads, 1'000'000'000, fail_at_ten), std::runtime_error);
        EXPECT_LT(calls, 1'000'000'000);
    }
}

}  // namespace
}  // namespace nuvo
