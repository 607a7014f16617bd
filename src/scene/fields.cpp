#include "fields.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <type_traits>
#include <utility>

#include "nuvo/math/parallel.h"

namespace nuvo::x3d {

namespace {

bool is_separator(char c) {
    if (c > ',') return false;  // what numbers and names are made of
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
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

NumberVerdict read(std::string_view word, double& value) {
    const std::string_view digits = without_plus(word);
    if (!begins_a_number(digits)) return NumberVerdict::kNotANumber;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ptr != end || result.ec == std::errc::invalid_argument)
        return NumberVerdict::kNotANumber;
    if (result.ec == std::errc{}) return NumberVerdict::kNumber;
    // Too large or too small: from_chars does not say which; what is too small is next to zero.
    value = std::strtod(std::string(digits).c_str(), nullptr);
    return std::isfinite(value) ? NumberVerdict::kNumber : NumberVerdict::kOutOfRange;
}

NumberVerdict read(std::string_view word, std::int32_t& value) {
    const std::string_view digits = without_plus(word);
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ptr != end || result.ec == std::errc::invalid_argument)
        return NumberVerdict::kNotANumber;
    return result.ec == std::errc{} ? NumberVerdict::kNumber : NumberVerdict::kOutOfRange;
}

/// Takes the number that `text` begins with off it where it is one in the plainest form; else
/// leaves all as it is.
template <typename T>
bool take_number(std::string_view& text, T& value) {
    if (!begins_a_number(text)) return false;
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || (after != end && !is_separator(*after))) return false;
    text.remove_prefix(static_cast<std::size_t>(after - text.data()));
    return true;
}

void skip_separators(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_separator(text[begin])) ++begin;
    text.remove_prefix(begin);
}

