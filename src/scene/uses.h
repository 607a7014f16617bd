#pragma once

#include <cstddef>
#include <unordered_map>

#include "element.h"
#include "messages.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// What an element becomes with every USE and Inline in it expanded. With the limits checked at
/// each step the sums stay far below overflow.
struct Extent {
    std::size_t elements = 0;
    std::size_t shapes = 0;
    std::size_t height = 0;  ///< levels, the element's own included
};

/// What the Inline nodes of a document bring in.
using InlineExtents = std::unordered_map<const Element*, Extent>;

/// Points every USE at the latest DEF of its name before it, and counts what the document becomes
/// when each USE is expanded. Throws Error for a USE of nothing, of a later or of its own DEF, or
/// of a node of another kind, and where the expansion breaks `limits`. Nothing is expanded.
Extent resolve_uses(Element& root, const InlineExtents& inlines, const Limits& limits,
                    const Messages& messages);

}  // namespace nuvo::x3d
