#include "nuvo/math/one_line.h"

#include <gtest/gtest.h>

namespace nuvo {
namespace {

TEST(OneLine, HasNoControlCharacters) {
    EXPECT_EQ(one_line("a\nb\x1b[2J\x7f"), "a?b?[2J?");
    EXPECT_EQ(one_line("\xc3\xa4 b"), "\xc3\xa4 b");  // UTF-8
}

TEST(OneLine, ExcerptIsItsBeginning) {
    EXPECT_EQ(excerpt("a\tb"), "a?b");
    EXPECT_EQ(excerpt(std::string(40, 'x')), std::string(40, 'x'));
    EXPECT_EQ(excerpt(std::string(41, 'x')), std::string(40, 'x') + "...");
}

}  // namespace
}  // namespace nuvo
