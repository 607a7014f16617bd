#include "names.h"

#include "node_names.h"

namespace nuvo::x3d {

void Names::note(std::string_view spelled, Name& name, bool is_attribute, const Element& element) {
    if (name.count++ > 0) return;
    name.first = &element;
    noted_.push_back({spelled, &name, is_attribute});
}

void Names::name_element(std::string_view spelled, Element& element) {
    auto found = elements_.find(spelled);
    if (found == elements_.end()) {
        found = elements_.try_emplace(std::string(spelled)).first;
        const std::string_view right = strict_ ? std::string_view{} : right_spelling(spelled);
        found->second.meant = right.empty() ? std::string_view(found->first) : right;
    }
    Name& name = found->second;
    element.name = name.meant;
    if (name.meant != found->first) note(found->first, name, false, element);
}

std::string_view Names::attribute_name(std::string_view spelled, const Element& element) {
    ByName<Name>& names = attributes_[element.name];
    auto found = names.find(spelled);
    if (found == names.end()) {
        found = names.try_emplace(std::string(spelled)).first;
        constexpr std::size_t kMostSuggestions = 1000;  // each takes some microseconds
        const FieldName field = find_field(element.name, spelled, names.size() < kMostSuggestions);
        const bool is_taken = !strict_ && field.name != spelled;
        found->second.meant = is_taken ? field.name : std::string_view(found->first);
        if (!is_taken)
            found->second.suggestion = field.name != spelled ? field.name : field.suggestion;
    }
    Name& name = found->second;
    if (name.meant != found->first || !name.suggestion.empty())
        note(found->first, name, true, element);
    return name.meant;
}

void warn_of_no_field(std::string_view node, std::string_view field, std::string_view suggestion,
                      const Element& element, Messages& messages, std::size_t count) {
    std::string what = "there is no such field";
    if (!suggestion.empty()) what += ": did you mean " + std::string(suggestion) + "?";
    if (messages.is_strict()) messages.refuse(element, excerpt(field), what);
    messages.warn(excerpt(node) + "@" + excerpt(field), "left out, as " + what, element, count);
}

void Names::warn(Messages& messages) const {
    for (const Noted& noted : noted_) {
        const Name& name = *noted.name;
        if (!name.suggestion.empty()) {
            warn_of_no_field(name.first->name, noted.spelled, name.suggestion, *name.first,
                             messages, name.count);
            continue;
        }
        std::string subject(noted.is_attribute ? std::string(name.first->name) + "@" : "");
        subject += excerpt(noted.spelled);
        messages.warn(subject, "read as " + std::string(name.meant), *name.first, name.count);
    }
}

}  // namespace nuvo::x3d
