#include "children.h"

#include <algorithm>
#include <vector>

#include "node_names.h"

namespace nuvo::x3d {

namespace {

/// Metadata, declarations and statements stand among the children, but are none.
bool is_content(const Element& child) {
    return !is_silent(child.name) && child.name != "ROUTE" && child.name != "IMPORT";
}

/// What a Switch or an LOD counts. A WorldInfo is an X3DChildNode, though nothing of it is drawn.
bool is_child_node(const Element& child) { return child.name == "WorldInfo" || is_content(child); }

std::size_t count_children(const Element& parent) {
    return static_cast<std::size_t>(
        std::count_if(parent.children.begin(), parent.children.end(), is_child_node));
}

/// The viewer's distance from `center` in the units of the placement; a placement without a volume
/// has none, and the distance is zero.
double local_distance(const Placement& placement, const Point3& center, const Point3& viewer) {
    const Matrix3& linear = placement.to_world.linear;
    const double determinant = linear.determinant();
    if (placement.singular || determinant == 0) return 0;
    const Vector3 local =
        linear.adjugate() * (viewer - placement.to_world.translation) / determinant;
    return length(local - center);
}

}  // namespace

bool is_proxy(const Element& child) {
    const std::string_view* field = child.find("containerField");
    return field != nullptr && *field == "proxy";
}

std::vector<bool> drawn_layers(const Element& node, const Fields& fields) {
    Integers order = fields.integers("order");
    if (order.empty()) order = {0};
    std::vector<bool> drawn;
    std::int32_t layer = 0;
    for (const Element& child : node.children) {
        if (is_content(child)) ++layer;
        drawn.push_back(std::find(order.begin(), order.end(), layer) != order.end());
    }
    return drawn;
}

const Element* child_at(const Element& parent, std::size_t number) {
    for (const Element& child : parent.children)
        if (is_child_node(child) && number-- == 0) return &child;
    return nullptr;
}

const Element* chosen_child(const Element& node, const Fields& fields) {
    const Integers choice = fields.integers("whichChoice");
    if (choice.size() > 1) fields.reject("whichChoice", "is more than one number");
    if (choice.size() != 1 || choice[0] < 0) return nullptr;
    return child_at(node, static_cast<std::size_t>(choice[0]));
}

const Element* chosen_level(const Element& node, const Fields& fields, const Placement& placement,
                            const Point3& viewer) {
    const std::size_t levels = count_children(node);
    if (levels == 0) return nullptr;
    const double distance = local_distance(placement, fields.vector("center", {}), viewer);
    std::size_t level = 0;
    for (const double range : fields.numbers("range")) {
        if (distance < range) break;
        ++level;
    }
    return child_at(node, level < levels ? level : levels - 1);
}

std::size_t count_shapes(const Element& element, const Documents& documents) {
    std::size_t count = 0;
    std::vector<const Element*> pending{&element};
    while (!pending.empty()) {
        const Element& node = pending.back()->node();
        pending.pop_back();
        if (node.name == "Shape") {
            ++count;
            continue;
        }
        if (const Document* document = documents.inlined(node); document != nullptr)
            pending.push_back(document->scene);
        for (const Element& child : node.children)
            if (leads_to_shapes(child)) pending.push_back(&child);
    }
    return count;
}

}  // namespace nuvo::x3d
