#pragma once

#include <cstdint>

namespace nuvo {

/// Glassner's name of a node: its path from the root in decimal digits 1..8; the root is 0.
/// [thesis 4.4.1, fig. 17]
using Label = std::uint64_t;

/// Digits that fit: 19 decimal digits fit in 64 bits, 20 do not.
inline constexpr int kMaxLabelDigits = 19;

constexpr Label child_label(Label parent, int digit) {
    return parent * 10 + static_cast<Label>(digit);
}
constexpr Label parent_label(Label label) { return label / 10; }

/// Number of digits: the node's level below the root (0 for the root).
constexpr int label_digits(Label label) {
    int digits = 0;
    for (; label != 0; label /= 10) ++digits;
    return digits;
}

/// The assignment's octant 0..7 (bit 0 = +x, bit 1 = +y, bit 2 = +z) of a thesis digit 1..8
/// (even = +x; 1..4 = +y; 3, 4, 7, 8 = +z). [thesis appendix D, COMP1011]
constexpr int octant_bits(int digit) {
    const int d = digit - 1;
    return (d & 1) | (d < 4 ? 2 : 0) | ((d & 2) != 0 ? 4 : 0);
}
/// The inverse of octant_bits.
constexpr int octant_digit(int bits) {
    return 1 + (bits & 1) + ((bits & 2) != 0 ? 0 : 4) + ((bits & 4) != 0 ? 2 : 0);
}

}  // namespace nuvo
