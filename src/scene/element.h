#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace nuvo::x3d {

/// The names of a document's elements and attributes, each kept once.
class Names {
  public:
    /// The kept copy of `name`; valid as long as this lives, moved or not.
    std::string_view keep(std::string_view name) {
        const auto found = names_.find(name);
        return found != names_.end() ? *found : *names_.emplace(name).first;
    }

  private:
    struct Hash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    std::unordered_set<std::string, Hash, std::equal_to<>> names_;
};

struct Attribute {
    std::string_view name;
    std::string value;
};

/// One XML element of a document that has been checked; text and comments are gone. Names are views
/// into the document's Names.
struct Element {
    std::string_view name;
    std::vector<Attribute> attributes;
    std::vector<Element> children;
    const Element* target = nullptr;  ///< what this element's USE names; null without a USE
    std::uint32_t line = 0;           ///< of the start tag, counted from 1

    /// The attribute's value; null when it is not given.
    const std::string* find(std::string_view attribute) const {
        for (const Attribute& a : attributes)
            if (a.name == attribute) return &a.value;
        return nullptr;
    }
    /// The node that stands here: itself, or what its USE names.
    const Element& node() const { return target != nullptr ? *target : *this; }
};

/// Declarations of prototypes have names of their own and are not drawn.
inline bool is_declaration(const Element& element) {
    return element.name == "ProtoDeclare" || element.name == "ExternProtoDeclare";
}

/// The element's place in the document, e.g. `Scene/Transform[3]/Shape/Sphere`: numbers count
/// siblings of one name from 1 and are left out where there is one; a very deep place loses its
/// middle. Empty where the element is not in the document. Takes time linear in the document: for
/// messages only.
std::string place_of(const Element& root, const Element& element);

}  // namespace nuvo::x3d
