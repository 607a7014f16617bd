#include "element.h"

#include <vector>

#include "messages.h"

namespace nuvo::x3d {

namespace {

struct Visit {
    const Element* element;
    const Element* next_child;
};

std::string step_name(const Element* parent, const Element& element) {
    const std::string name = excerpt(element.name);
    if (parent == nullptr) return name;
    std::size_t same_name = 0;
    std::size_t number = 0;
    for (const Element& sibling : parent->children) {
        if (sibling.name != element.name) continue;
        ++same_name;
        if (&sibling == &element) number = same_name;
    }
    if (same_name < 2) return name;
    return name + "[" + std::to_string(number) + "]";
}

}  // namespace

std::string place_of(const Element& root, const Element& element) {
    std::vector<Visit> path{{&root, root.children.first}};
    while (!path.empty() && path.back().element != &element) {
        Visit& top = path.back();
        const Element* child = top.next_child;
        if (child == nullptr) {
            path.pop_back();
            continue;
        }
        top.next_child = child->next;
        path.push_back({child, child->children.first});
    }
    constexpr std::size_t kShownAtEachEnd = 12;
    std::string place;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (path.size() > 2 * kShownAtEachEnd && i == kShownAtEachEnd) {
            place += "/...";
            i = path.size() - kShownAtEachEnd;
        }
        if (i == 0 && path.size() > 1 && root.name == "X3D") continue;
        if (!place.empty()) place += '/';
        place += step_name(i == 0 ? nullptr : path[i - 1].element, *path[i].element);
    }
    return place;
}

}  // namespace nuvo::x3d
