#include "nuvo/octree/label.h"

#include <gtest/gtest.h>

namespace nuvo {
namespace {

// Thesis appendix D: 1..4 lie above in y, even digits on the +x side, 3, 4, 7, 8 on the +z side.
TEST(Label, DigitsFollowAppendixD) {
    for (int digit = 1; digit <= 8; ++digit) {
        const int bits = octant_bits(digit);
        EXPECT_EQ((bits & 1) != 0, digit % 2 == 0) << digit;
        EXPECT_EQ((bits & 2) != 0, digit < 5) << digit;
        EXPECT_EQ((bits & 4) != 0, digit == 3 || digit == 4 || digit == 7 || digit == 8) << digit;
    }
}

TEST(Label, AssignmentOctantsAndThesisDigitsMapOneToOne) {
    // Octants 0..7 of the assignment (bit 0 = x, 1 = y, 2 = z) as the thesis names them.
    const int expected[8] = {5, 6, 1, 2, 7, 8, 3, 4};
    for (int bits = 0; bits < 8; ++bits) {
        EXPECT_EQ(octant_digit(bits), expected[bits]);
        EXPECT_EQ(octant_bits(octant_digit(bits)), bits);
    }
}

TEST(Label, ChildrenCarryTheirParentsNameAsPrefix) {
    EXPECT_EQ(child_label(43, 1), 431U);  // the thesis' own example, 4.4.1
    EXPECT_EQ(child_label(43, 8), 438U);
    EXPECT_EQ(child_label(0, 5), 5U);
    EXPECT_EQ(parent_label(438), 43U);
    EXPECT_EQ(label_digits(0), 0);
    EXPECT_EQ(label_digits(438), 3);
}

TEST(Label, NineteenDigitsFitIn64BitsAndTwentyDoNot) {
    Label longest = 0;
    for (int level = 0; level < kMaxLabelDigits; ++level) longest = child_label(longest, 8);
    EXPECT_EQ(longest, 8888888888888888888U);
    EXPECT_EQ(label_digits(longest), 19);
    EXPECT_GT(longest, ~Label{0} / 10);  // a twentieth digit would wrap around
}

}  // namespace
}  // namespace nuvo
