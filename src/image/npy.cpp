#include "nuvo/image/npy.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>

#include "nuvo/math/one_line.h"

namespace nuvo::image {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;
constexpr std::string_view kBlanks = " \t\n\r";

/// A reader of the header's dictionary, a literal of Python.
class Literal {
  public:
    explicit Literal(std::string_view text) : text_(text) {}

    bool take(char c) {
        skip();
        if (text_.empty() || text_.front() != c) return false;
        text_.remove_prefix(1);
        return true;
    }
    void demand(char c) {
        if (!take(c)) throw NpyError(std::string("the header lacks '") + c + "'");
    }
    /// A text in quotes, without them.
    std::string_view quoted() {
        skip();
        const char quote = text_.empty() ? ' ' : text_.front();
        if (quote != '\'' && quote != '"') throw NpyError("the header lacks a text in quotes");
        const std::size_t end = text_.find(quote, 1);
        if (end == std::string_view::npos) throw NpyError("the header ends within a text");
        const std::string_view inside = text_.substr(1, end - 1);
        text_.remove_prefix(end + 1);
        return inside;
    }
    /// A text in quotes, with them, or a list in brackets.
    std::string type() {
        skip();
        if (text_.empty() || text_.front() != '[') return "'" + std::string(quoted()) + "'";
        std::size_t end = 0;
        int depth = 0;
        do {
            if (end == text_.size()) throw NpyError("the header ends within a list");
            depth += text_[end] == '[';
            depth -= text_[end] == ']';
            ++end;
        } while (depth > 0);
        const std::string list(text_.substr(0, end));
        text_.remove_prefix(end);
        return list;
    }
    bool truth() {
        skip();
        for (const bool value : {true, false}) {
            const std::string_view word = value ? "True" : "False";
            if (text_.substr(0, word.size()) != word) continue;
            text_.remove_prefix(word.size());
            return value;
        }
        throw NpyError("the header's fortran_order is neither True nor False");
    }
    std::vector<std::size_t> shape() {
        std::vector<std::size_t> sides;
        demand('(');
        while (!take(')')) {
            skip();
            std::size_t side = 0;
            const auto [stop, error] =
                std::from_chars(text_.data(), text_.data() + text_.size(), side);
            if (error != std::errc()) throw NpyError("the header's shape is no list of sizes");
            text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
            sides.push_back(side);
            if (!take(',')) {
                demand(')');
                break;
            }
        }
        return sides;
    }

  private:
    void skip() { text_.remove_prefix(std::min(text_.find_first_not_of(kBlanks), text_.size())); }

