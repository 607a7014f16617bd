#pragma once

#include <functional>

#include "document.h"

namespace nuvo::fuzz {

/// True where the document still shows the finding.
using Shows = std::function<bool(const Document&)>;

/// A document that shows the finding and of which no element, attribute or number can be taken
/// away or made simpler: or as far as `trials` calls of `shows` lead.
Document minimized(Document document, const Shows& shows, int trials);

}  // namespace nuvo::fuzz
