#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "messages.h"
#include "nuvo/math/affine.h"

namespace nuvo::x3d {

/// An interval that a field's values must lie in.
struct Range {
    double low;
    double high;

    constexpr double nearest(double value) const {
        return value < low ? low : high < value ? high : value;
    }
};

inline constexpr Range kUnit{0, 1};
inline constexpr Range kNotNegative{0, std::numeric_limits<double>::infinity()};

/// Reads the typed fields of one node. A field that is not given has its default; one that cannot
/// be read (not a number, nan, inf, beyond double, too few or too many numbers) throws Error with
/// the element's place. Numbers are separated by blanks, line breaks or commas.
class Fields {
  public:
    Fields(const Element& element, Messages& messages) : element_(element), messages_(messages) {}

    const Element& element() const { return element_; }
    bool boolean(std::string_view name, bool fallback) const;
    double number(std::string_view name, double fallback) const;
    Vector3 vector(std::string_view name, const Vector3& fallback) const;
    /// An SFRotation (axis and angle) as a matrix; a zero axis is no rotation, with a warning.
    Matrix3 rotation(std::string_view name) const;

    /// A length: negative is an error, zero a warning.
    double positive_number(std::string_view name, double fallback) const;

    /// Outside its range a value is clamped, with a warning.
    double clamped_number(std::string_view name, double fallback, Range range) const;
    Vector3 clamped_vector(std::string_view name, const Vector3& fallback, Range range) const;
    std::vector<double> clamped_numbers(std::string_view name, Range range) const;
    std::vector<Color> colors(std::string_view name) const;

    std::vector<double> numbers(std::string_view name) const;
    std::vector<Vector3> vectors(std::string_view name) const;
    std::vector<std::int32_t> integers(std::string_view name) const;
    /// An MFString: its quoted strings, or without quotes its words.
    std::vector<std::string> strings(std::string_view name) const;

    bool has(std::string_view name) const { return element_.find(name) != nullptr; }
    [[noreturn]] void fail(std::string_view name, const std::string& reason) const {
        messages_.fail(element_, name, reason);
    }
    /// Warns about one field: "Kind@name: 1 what (first at ...)".
    void warn(std::string_view name, const std::string& what) const;

  private:
    /// The field's numbers, `count` of them; empty when it is not given.
    std::vector<double> tuple(std::string_view name, std::size_t count) const;
    void warn_clamped(std::string_view name, Range range) const;

    const Element& element_;
    Messages& messages_;
};

}  // namespace nuvo::x3d