    std::string_view text_;
};

NpyArray parse_header(std::string_view text) {
    NpyArray array;
    Literal literal(text);
    literal.demand('{');
    while (!literal.take('}')) {
        const std::string_view key = literal.quoted();
        literal.demand(':');
        if (key == "descr") {
            array.type = literal.type();
        } else if (key == "fortran_order") {
            array.by_columns = literal.truth();
        } else if (key == "shape") {
            array.shape = literal.shape();
        } else {
            throw NpyError("the header has an unknown key '" + excerpt(key) + "'");
        }
        if (!literal.take(',')) {
            literal.demand('}');
            break;
        }
    }
    if (array.type.empty()) throw NpyError("the header lacks 'descr'");
    return array;
}

/// Values in an array of this shape. Throws NpyError where no memory holds them.
std::size_t value_count(const std::vector<std::size_t>& shape) {
    std::size_t count = 1;
    for (const std::size_t side : shape)
        if (__builtin_mul_overflow(count, side, &count)) throw NpyError("the shape is too large");
    return count;
}

/// Bytes of a value of a plain type; 0 for records and what else is not plain.
std::size_t item_bytes(const std::string& type) {
    // 'xyN' in quotes: byte order, kind, bytes
    if (type.size() < 5 || type[0] != '\'' || std::string_view("biuf").find(type[2]) > 3) return 0;
    std::size_t bytes = 0;
    std::from_chars(type.data() + 3, type.data() + type.size(), bytes);
    return bytes <= 8 ? bytes : 0;
}

template <typename T>
double value_at(const char* bytes, bool is_swapped) {
    char own[sizeof(T)];
    std::memcpy(own, bytes, sizeof own);
    if (is_swapped) std::reverse(own, own + sizeof own);
    T value;
    std::memcpy(&value, own, sizeof value);
    return static_cast<double>(value);
}

using ValueAt = double (*)(const char*, bool);

ValueAt reader_of(const std::string& type) {
    const std::string_view plain = std::string_view(type).substr(0, type.size() - 1).substr(2);
    if (plain == "f8") return value_at<double>;
    if (plain == "f4") return value_at<float>;
    if (plain == "i4") return value_at<std::int32_t>;
    if (plain == "u4") return value_at<std::uint32_t>;
    if (plain == "i2") return value_at<std::int16_t>;
    if (plain == "u2") return value_at<std::uint16_t>;
    if (plain == "i1") return value_at<std::int8_t>;
    if (plain == "u1") return value_at<std::uint8_t>;
    return nullptr;
}

}  // namespace

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
    std::string text = "{'descr': " + std::string(type) + ", 'fortran_order': False, 'shape': (";
    for (std::size_t i = 0; i < shape.size(); ++i)
        text += (i == 0 ? "" : " ") + std::to_string(shape[i]) + ",";
    if (shape.size() > 1) text.pop_back();
    text += "), }";
    const std::size_t prefix = kMagic.size() + 4;
    while ((prefix + text.size() + 1) % kAlignment != 0) text += ' ';
    text += '\n';
    std::string header(kMagic);
    header += '\x01';
    header += '\0';
    header += static_cast<char>(text.size() & 0xff);
    header += static_cast<char>(text.size() >> 8);
    return header + text;
}

bool is_npy(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

NpyArray parse_npy(std::string_view bytes) {
    const auto byte = [&bytes](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    const std::size_t at = kMagic.size();
    if (!is_npy(bytes)) throw NpyError("does not begin as an array of NumPy");
    if (bytes.size() < at + 2) throw NpyError("ends within the header");
    const unsigned version = byte(at);
    if (version < 1 || version > 3)
        throw NpyError("is of version " + std::to_string(version) + ", not 1 to 3");
    const std::size_t length_bytes = version == 1 ? 2 : 4;
    const std::size_t start = at + 2 + length_bytes;
    if (bytes.size() < start) throw NpyError("ends within the header");
    std::size_t length = 0;
    for (std::size_t i = 0; i < length_bytes; ++i)
        length |= static_cast<std::size_t>(byte(at + 2 + i)) << (8 * i);
    if (bytes.size() - start < length) throw NpyError("ends within the header");
    NpyArray array = parse_header(bytes.substr(start, length));
    array.data = bytes.substr(start + length);
    const std::size_t count = value_count(array.shape);
    if (const std::size_t each = item_bytes(array.type); each != 0)
        if (array.data.size() % each != 0 || array.data.size() / each != count)
            throw NpyError("holds " + std::to_string(array.data.size()) + " bytes of data, not " +
                           std::to_string(count) + " times " + std::to_string(each));
    return array;
}

std::vector<double> npy_doubles(const NpyArray& array) {
    const std::size_t each = item_bytes(array.type);
    const ValueAt value = each == 0 ? nullptr : reader_of(array.type);
    if (value == nullptr)
        throw NpyError("is of type " + excerpt(array.type) +
                       ", not of float64, float32 or integers of up to 32 bits");
    const bool is_swapped = array.type[1] == '>';
    std::vector<double> values(array.data.size() / each);
    if (!is_swapped && value == static_cast<ValueAt>(value_at<double>)) {
        if (!values.empty()) std::memcpy(values.data(), array.data.data(), array.data.size());
    } else {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = value(array.data.data() + i * each, is_swapped);
    }
    if (!array.by_columns || array.shape.size() < 2 || values.empty()) return values;
    if (array.shape.size() != 2) throw NpyError("is by columns, of more than two sides");
    std::vector<double> by_rows(values.size());
    const std::size_t rows = array.shape[0], columns = array.shape[1];
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column)
            by_rows[row * columns + column] = values[column * rows + row];
    return by_rows;
}

}  // namespace nuvo::image
