#pragma once

#include <cstddef>
#include <functional>

#include "element.h"
#include "messages.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// What an element becomes with every USE, prototype and Inline in it expanded, as far as it can be
/// drawn. With the limits checked at each step the sums stay far below overflow.
struct Extent {
    std::size_t elements = 0;
    std::size_t shapes = 0;
    std::size_t height = 0;  ///< levels, the element's own included
};

/// What an Inline node brings in; null: nothing.
using InlineExtent = std::function<const Extent*(const Element& node)>;

/// True for a child that lists again what stands elsewhere, as an HAnimHumanoid does with its
/// joints, or what moves it: it is not drawn there.
bool is_listing(const Element& child);

/// True where drawing goes on below a child of the scene graph: scripts, sensors and declarations
/// may refer to anything, but nothing of them is drawn.
bool leads_to_shapes(const Element& child);

/// Counts what the scene becomes when all its USEs, which have their targets, are expanded. Throws
/// Error where that breaks `limits`, and where a USE is inside its own DEF. Nothing is expanded.
Extent measure(const Element& scene, const InlineExtent& inlined, const Limits& limits,
               const Messages& messages);

}  // namespace nuvo::x3d
