#pragma once

#include <string>
#include <string_view>

#include "element.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// Reads an XML document into a tree of elements, whose depth is within `limits`. `file` stands for
/// the document in messages. Throws Error.
Element parse_xml(std::string_view text, const std::string& file, const Limits& limits);

}  // namespace nuvo::x3d
