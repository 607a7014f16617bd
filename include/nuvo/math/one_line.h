#pragma once

#include <string>
#include <string_view>

namespace nuvo {

/// What others wrote, for a message of one line: a `?` for each control character.
inline std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
    return text;
}

/// The beginning of it, where it may be long.
inline std::string excerpt(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    std::string shown = one_line(std::string(text.substr(0, kLongest)));
    if (text.size() > kLongest) shown += "...";
    return shown;
}

}  // namespace nuvo
