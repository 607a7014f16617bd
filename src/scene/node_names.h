#pragma once

#include <string_view>

#include "messages.h"

namespace nuvo::x3d {

/// True for what is no drawable content and so needs no word when it is passed over: metadata,
/// declarations, texture coordinates.
bool is_silent(std::string_view name);

/// Warns that a node is not drawn, unless its name is misspelt.
void warn_not_drawn(const Element& element, Messages& messages);

/// Throws Error with the right spelling where a name differs from a node's in case only.
void refuse_misspelt(const Element& element, const Messages& messages);

}  // namespace nuvo::x3d
