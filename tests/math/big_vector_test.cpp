#include "nuvo/math/big_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace nuvo {
namespace {

constexpr std::size_t kLarge = std::size_t{5} << 20;

TEST(BlockKeeper, HandsABlockOutAgainToOneOfAboutItsSize) {
    const BlockKeeper keeper;
    void* const first = allocate_block(kLarge);
    free_block(first, kLarge);
    void* const second = allocate_block(kLarge + 1000);
    EXPECT_EQ(second, first);
    void* const third = allocate_block(kLarge);  // the first one is in use
    EXPECT_NE(third, second);
    free_block(second, kLarge + 1000);
    free_block(third, kLarge);
}

TEST(BlockKeeper, BlocksAreAlignedAndWholeWithAndWithoutAKeeper) {
    for (int round = 0; round < 3; ++round) {
        std::vector<BlockKeeper> keepers(round == 1 ? 1 : 0);
        for (const std::size_t bytes : {std::size_t{1}, std::size_t{1000}, kLarge}) {
            BigVector<std::uint8_t> block(bytes, 7);
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block.data()) % 64, 0U);
            block.resize(2 * bytes, 9);
            EXPECT_EQ(std::accumulate(block.begin(), block.end(), std::size_t{0}), 16 * bytes);
        }
    }
}

}  // namespace
}  // namespace nuvo
