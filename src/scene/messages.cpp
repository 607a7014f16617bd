#include "messages.h"

namespace nuvo::x3d {

std::string excerpt(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    std::string shown;
    for (const char c : text.substr(0, kLongest)) {
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
        shown += control ? '?' : c;
    }
    if (text.size() > kLongest) shown += "...";
    return shown;
}

void Messages::fail(const Element& element, std::string_view attribute,
                    const std::string& reason) const {
    std::string place = place_of(root_, element);
    if (!attribute.empty()) {
        place += '@';
        place += attribute;
    }
    throw Error(file_ + ": " + place + ": " + reason + " (line " + std::to_string(element.line) +
                ")");
}

void Messages::warn(const std::string& subject, const std::string& what, const Element& element) {
    const auto [entry, is_new] = index_.try_emplace(subject + '\n' + what, warnings_.size());
    if (is_new)
        warnings_.push_back({subject, what, &element, 1});
    else
        ++warnings_[entry->second].count;
}

std::vector<std::string> Messages::warnings() const {
    constexpr std::size_t kMost = 100;  // finding a place takes time linear in the document
    std::vector<std::string> lines;
    for (const Warning& warning : warnings_) {
        if (lines.size() == kMost) {
            lines.push_back(std::to_string(warnings_.size() - kMost) + " more kinds of warnings");
            break;
        }
        lines.push_back(warning.subject + ": " + std::to_string(warning.count) + " " +
                        warning.what + " (first at " + place_of(root_, *warning.first) + ")");
    }
    return lines;
}

}  // namespace nuvo::x3d
