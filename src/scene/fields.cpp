#include "fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace nuvo::x3d {

namespace {

bool is_separator(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

/// Takes the next word off `text`; empty at the end.
std::string_view next_word(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_separator(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_separator(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

/// X3D's numbers may begin with a plus, from_chars' may not.
std::string_view without_plus(std::string_view word) {
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    return plus ? word.substr(1) : word;
}

/// from_chars would also take "nan" and "inf".
bool begins_a_number(std::string_view word) {
    const std::size_t first = word.starts_with('-') ? 1 : 0;
    return first < word.size() &&
           ((word[first] >= '0' && word[first] <= '9') || word[first] == '.');
}

enum class Verdict { kNumber, kNotANumber, kOutOfRange };

Verdict read(std::string_view word, double& value) {
    const std::string_view digits = without_plus(word);
    if (!begins_a_number(digits)) return Verdict::kNotANumber;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ptr != end || result.ec == std::errc::invalid_argument) return Verdict::kNotANumber;
    if (result.ec == std::errc{}) return Verdict::kNumber;
    // Too large or too small: from_chars does not say which; what is too small is next to zero.
    value = std::strtod(std::string(digits).c_str(), nullptr);
    return std::isfinite(value) ? Verdict::kNumber : Verdict::kOutOfRange;
}

Verdict read(std::string_view word, std::int32_t& value) {
    const std::string_view digits = without_plus(word);
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ptr != end || result.ec == std::errc::invalid_argument) return Verdict::kNotANumber;
    return result.ec == std::errc{} ? Verdict::kNumber : Verdict::kOutOfRange;
}

std::string in_quotes(std::string_view word) {
    std::string text = excerpt(word);
    text.insert(text.begin(), '"');
    text += '"';
    return text;
}

std::vector<Vector3> in_threes(const std::vector<double>& numbers) {
    std::vector<Vector3> vectors;
    vectors.reserve(numbers.size() / 3);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return vectors;
}

std::string shown(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

void Fields::warn(std::string_view name, const std::string& what) const {
    messages_.warn(std::string(element_.name) + "@" + std::string(name), what, element_);
}

bool Fields::boolean(std::string_view name, bool fallback) const {
    const std::string* text = element_.find(name);
    if (text == nullptr) return fallback;
    std::string_view rest = *text;
    const std::string_view word = next_word(rest);
    if (word == "true" || word == "TRUE") return true;
    if (word == "false" || word == "FALSE") return false;
    fail(name, in_quotes(*text) + " is neither true nor false");
}

std::vector<double> Fields::numbers(std::string_view name) const {
    std::vector<double> values;
    const std::string* text = element_.find(name);
    if (text == nullptr) return values;
    std::string_view rest = *text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        double value = 0;
        const Verdict verdict = read(word, value);
        if (verdict == Verdict::kNotANumber) fail(name, in_quotes(word) + " is not a number");
        if (verdict == Verdict::kOutOfRange)
            fail(name, in_quotes(word) + " is beyond the range of double");
        values.push_back(value);
    }
    return values;
}

std::vector<std::int32_t> Fields::integers(std::string_view name) const {
    std::vector<std::int32_t> values;
    const std::string* text = element_.find(name);
    if (text == nullptr) return values;
    std::string_view rest = *text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        std::int32_t value = 0;
        const Verdict verdict = read(word, value);
        if (verdict == Verdict::kNotANumber) fail(name, in_quotes(word) + " is not an integer");
        if (verdict == Verdict::kOutOfRange)
            fail(name, in_quotes(word) + " is beyond 32-bit integers");
        values.push_back(value);
    }
    return values;
}

std::vector<std::string> Fields::strings(std::string_view name) const {
    std::vector<std::string> values;
    const std::string* text = element_.find(name);
    if (text == nullptr) return values;
    if (text->find('"') == std::string::npos) {
        std::string_view rest = *text;
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
            values.emplace_back(word);
        return values;
    }
    bool inside = false;
    for (std::size_t i = 0; i < text->size(); ++i) {
        char c = (*text)[i];
        if (c == '"') {
            inside = !inside;
            if (inside) values.emplace_back();
        } else if (inside) {
            if (c == '\\' && i + 1 < text->size()) c = (*text)[++i];
            values.back() += c;
        }
    }
    return values;
}

std::vector<double> Fields::tuple(std::string_view name, std::size_t count) const {
    if (!has(name)) return {};
    std::vector<double> values = numbers(name);
    if (values.size() != count)
        fail(name,
             std::to_string(values.size()) + " numbers where " + std::to_string(count) + " belong");
    return values;
}

double Fields::number(std::string_view name, double fallback) const {
    const std::vector<double> values = tuple(name, 1);
    return values.empty() ? fallback : values[0];
}

Vector3 Fields::vector(std::string_view name, const Vector3& fallback) const {
    const std::vector<double> values = tuple(name, 3);
    return values.empty() ? fallback : Vector3{values[0], values[1], values[2]};
}

Matrix3 Fields::rotation(std::string_view name) const {
    const std::vector<double> values = tuple(name, 4);
    if (values.empty()) return {};
    const Vector3 axis{values[0], values[1], values[2]};
    if (axis == Vector3{}) warn(name, "about an axis of length zero taken as no rotation");
    return nuvo::rotation(axis, values[3]);
}

double Fields::positive_number(std::string_view name, double fallback) const {
    const double value = number(name, fallback);
    if (value < 0) fail(name, "is negative");
    if (value == 0) warn(name, "of zero");
    return value;
}

void Fields::warn_clamped(std::string_view name, Range range) const {
    if (std::isinf(range.high))
        warn(name, "below " + shown(range.low) + " raised to it");
    else
        warn(name, "clamped to " + shown(range.low) + ".." + shown(range.high));
}

double Fields::clamped_number(std::string_view name, double fallback, Range range) const {
    const double value = number(name, fallback);
    const double clamped = range.nearest(value);
    if (clamped != value) warn_clamped(name, range);
    return clamped;
}

Vector3 Fields::clamped_vector(std::string_view name, const Vector3& fallback, Range range) const {
    const Vector3 v = vector(name, fallback);
    const Vector3 clamped{range.nearest(v.x), range.nearest(v.y), range.nearest(v.z)};
    if (clamped != v) warn_clamped(name, range);
    return clamped;
}

std::vector<double> Fields::clamped_numbers(std::string_view name, Range range) const {
    std::vector<double> values = numbers(name);
    for (double& value : values) {
        const double clamped = range.nearest(value);
        if (clamped != value) warn_clamped(name, range);
        value = clamped;
    }
    return values;
}

std::vector<Color> Fields::colors(std::string_view name) const {
    std::vector<Color> list = vectors(name);
    for (Color& color : list) {
        const Color clamped{kUnit.nearest(color.x), kUnit.nearest(color.y), kUnit.nearest(color.z)};
        if (clamped != color) warn_clamped(name, kUnit);
        color = clamped;
    }
    return list;
}

std::vector<Vector3> Fields::vectors(std::string_view name) const {
    const std::vector<double> values = numbers(name);
    if (values.size() % 3 != 0)
        fail(name, std::to_string(values.size()) + " numbers are no list of triples");
    return in_threes(values);
}

}  // namespace nuvo::x3d
