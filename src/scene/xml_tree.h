#pragma once

#include <functional>
#include <memory>
#include <memory_resource>
#include <string_view>
#include <utility>

namespace nuvo::x3d {

/// A tree that Boost.PropertyTree's XML parser fills in place of its own, which takes six
/// allocations an element: nodes in one piece of memory, whose names and values stand in the
/// parser's buffer. The parser fills a tree that it makes and swaps it with the one it was given
/// while that buffer lives: this is when the tree is read. The members with the parser's spelling
/// are what it asks of a tree.
class XmlTree {
  public:
    /// A text in the parser's buffer. The parser makes its words "<xmlattr>" and the like letter by
    /// letter; which of them is meant is told by where they stand.
    class key_type {
      public:
        using value_type = char;
        key_type() = default;
        key_type(const char* text, std::size_t size) : text_(text, size) {}
        key_type& operator+=(char) { return *this; }
        std::string_view text() const { return text_; }

      private:
        std::string_view text_;
    };
    /// What a node holds: of an attribute its value. An element's text is left out.
    struct Content {
        std::string_view text;
        void operator=(key_type value) { text = value.text(); }
        void operator+=(key_type) {}
    };
    /// As an iterator to a new child, of which the parser wants the tree.
    struct Place {
        XmlTree& second;
        Place* operator->() { return this; }
    };
    using Reader = std::function<void(const XmlTree&)>;

    XmlTree() = default;
    /// To be handed to the parser: `read` is called once, with what was parsed.
    explicit XmlTree(const Reader& read) : read_(&read) {}
    /// A comment or a text as a node of its own: not asked for.
    explicit XmlTree(key_type) {}
    explicit XmlTree(const char*) {}

    /// A child element; of attributes one of them.
    Place push_back(std::pair<char*, XmlTree>&& named) {
        XmlTree& child = make_node();
        child.name_ = named.first;
        (last_ == nullptr ? first_ : last_->next_) = &child;
        last_ = &child;
        ++count_;
        return {child};
    }
    /// What holds the attributes.
    Place push_back(std::pair<key_type, XmlTree>&&) { return {*(attributes_ = &make_node())}; }
    Content& data() { return content_; }
    void swap(XmlTree& parsed) { (*read_)(parsed); }

    std::string_view name() const { return name_; }
    std::string_view value() const { return content_.text; }
    const XmlTree* first_child() const { return first_; }
    const XmlTree* first_attribute() const {
        return attributes_ != nullptr ? attributes_->first_ : nullptr;
    }
    std::size_t attribute_count() const { return attributes_ != nullptr ? attributes_->count_ : 0; }
    const XmlTree* next() const { return next_; }

  private:
    using Memory = std::pmr::monotonic_buffer_resource;

    /// Nodes own nothing, and end with the root that owns their memory.
    XmlTree& make_node() {
        if (memory_ == nullptr) {
            own_memory_ = std::make_unique<Memory>();
            memory_ = own_memory_.get();
        }
        XmlTree& node = *std::pmr::polymorphic_allocator<>(memory_).new_object<XmlTree>();
        node.memory_ = memory_;
        return node;
    }

    std::string_view name_;
    Content content_;
    XmlTree* attributes_ = nullptr;
    XmlTree* first_ = nullptr;
    XmlTree* last_ = nullptr;
    XmlTree* next_ = nullptr;
    std::size_t count_ = 0;
    Memory* memory_ = nullptr;
    std::unique_ptr<Memory> own_memory_;  // of the root
    const Reader* read_ = nullptr;        // of the tree handed to the parser
};

}  // namespace nuvo::x3d
