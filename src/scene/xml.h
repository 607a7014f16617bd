#pragma once

#include <string>
#include <string_view>

#include "element.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// Reads an XML document into a tree of elements, whose depth is within `limits` and whose names
/// are kept in `names`. `file` stands for the document in messages. Throws Error.
Element parse_xml(std::string_view text, const std::string& file, const Limits& limits,
                  Names& names);

}  // namespace nuvo::x3d
