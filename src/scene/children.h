#pragma once

#include <cstddef>
#include <vector>

#include "documents.h"
#include "fields.h"
#include "placement.h"

namespace nuvo::x3d {

/// Collision's proxy, which is not to be drawn.
bool is_proxy(const Element& child);

/// For each child of a LayerSet whether it is drawn: its `order` names it, counting from 1.
std::vector<bool> drawn_layers(const Element& node, const Fields& fields);

/// The child node of that number, from 0; metadata, declarations and routes are none. Null where
/// there are fewer.
const Element* child_at(const Element& parent, std::size_t number);

/// The one child that a Switch draws; null: none.
const Element* chosen_child(const Element& node, const Fields& fields);

/// The one level that an LOD draws for a viewer at `viewer`, in world space; null: none.
/// (ISO/IEC 19775-1 clause 23)
const Element* chosen_level(const Element& node, const Fields& fields, const Placement& placement,
                            const Point3& viewer);

/// The Shapes in and below an element, each USE and Inline counted.
std::size_t count_shapes(const Element& element, const Documents& documents);

}  // namespace nuvo::x3d
