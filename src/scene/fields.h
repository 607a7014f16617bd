#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "messages.h"
#include "nuvo/math/affine.h"
#include "nuvo/math/big_vector.h"

namespace nuvo::x3d {

/// An interval that a field's values must lie in.
struct Range {
    double low;
    double high;
    /// What is beyond `high` by so small a part of it is the limit itself, rounded: no word of it.
    double rounding = 0;

    constexpr double nearest(double value) const {
        return value < low ? low : high < value ? high : value;
    }
    constexpr bool is_beyond(double value) const {
        return value < low || value > high * (1 + rounding);
    }
};

/// From 0 to a limit that files write in single precision, or as 3.1416 and 1.5708.
constexpr Range up_to_angle(double radians) { return {0, radians, 1e-5}; }

inline constexpr Range kUnit{0, 1};
inline constexpr Range kNotNegative{0, std::numeric_limits<double>::infinity()};

/// Takes the next word off `text`; empty at the end. Blanks, line breaks and commas part words.
std::string_view next_word(std::string_view& text);

/// Lists of numbers, which may be long.
using Numbers = BigVector<double>;
using Integers = BigVector<std::int32_t>;

enum class NumberVerdict { kNumber, kNotANumber, kOutOfRange };

/// Reads a word as X3D writes numbers: no nan, inf or hexadecimal; what is too small is next to
/// zero.
NumberVerdict read_number(std::string_view word, double& value);

/// Reads the typed fields of one node. A field that is not given has its default, and so has one
/// that cannot be read (empty, not a number, nan, inf, beyond double, too few or too many numbers),
/// with a warning; where reading is strict that throws Error with the element's place. Numbers are
/// separated by blanks, line breaks or commas.
class Fields {
  public:
    /// Up to `threads` share the work on long lists of numbers.
    Fields(const Element& element, Messages& messages, int threads = 1)
        : element_(element), messages_(messages), threads_(threads) {}

    const Element& element() const { return element_; }
    int threads() const { return threads_; }
    bool is_strict() const { return messages_.is_strict(); }
    bool boolean(std::string_view name, bool fallback) const;
    double number(std::string_view name, double fallback) const;
    Vector3 vector(std::string_view name, const Vector3& fallback) const;
    /// An SFRotation (axis and angle) as a matrix; a zero axis is no rotation, with a warning.
    Matrix3 rotation(std::string_view name) const;

    /// A length: one below zero leaves the node out, zero is a warning.
    double positive_number(std::string_view name, double fallback) const;

    /// Outside its range a value is clamped, with a warning.
    double clamped_number(std::string_view name, double fallback, Range range) const;
    Vector3 clamped_vector(std::string_view name, const Vector3& fallback, Range range) const;
    Numbers clamped_numbers(std::string_view name, Range range) const;
    std::vector<Color> colors(std::string_view name) const;

    /// Two numbers (SFVec2f).
    std::array<double, 2> pair(std::string_view name, double first, double second) const;

    Numbers numbers(std::string_view name) const;
    /// An MFVec2f, each pair as x and z.
    std::vector<Vector3> pairs(std::string_view name) const;
    /// An MFRotation as matrices.
    std::vector<Matrix3> rotations(std::string_view name) const;
    std::vector<Vector3> vectors(std::string_view name) const;
    Integers integers(std::string_view name) const;
    /// An MFString: its quoted strings, or without quotes its words.
    std::vector<std::string> strings(std::string_view name) const;

    bool has(std::string_view name) const { return given(name) != nullptr; }
    /// The node cannot be drawn: throws LeftOut, or Error where reading is strict.
    [[noreturn]] void fail(std::string_view name, const std::string& reason) const {
        messages_.leave_out(element_, name, reason);
    }
    /// The scene cannot be drawn: throws Error.
    [[noreturn]] void refuse(std::string_view name, const std::string& reason) const {
        messages_.refuse(element_, name, reason);
    }
    /// The field counts as not given: a warning, or Error where reading is strict.
    void reject(std::string_view name, const std::string& reason) const {
        messages_.warn_field_left_out(element_, name, reason);
    }
    /// Warns about one field: "Kind@name: COUNT what (first at ...)".
    void warn(std::string_view name, const std::string& what, std::size_t count = 1) const;

  private:
    /// The field's text; null when it is not given or empty.
    const std::string_view* given(std::string_view name) const;
    /// Reads a word; what is no value of type T is rejected, and false.
    template <typename T>
    bool read_word(std::string_view name, std::string_view word, T& value) const;
    /// The words of a field; none where one of them is rejected.
    template <typename T>
    BigVector<T> words(std::string_view name) const;
    /// Reads the field's numbers; false, and `values` as they were, when it is not given.
    template <std::size_t N>
    bool tuple(std::string_view name, std::array<double, N>& values) const;
    /// The field's numbers without an incomplete last one of `size` numbers each.
    Numbers whole(std::string_view name, std::size_t size, const char* plural,
                  const char* single) const;
    /// The nearest number in the range, warned of where it is another.
    double clamped(std::string_view name, double value, Range range) const;
    void warn_clamped(std::string_view name, Range range) const;

    const Element& element_;
    Messages& messages_;
    int threads_;
};

}  // namespace nuvo::x3d
