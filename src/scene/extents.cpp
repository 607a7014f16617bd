#include "extents.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "node_names.h"

namespace nuvo::x3d {

namespace {

class Measurer {
  public:
    Measurer(const InlineExtent& inlined, const Limits& limits, const Messages& messages)
        : inlined_(inlined), limits_(limits), messages_(messages) {}

    Extent run(const Element& scene) {
        enter(scene, scene, false);
        while (!path_.empty()) {
            Visit& top = path_.back();
            const Element* child = top.next_child;
            if (child == nullptr) {
                leave();
                continue;
            }
            top.next_child = child->next;
            const bool in_shape = top.in_shape || top.element->name == "Shape";
            if (in_shape || leads_to_shapes(*child)) enter(*child, child->node(), in_shape);
        }
        return whole_;
    }

  private:
    struct Visit {
        const Element* place;    // where it stands
        const Element* element;  // what stands there
        const Element* next_child;
        bool in_shape;
        Extent extent;
    };
    struct Known {
        bool is_open = true;
        Extent extent;
    };

    /// Elements that may be come to twice: those with a name, and those that are referred to.
    static bool may_be_shared(const Element& place, const Element& element) {
        // What a ProtoInstance makes stands below it.
        const bool is_made = place.name == "ProtoInstance" && place.find("USE") == nullptr &&
                             !place.children.empty();
        return (&place != &element && !is_made) || place.find("DEF") != nullptr ||
               element.find("DEF") != nullptr;
    }

    [[noreturn]] void refuse_cycle(const Element& place) const {
        const std::string_view* use = place.find("USE");
        messages_.refuse(place, "",
                         use != nullptr ? "USE=\"" + excerpt(*use) + "\" is inside its own DEF"
                                        : "is inside itself, by way of a prototype's field");
    }

    void enter(const Element& place, const Element& element, bool in_shape) {
        if (may_be_shared(place, element)) {
            const auto [known, is_new] = known_.try_emplace(&element);
            if (!is_new && known->second.is_open) refuse_cycle(place);
            if (!is_new) return add(known->second.extent, place);
        }
        check(path_.size() + 1, limits_.depth, "nested levels", place);
        path_.push_back({&place, &element, element.children.first, in_shape, {}});
        if (element.name != "Inline") return;
        if (const Extent* inlined = inlined_(element); inlined != nullptr) add(*inlined, place);
    }

    void leave() {
        Visit done = path_.back();
        path_.pop_back();
        done.extent.elements += 1;
        check(done.extent.elements, limits_.elements, "elements", *done.place);
        done.extent.height += 1;
        if (done.element->name == "Shape") done.extent.shapes += 1;
        if (may_be_shared(*done.place, *done.element)) known_[done.element] = {false, done.extent};
        if (path_.empty())
            whole_ = done.extent;
        else
            add(done.extent, *done.place);
    }

    /// Adds what stands at `place` to the element that is open.
    void add(const Extent& extent, const Element& place) {
        Extent& sum = path_.back().extent;
        sum.elements += extent.elements;
        sum.shapes += extent.shapes;
        sum.height = std::max(sum.height, extent.height);
        check(sum.elements, limits_.elements, "elements", place);
        check(sum.shapes, limits_.shapes, "shapes", place);
        check(path_.size() + extent.height, limits_.depth, "nested levels", place);
    }

    void check(std::size_t count, std::size_t limit, const char* what, const Element& place) const {
        if (count <= limit) return;
        const bool is_inline = place.name == "Inline" && inlined_(place) != nullptr;
        const char* cause = place.find("USE") != nullptr ? "USE makes"
                            : is_inline                  ? "Inline makes"
                                                         : "this makes";
        messages_.refuse(place, "",
                         std::string(cause) + " the scene exceed the limit of " +
                             std::to_string(limit) + " " + what);
    }

    const InlineExtent& inlined_;
    const Limits& limits_;
    const Messages& messages_;
    std::vector<Visit> path_;
    std::unordered_map<const Element*, Known> known_;  // of shared elements
    Extent whole_;
};

}  // namespace

bool is_listing(const Element& child) {
    const std::string_view field = child.text("containerField");
    for (const char* listing : {"joints", "segments", "sites", "skinCoord", "skinNormal",
                                "skinBindingCoords", "skinBindingNormals", "displacers"})
        if (field == listing) return true;
    return false;
}

bool leads_to_shapes(const Element& child) {
    return is_drawable(node_kind(child.kind())) && !is_listing(child);
}

Extent measure(const Element& scene, const InlineExtent& inlined, const Limits& limits,
               const Messages& messages) {
    return Measurer(inlined, limits, messages).run(scene);
}

}  // namespace nuvo::x3d
