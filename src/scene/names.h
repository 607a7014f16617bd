#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "element.h"
#include "messages.h"

namespace nuvo::x3d {

/// Warns of a field that its node does not have, or where strict refuses; `suggestion`, if any, is
/// the one that was probably meant.
void warn_of_no_field(std::string_view node, std::string_view field, std::string_view suggestion,
                      const Element& element, Messages& messages, std::size_t count = 1);

/// The names of a document's elements and attributes, each kept once, and what they stand for:
/// unless the reading is strict, one that differs from a name of X3D by the case of its letters
/// only stands for that.
class Names {
  public:
    explicit Names(bool strict) : strict_(strict) {}

    /// Gives `element` its name.
    void name_element(std::string_view spelled, Element& element);
    /// The name of an attribute of `element`, which has its name; valid as long as this lives.
    std::string_view attribute_name(std::string_view spelled, const Element& element);

    /// Warns of the names that were taken for others, and of the attributes that are no field of
    /// their node but nearly one.
    void warn(Messages& messages) const;

  private:
    struct Hash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    template <typename T>
    using ByName = std::unordered_map<std::string, T, Hash, std::equal_to<>>;

    struct Name {
        std::string_view meant;
        std::string_view suggestion;
        const Element* first = nullptr;  // with something to be said about
        std::size_t count = 0;
    };
    struct Noted {
        std::string_view spelled;
        const Name* name;
        bool is_attribute;
    };

    void note(std::string_view spelled, Name& name, bool is_attribute, const Element& element);

    bool strict_;
    ByName<Name> elements_;
    std::unordered_map<std::string_view, ByName<Name>> attributes_;  // by the element's name
    std::vector<Noted> noted_;                                       // in the document's order
};

}  // namespace nuvo::x3d
