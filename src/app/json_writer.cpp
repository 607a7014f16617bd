#include "nuvo/app/json_writer.h"

#include <array>
#include <charconv>
#include <cmath>

namespace nuvo::app {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Length of the well-formed UTF-8 sequence at the start (Unicode, table 3-7); 0 where there is
/// none.
std::size_t sequence_length(std::string_view text) {
    const unsigned char lead = byte_at(text, 0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xc2 && lead < 0xe0   ? 2
                               : lead >= 0xe0 && lead < 0xf0 ? 3
                               : lead >= 0xf0 && lead < 0xf5 ? 4
                                                             : 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
    const unsigned char second = byte_at(text, 1);
    const bool is_overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool is_surrogate = lead == 0xed && second >= 0xa0;
    const bool is_too_large = lead == 0xf4 && second >= 0x90;
    return is_overlong || is_surrogate || is_too_large ? 0 : length;
}

}  // namespace

std::string valid_utf8(std::string_view text) {
    std::string valid;
    while (!text.empty()) {
        const std::size_t length = sequence_length(text);
        valid += length == 0 ? std::string_view("\xef\xbf\xbd") : text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return valid;
}

void JsonWriter::key(std::string_view name) {
    value(name);
    text_ += ": ";
    has_name_ = true;
}

void JsonWriter::value(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    separate();
    text_ += '"';
    for (const char c : valid_utf8(text)) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text_ += '\\';
            text_ += c;
        } else if (code < 0x20) {
            text_ += "\\u00";
            text_ += kHex[code >> 4];
            text_ += kHex[code & 15];
        } else {
            text_ += c;
        }
    }
    text_ += '"';
}

void JsonWriter::value(double number) {
    if (!std::isfinite(number)) {
        null();
        return;
    }
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    literal({digits.data(), end});
}

void JsonWriter::value(const std::vector<double>& numbers) {
    begin_array();
    for (const double number : numbers) value(number);
    end_array();
}

void JsonWriter::open(char bracket) {
    separate();
    text_ += bracket;
    ++level_;
    is_first_ = true;
}

void JsonWriter::close(char bracket) {
    --level_;
    if (!is_first_) new_line();
    text_ += bracket;
    is_first_ = false;
}

void JsonWriter::literal(std::string_view text) {
    separate();
    text_ += text;
}

void JsonWriter::separate() {
    if (!has_name_ && level_ > 0) {
        if (!is_first_) text_ += ',';
        new_line();
    }
    has_name_ = false;
    is_first_ = false;
}

void JsonWriter::new_line() {
    text_ += '\n';
    text_.append(static_cast<std::size_t>(2 * level_), ' ');
}

}  // namespace nuvo::app
