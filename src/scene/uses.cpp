#include "uses.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace nuvo::x3d {

namespace {

struct Visit {
    Element* element;
    std::size_t next_child = 0;
    Extent extent;
};

bool has_definition(const Element& root, const std::string& name) {
    std::vector<const Element*> pending{&root};
    while (!pending.empty()) {
        const Element& element = *pending.back();
        pending.pop_back();
        const std::string* def = element.find("DEF");
        if (def != nullptr && *def == name) return true;
        for (const Element& child : element.children) pending.push_back(&child);
    }
    return false;
}

class Resolver {
  public:
    Resolver(Element& root, const InlineExtents& inlines, const Limits& limits,
             const Messages& messages)
        : root_(root), inlines_(inlines), limits_(limits), messages_(messages) {}

    Extent run() {
        enter(root_);
        while (!path_.empty()) {
            Visit& top = path_.back();
            if (top.next_child == top.element->children.size()) {
                leave();
                continue;
            }
            Element& child = top.element->children[top.next_child++];
            if (!is_declaration(child)) enter(child);
        }
        return whole_;
    }

  private:
    struct Definition {
        const Element* element;
        std::optional<Extent> extent;  // not yet known while the element is open
    };

    void enter(Element& element) {
        const std::string* use = element.find("USE");
        if (use != nullptr) {
            expand(element, *use);
            return;
        }
        const std::string* def = element.find("DEF");
        if (def != nullptr && !def->empty()) latest_[*def] = {&element, std::nullopt};
        path_.push_back({&element, 0, {}});
        const auto inlined = inlines_.find(&element);
        if (inlined != inlines_.end()) add(inlined->second, element);
    }

    void leave() {
        Visit done = path_.back();
        path_.pop_back();
        done.extent.elements += 1;
        check(done.extent.elements, limits_.elements, "elements", *done.element);
        done.extent.height += 1;
        if (done.element->name == "Shape") done.extent.shapes += 1;
        const std::string* def = done.element->find("DEF");
        if (def != nullptr) {
            // A DEF of the same name inside this element is the later one.
            const auto latest = latest_.find(*def);
            if (latest != latest_.end() && latest->second.element == done.element)
                latest->second.extent = done.extent;
        }
        if (path_.empty())
            whole_ = done.extent;
        else
            add(done.extent, *done.element);
    }

    void expand(Element& element, const std::string& name) {
        const std::string shown = "USE=\"" + excerpt(name) + "\"";
        const auto found = latest_.find(name);
        if (found == latest_.end())
            messages_.fail(
                element, "",
                shown + (has_definition(root_, name) ? " comes before its DEF" : " names no DEF"));
        const Definition& definition = found->second;
        if (!definition.extent) messages_.fail(element, "", shown + " is inside its own DEF");
        if (definition.element->name != element.name)
            messages_.fail(element, "",
                           shown + " is a " + excerpt(definition.element->name) + ", not a " +
                               excerpt(element.name));
        element.target = definition.element;
        if (!path_.empty()) add(*definition.extent, element);
    }

    /// Adds what `element` becomes to the element that is open.
    void add(const Extent& extent, const Element& element) {
        Extent& sum = path_.back().extent;
        sum.elements += extent.elements;
        sum.shapes += extent.shapes;
        sum.height = std::max(sum.height, extent.height);
        check(sum.elements, limits_.elements, "elements", element);
        check(sum.shapes, limits_.shapes, "shapes", element);
        check(path_.size() + extent.height, limits_.depth, "nested levels", element);
    }

    void check(std::size_t count, std::size_t limit, const char* what,
               const Element& element) const {
        if (count <= limit) return;
        const char* cause = element.target != nullptr     ? "USE makes"
                            : inlines_.contains(&element) ? "Inline makes"
                                                          : "this makes";
        messages_.fail(element, "",
                       std::string(cause) + " the scene exceed the limit of " +
                           std::to_string(limit) + " " + what);
    }

    Element& root_;
    const InlineExtents& inlines_;
    const Limits& limits_;
    const Messages& messages_;
    std::vector<Visit> path_;
    std::unordered_map<std::string, Definition> latest_;
    Extent whole_;
};

}  // namespace

Extent resolve_uses(Element& root, const InlineExtents& inlines, const Limits& limits,
                    const Messages& messages) {
    return Resolver(root, inlines, limits, messages).run();
}

}  // namespace nuvo::x3d
