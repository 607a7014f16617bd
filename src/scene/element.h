#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nuvo::x3d {

struct Attribute {
    std::string name;
    std::string value;
};

/// One XML element of a document that has been checked; text and comments are gone.
struct Element {
    std::string name;
    std::vector<Attribute> attributes;
    std::vector<Element> children;
    std::uint32_t line = 0;           ///< of the start tag, counted from 1
    const Element* target = nullptr;  ///< what this element's USE names; null without a USE

    /// The attribute's value; null when it is not given.
    const std::string* find(std::string_view attribute) const {
        for (const Attribute& a : attributes)
            if (a.name == attribute) return &a.value;
        return nullptr;
    }
    /// The node that stands here: itself, or what its USE names.
    const Element& node() const { return target != nullptr ? *target : *this; }
};

/// The element's place in the document, e.g. `Scene/Transform[3]/Shape/Sphere`: numbers count
/// siblings of one name from 1 and are left out where there is one; a very deep place loses its
/// middle. Takes time linear in the
/// document: for messages only.
std::string place_of(const Element& root, const Element& element);

}  // namespace nuvo::x3d
