#pragma once

#include <string>
#include <string_view>

#include "element.h"
#include "names.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

struct ParsedXml {
    Element* root;
    bool views_text;  ///< long values of attributes stand in the text, which must live as long
};

/// Reads an XML document into a tree of elements, whose depth is within `limits`, who live in
/// `arena` and whose names are kept in `names`. `file` stands for the document in messages. Throws
/// Error.
ParsedXml parse_xml(std::string_view text, const std::string& file, const Limits& limits,
                    Names& names, ElementArena& arena, Progress* progress);

}  // namespace nuvo::x3d
