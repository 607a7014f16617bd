#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>

namespace nuvo::x3d {

struct Attribute {
    std::string_view name;
    std::string_view value;
};

struct Element;

/// The children of an element, in document order.
class ElementList {
  public:
    template <typename E>
    class Iterator {
      public:
        using value_type = E;
        using difference_type = std::ptrdiff_t;
        using pointer = E*;
        using reference = E&;
        using iterator_category = std::forward_iterator_tag;

        Iterator() = default;
        explicit Iterator(E* element) : element_(element) {}
        E& operator*() const { return *element_; }
        E* operator->() const { return element_; }
        Iterator& operator++() {
            element_ = element_->next;
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

      private:
        E* element_ = nullptr;
    };

    bool empty() const { return first == nullptr; }
    Iterator<Element> begin() { return Iterator<Element>(first); }
    Iterator<Element> end() { return {}; }
    Iterator<const Element> begin() const { return Iterator<const Element>(first); }
    Iterator<const Element> end() const { return {}; }

    Element* first = nullptr;
};

/// One XML element of a document that has been checked; text and comments are gone. A value without
/// an owner of its own: elements, attributes and their text live in the document's ElementArena.
struct Element {
    std::string_view name;
    std::span<const Attribute> attributes;
    ElementList children;
    Element* next = nullptr;  ///< the sibling after it
    /// What stands here instead: the node that a USE names, or the one that a ProtoInstance makes.
    const Element* target = nullptr;
    std::uint32_t line = 0;  ///< of the start tag, counted from 1

    /// The attribute's value; null when it is not given.
    const std::string_view* find(std::string_view attribute) const {
        for (const Attribute& a : attributes)
            if (a.name == attribute) return &a.value;
        return nullptr;
    }
    /// The attribute's value; empty when it is not given.
    std::string_view text(std::string_view attribute) const {
        const std::string_view* value = find(attribute);
        return value != nullptr ? *value : std::string_view{};
    }
    /// The node that stands here: itself, or what its USE or its prototype puts in its place.
    const Element& node() const {
        const Element* element = this;
        while (element->target != nullptr) element = element->target;
        return *element;
    }
    /// The name of that node, e.g. "Shape".
    std::string_view kind() const { return node().name; }
};

/// The target of what names nothing: a node of no kind, of which no word is said.
inline constexpr Element kNothing{};

/// Where a document's elements live: all are made one after the other and end together, which costs
/// nothing.
class ElementArena {
  public:
    Element* make_element() { return allocator_.new_object<Element>(); }
    std::span<Attribute> make_attributes(std::size_t count) {
        if (count == 0) return {};
        Attribute* first = allocator_.allocate_object<Attribute>(count);
        std::uninitialized_value_construct_n(first, count);
        return {first, count};
    }
    std::string_view copy(std::string_view text) {
        if (text.empty()) return {};
        char* first = allocator_.allocate_object<char>(text.size());
        text.copy(first, text.size());
        return {first, text.size()};
    }

  private:
    std::pmr::monotonic_buffer_resource memory_;
    std::pmr::polymorphic_allocator<> allocator_{&memory_};
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
