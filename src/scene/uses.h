#pragma once

#include "element.h"
#include "messages.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// Points every USE at the latest DEF of its name before it, and counts what the document becomes
/// when each USE is expanded. Throws Error for a USE of nothing, of a later or of its own DEF, or
/// of a node of another kind, and where the expansion breaks `limits`. Nothing is expanded.
void resolve_uses(Element& root, const Limits& limits, const Messages& messages);

}  // namespace nuvo::x3d
