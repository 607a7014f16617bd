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
    Location location = locate(element);
    if (!attribute.empty()) {
        location.place += '@';
        location.place += attribute;
    }
    throw Error(documents_[location.document].file + ": " + location.place + ": " + reason +
                " (line " + std::to_string(element.line) + ")");
}

Messages::Location Messages::locate(const Element& element) const {
    for (std::size_t i = 0; i < documents_.size(); ++i) {
        std::string place = place_of(*documents_[i].root, element);
        if (!place.empty()) return {i, std::move(place)};
    }
    return {0, std::string(element.name)};
}

bool Messages::warn(std::string_view subject, std::string_view what, const Element& element) {
    if (muted_) return false;
    if (latest_ < warnings_.size() && warnings_[latest_].subject == subject &&
        warnings_[latest_].what == what) {
        ++warnings_[latest_].count;
        return false;
    }
    std::string kind(subject);
    kind += '\n';
    kind += what;
    const auto [entry, is_new] = index_.try_emplace(std::move(kind), warnings_.size());
    latest_ = entry->second;
    if (is_new)
        warnings_.push_back({std::string(subject), std::string(what), &element, 1});
    else
        ++warnings_[latest_].count;
    return is_new;
}

std::vector<std::string> Messages::warnings() const {
    constexpr std::size_t kMost = 100;  // finding a place takes time linear in the document
    std::vector<std::string> lines;
    for (const Warning& warning : warnings_) {
        if (lines.size() == kMost) {
            lines.push_back(std::to_string(warnings_.size() - kMost) + " more kinds of warnings");
            break;
        }
        const Location location = locate(*warning.first);
        const std::string where =
            location.document == 0 ? "" : "in " + documents_[location.document].file + " ";
        lines.push_back(warning.subject + ": " + std::to_string(warning.count) + " " +
                        warning.what + " (first " + where + "at " + location.place + ")");
    }
    return lines;
}

}  // namespace nuvo::x3d
