#pragma once

#include <string_view>

#include "messages.h"

namespace nuvo::x3d {

/// True for what is no drawable content and so needs no word when it is passed over: metadata,
/// declarations, texture coordinates.
bool is_silent(std::string_view name);

/// Warns that a node is not drawn; a name that only differs from a node's in case gets the right
/// spelling.
void warn_not_drawn(const Element& element, Messages& messages);

}  // namespace nuvo::x3d