/// Texts of about `size` bytes each, which meet at separators.
std::vector<std::string_view> parts_of(std::string_view text, std::size_t size) {
    std::vector<std::string_view> parts;
    while (!text.empty()) {
        std::size_t end = std::min(size, text.size());
        while (end < text.size() && !is_separator(text[end])) ++end;
        parts.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return parts;
}

/// Reads a long text's numbers on several threads. False, and nothing read, where it is short or
/// some number is not in the plainest form: who reads it from its beginning tells which is wrong.
template <typename T>
bool read_in_parts(std::string_view text, int threads, BigVector<T>& values) {
    constexpr std::size_t kPart = std::size_t{1} << 17;
    if (text.size() < 2 * kPart) return false;
    const std::vector<std::string_view> parts = parts_of(text, kPart);
    std::vector<BigVector<T>> read(parts.size());
    std::atomic<bool> plain = true;
    for_each_index(threads, parts.size(), [&](std::size_t i, int) {
        std::string_view rest = parts[i];
        for (skip_separators(rest); !rest.empty() && plain; skip_separators(rest)) {
            T value{};
            if (!take_number(rest, value)) plain = false;
            read[i].push_back(value);
        }
    });
    if (!plain) return false;
    std::vector<std::size_t> begin;
    std::size_t count = 0;
    for (const BigVector<T>& part : read)
        begin.push_back(std::exchange(count, count + part.size()));
    values.resize(count);
    for_each_index(threads, parts.size(), [&](std::size_t i, int) {
        std::copy(read[i].begin(), read[i].end(),
                  values.begin() + static_cast<std::ptrdiff_t>(begin[i]));
    });
    return true;
}

std::string in_quotes(std::string_view word) {
    std::string text = excerpt(word);
    text.insert(text.begin(), '"');
    text += '"';
    return text;
}

std::string shown(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

std::string_view next_word(std::string_view& text) {
    skip_separators(text);
    std::size_t end = 0;
    while (end < text.size() && !is_separator(text[end])) ++end;
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

NumberVerdict read_number(std::string_view word, double& value) { return read(word, value); }

void Fields::warn(std::string_view name, const std::string& what, std::size_t count) const {
    messages_.warn(std::string(element_.name) + "@" + std::string(name), what, element_, count);
}

const std::string_view* Fields::given(std::string_view name) const {
    const std::string_view* text = element_.find(name);
    if (text == nullptr || messages_.is_strict()) return text;
    std::string_view rest = *text;
    if (!next_word(rest).empty()) return text;
    reject(name, "is empty");
    return nullptr;
}

bool Fields::boolean(std::string_view name, bool fallback) const {
    const std::string_view* text = given(name);
    if (text == nullptr) return fallback;
    std::string_view rest = *text;
    const std::string_view word = next_word(rest);
    if (word == "true" || word == "TRUE") return true;
    if (word == "false" || word == "FALSE") return false;
    if (!messages_.is_strict() && word == "True") return true;  // as Python writes it
    if (!messages_.is_strict() && word == "False") return false;
    reject(name, in_quotes(*text) + " is neither true nor false");
    return fallback;
}

template <typename T>
bool Fields::read_word(std::string_view name, std::string_view word, T& value) const {
    constexpr bool kIsInteger = std::is_integral_v<T>;
    const NumberVerdict verdict = read(word, value);
    if (verdict == NumberVerdict::kNumber) return true;
    const char* reason =
        verdict == NumberVerdict::kNotANumber
            ? (kIsInteger ? " is not an integer" : " is not a number")
            : (kIsInteger ? " is beyond 32-bit integers" : " is beyond the range of double");
    reject(name, in_quotes(word) + reason);
    return false;
}

template <typename T>
BigVector<T> Fields::words(std::string_view name) const {
    BigVector<T> values;
    const std::string_view* text = element_.find(name);
    if (text == nullptr) return values;
    constexpr std::size_t kSample = 256;
    if (threads_ > 1 && read_in_parts(*text, threads_, values)) return values;
    std::string_view rest = *text;
    for (skip_separators(rest); !rest.empty(); skip_separators(rest)) {
        T value{};
        if (!take_number(rest, value) && !read_word(name, next_word(rest), value)) return {};
        values.push_back(value);
        // Room for as many as the first ones tell of: what is never used is never touched.
        if (values.size() == kSample)
            values.reserve(kSample * text->size() / (text->size() - rest.size()) + kSample);
    }
    return values;
}

Numbers Fields::numbers(std::string_view name) const { return words<double>(name); }

Integers Fields::integers(std::string_view name) const { return words<std::int32_t>(name); }

std::vector<std::string> Fields::strings(std::string_view name) const {
    std::vector<std::string> values;
    const std::string_view* text = element_.find(name);
    if (text == nullptr) return values;
    if (text->find('"') == std::string_view::npos) {
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

template <std::size_t N>
bool Fields::tuple(std::string_view name, std::array<double, N>& values) const {
    const std::string_view* text = given(name);
    if (text == nullptr) return false;
    std::array<double, N> read{};
    std::size_t count = 0;
    std::string_view rest = *text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        double value = 0;
        if (!read_word(name, word, value)) return false;
        if (count < N) read[count] = value;
        ++count;
    }
    if (count == N) {
        values = read;
        return true;
    }
    reject(name, std::to_string(count) + " numbers where " + std::to_string(N) + " belong");
    return false;
}

double Fields::number(std::string_view name, double fallback) const {
    std::array<double, 1> values{fallback};
    tuple(name, values);
    return values[0];
}

std::array<double, 2> Fields::pair(std::string_view name, double first, double second) const {
    std::array<double, 2> values{first, second};
    tuple(name, values);
    return values;
}

Vector3 Fields::vector(std::string_view name, const Vector3& fallback) const {
    std::array<double, 3> values{fallback.x, fallback.y, fallback.z};
    tuple(name, values);
    return {values[0], values[1], values[2]};
}

Matrix3 Fields::rotation(std::string_view name) const {
    std::array<double, 4> values{};
    if (!tuple(name, values)) return {};
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

double Fields::clamped(std::string_view name, double value, Range range) const {
    if (range.is_beyond(value)) warn_clamped(name, range);
    return range.nearest(value);
}

double Fields::clamped_number(std::string_view name, double fallback, Range range) const {
    return clamped(name, number(name, fallback), range);
}

Vector3 Fields::clamped_vector(std::string_view name, const Vector3& fallback, Range range) const {
    const Vector3 v = vector(name, fallback);
    const Vector3 clamped{range.nearest(v.x), range.nearest(v.y), range.nearest(v.z)};
    if (clamped != v) warn_clamped(name, range);
    return clamped;
}

Numbers Fields::clamped_numbers(std::string_view name, Range range) const {
    Numbers values = numbers(name);
    for (double& value : values) value = clamped(name, value, range);
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
    const Numbers values = whole(name, 3, "triples", "triple");
    std::vector<Vector3> vectors;
    vectors.reserve(values.size() / 3);
    for (std::size_t i = 0; i < values.size(); i += 3)
        vectors.push_back({values[i], values[i + 1], values[i + 2]});
    return vectors;
}

Numbers Fields::whole(std::string_view name, std::size_t size, const char* plural,
                      const char* single) const {
    Numbers values = numbers(name);
    const std::size_t over = values.size() % size;
    if (over == 0) return values;
    if (messages_.is_strict())
        refuse(name, std::to_string(values.size()) + " numbers are no list of " + plural);
    warn(name, "with an incomplete last " + std::string(single) + ", which is left out");
    values.resize(values.size() - over);
    return values;
}

std::vector<Vector3> Fields::pairs(std::string_view name) const {
    const Numbers values = whole(name, 2, "pairs", "pair");
    std::vector<Vector3> pairs;
    for (std::size_t i = 0; i < values.size(); i += 2)
        pairs.push_back({values[i], 0, values[i + 1]});
    return pairs;
}

std::vector<Matrix3> Fields::rotations(std::string_view name) const {
    const Numbers values = whole(name, 4, "rotations", "rotation");
    std::vector<Matrix3> matrices;
    for (std::size_t i = 0; i < values.size(); i += 4)
        matrices.push_back(
            nuvo::rotation({values[i], values[i + 1], values[i + 2]}, values[i + 3]));
    return matrices;
}

}  // namespace nuvo::x3d
