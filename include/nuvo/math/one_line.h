#pragma once

#include <string>

namespace nuvo {

/// What others wrote, for a message of one line: a `?` for each control character.
inline std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = '?';
    return text;
}

}  // namespace nuvo
