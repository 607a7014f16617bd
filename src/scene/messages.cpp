#include "messages.h"

namespace nuvo::x3d {

void Messages::refuse(const Element& element, std::string_view attribute,
                      const std::string& reason) const {
    const Location location = locate(element, attribute);
    throw Error(documents_[location.document].file + ": " + location.place + ": " + reason +
                " (line " + std::to_string(element.line) + ")");
}

void Messages::leave_out(const Element& element, std::string_view attribute,
                         const std::string& reason) const {
    if (strict_) refuse(element, attribute, reason);
    throw LeftOut{&element, std::string(attribute), reason};
}

Messages::Location Messages::locate(const Element& element, std::string_view attribute) const {
    Location location{0, {}};
    for (std::size_t i = 0; i < documents_.size() && location.place.empty(); ++i)
        location = {i, place_of(*documents_[i].root, element)};
    if (location.place.empty()) location = {0, excerpt(element.name)};
    if (!attribute.empty()) {
        location.place += '@';
        location.place += attribute;
    }
    return location;
}

Messages::Warning& Messages::find(std::string_view subject, std::string_view what,
                                  const Element& element) {
    if (latest_ < warnings_.size() && warnings_[latest_].subject == subject &&
        warnings_[latest_].what == what)
        return warnings_[latest_];
    std::string kind(subject);
    kind += '\n';
    kind += what;
    const auto [entry, is_new] = index_.try_emplace(std::move(kind), warnings_.size());
    latest_ = entry->second;
    if (is_new) warnings_.push_back({std::string(subject), std::string(what), &element, {}, {}, 0});
    return warnings_[latest_];
}

bool Messages::warn(std::string_view subject, std::string_view what, const Element& element,
                    std::size_t count) {
    if (muted_) return false;
    Warning& warning = find(subject, what, element);
    warning.count += count;
    return warning.count == count;
}

void Messages::warn_field_left_out(const Element& element, std::string_view field,
                                   const std::string& reason) {
    if (strict_) refuse(element, field, reason);
    if (muted_) return;
    const std::string subject = std::string(element.name) + "@" + std::string(field);
    Warning& warning = find(subject, "left out", element);
    if (warning.count++ == 0) warning.reason = reason;
}

void Messages::warn_left_out(std::string_view subject, const LeftOut& left_out) {
    if (strict_) refuse(*left_out.element, left_out.attribute, left_out.reason);
    if (muted_) return;
    Warning& warning = find(excerpt(subject), "left out", *left_out.element);
    if (warning.count++ > 0) return;
    warning.attribute = left_out.attribute;
    warning.reason = left_out.reason;
}

std::string Messages::line_of(const Warning& warning) const {
    const Location location = locate(*warning.first, warning.attribute);
    std::string line =
        warning.subject + ": " + std::to_string(warning.count) + " " + warning.what + " (first ";
    if (location.document > 0) line += "in " + documents_[location.document].file + " ";
    line += "at " + location.place + ", line " + std::to_string(warning.first->line);
    if (!warning.reason.empty()) line += ": " + warning.reason;
    return line + ")";
}

std::vector<std::string> Messages::warnings() const {
    constexpr std::size_t kMost = 100;  // finding a place takes time linear in the document
    std::vector<std::string> lines;
    for (const Warning& warning : warnings_) {
        if (lines.size() == kMost) {
            lines.push_back(std::to_string(warnings_.size() - kMost) + " more kinds of warnings");
            break;
        }
        lines.push_back(line_of(warning));
    }
    return lines;
}

}  // namespace nuvo::x3d
