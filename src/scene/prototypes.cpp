#include "prototypes.h"

#include <algorithm>
#include <string>
#include <vector>

#include "names.h"
#include "node_names.h"

namespace nuvo::x3d {

namespace {

/// What a field of an instance holds: a value, or nodes.
struct FieldContent {
    const std::string_view* value = nullptr;
    const Element* nodes = nullptr;  // their parent
    bool from_instance = false;      // else a default, whose names are those of the declaration
};
/// By the name of each field that the prototype has.
using Contents = std::unordered_map<std::string_view, FieldContent>;

class Copier {
  public:
    Copier(const Element& declaration, const Element& instance, MadeElements& made,
           ElementArena& arena)
        : instance_(instance), made_(made), arena_(arena) {
        for (const Element& part : declaration.children)
            if (part.name == "ProtoInterface") read_fields(part, "field", false);
        read_fields(instance, "fieldValue", true);
    }

    /// A copy of `from` without siblings. Recursion as deep as the body.
    Element* copy(const Element& from) {
        made_.take(1, 0, instance_);
        Element& element = *arena_.make_element();
        element.name = from.name;
        element.line = from.line;
        element.attributes = from.attributes;
        Element* last = nullptr;
        for (const Element& child : from.children) {
            if (child.name == "IS")
                connect(child, element, last);
            else if (child.name != "Script" && child.name != "ROUTE" && !is_declaration(child))
                append(copy(child), element, last);
        }
        return &element;
    }

  private:
    void read_fields(const Element& parent, std::string_view statement, bool from_instance) {
        for (const Element& field : parent.children) {
            made_.take(1, 0, instance_);
            if (field.name != statement) continue;
            const std::string_view name = field.text("name");
            if (from_instance && !contents_.contains(name)) {
                warn_of_no_field(instance_.text("name"), name, similar_field(name), field,
                                 made_.messages);
                continue;
            }
            FieldContent& kept = contents_[name];
            FieldContent content{field.find("value"), nullptr, from_instance};
            for (const Element& child : field.children)
                if (!is_silent(child.name)) content.nodes = &field;
            if (content.value != nullptr || content.nodes != nullptr) kept = content;
        }
    }

    std::string_view similar_field(std::string_view name) const {
        constexpr std::size_t kMostNames = 100;
        if (contents_.size() > kMostNames || !made_.may_suggest()) return {};
        std::vector<std::string_view> names;
        for (const auto& [field, content] : contents_) names.push_back(field);
        std::sort(names.begin(), names.end());
        return nearest_name(names, name);
    }

    static void append(Element* child, Element& parent, Element*& last) {
        (last != nullptr ? last->next : parent.children.first) = child;
        last = child;
    }

    /// Replaces what the `connect` statements of an IS name.
    void connect(const Element& is, Element& element, Element*& last) {
        std::vector<Attribute> changed(element.attributes.begin(), element.attributes.end());
        for (const Element& connect : is.children) {
            made_.take(1, 0, instance_);
            const auto content = contents_.find(connect.text("protoField"));
            if (connect.name != "connect" || content == contents_.end()) continue;
            if (content->second.value == nullptr && content->second.nodes == nullptr) continue;
            const std::string_view field = connect.text("nodeField");
            if (element.name == "ProtoInstance") {
                append(field_value(field, content->second), element, last);
            } else if (content->second.nodes != nullptr) {
                append_nodes(content->second, field, element, last);
            } else {
                std::erase_if(changed, [&](const Attribute& a) { return a.name == field; });
                changed.push_back({field, *content->second.value});
            }
        }
        made_.take(0, changed.size(), instance_);
        const std::span<Attribute> kept = arena_.make_attributes(changed.size());
        std::copy(changed.begin(), changed.end(), kept.begin());
        element.attributes = kept;
    }

    /// A fieldValue for an instance within the body.
    Element* field_value(std::string_view name, const FieldContent& content) {
        const bool has_value = content.value != nullptr;
        made_.take(1, 2, instance_);
        Element& element = *arena_.make_element();
        element.name = "fieldValue";
        element.line = instance_.line;
        const std::span<Attribute> attributes = arena_.make_attributes(has_value ? 2 : 1);
        attributes[0] = {"name", name};
        if (has_value) attributes[1] = {"value", *content.value};
        element.attributes = attributes;
        Element* last = nullptr;
        if (content.nodes != nullptr) append_nodes(content, {}, element, last);
        return &element;
    }

    /// Appends the nodes of a field: those that the instance gives belong to the scene around it
    /// and are referred to; defaults are copied.
    void append_nodes(const FieldContent& content, std::string_view field, Element& parent,
                      Element*& last) {
        for (const Element& node : content.nodes->children) {
            if (!content.from_instance) {
                append(copy(node), parent, last);
                continue;
            }
            made_.take(1, 1, instance_);
            Element& reference = *arena_.make_element();
            reference.name = node.name;
            reference.line = node.line;
            reference.target = &node;
            if (!field.empty()) {
                const std::span<Attribute> attributes = arena_.make_attributes(1);
                attributes[0] = {"containerField", field};
                reference.attributes = attributes;
            }
            append(&reference, parent, last);
        }
    }

    const Element& instance_;
    MadeElements& made_;
    ElementArena& arena_;
    Contents contents_;
};

}  // namespace

const Element* body_of(const Element& declaration) {
    for (const Element& part : declaration.children)
        if (part.name == "ProtoBody") return &part;
    return nullptr;
}

// Recursion as deep as the body.
void check_connections(const Element& node, MadeElements& made) {
    for (const Element& child : node.children) {
        if (child.name != "IS" || node.name == "ProtoInstance") {  // its fields are its own
            check_connections(child, made);
            continue;
        }
        for (const Element& connect : child.children) {
            const std::string_view field = connect.text("nodeField");
            if (connect.name != "connect" || field.empty()) continue;
            const FieldName found = find_field(node.name, field, made.may_suggest());
            const std::string_view meant = found.name != field ? found.name : found.suggestion;
            if (!meant.empty()) warn_of_no_field(node.name, field, meant, connect, made.messages);
        }
    }
}

void MadeElements::take(std::size_t more_elements, std::size_t more_attributes,
                        const Element& instance) {
    elements += more_elements;
    attributes += more_attributes;
    const bool too_many_elements = elements > limits.elements;
    if (!too_many_elements && attributes <= limits.attributes) return;
    messages.refuse(instance, "",
                    "prototypes make the scene exceed the limit of " +
                        (too_many_elements ? std::to_string(limits.elements) + " elements"
                                           : std::to_string(limits.attributes) + " attributes"));
}

Element* instantiate(const Element& declaration, const Element& instance, MadeElements& made,
                     ElementArena& arena) {
    const Element* body = body_of(declaration);
    if (body == nullptr) return nullptr;
    for (const Element& node : body->children)
        if (!is_silent(node.name) && node.name != "Script" && node.name != "ROUTE")
            return Copier(declaration, instance, made, arena).copy(node);
    return nullptr;
}

}  // namespace nuvo::x3d
