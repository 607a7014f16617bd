#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// How a document is handed to the XML parser: in runs of whole sibling elements of moderate size
/// and depth, so that the parser's tree never holds a large file and its recursion stays shallow.
struct Outline {
    std::string_view run;        ///< whole elements; empty when this is one large or deep element
    std::string_view tag;        ///< that element's start tag, `<` to `>`
    std::uint32_t line = 1;      ///< where `run` or `tag` begins
    std::size_t children = 0;    ///< of that element
    std::vector<Outline> parts;  ///< what stands inside that element, in order
};

/// A value of many bytes that stands in the document as it is meant: no parser need see it.
struct LongValue {
    std::size_t attribute;  ///< whose it is: their number in document order, from 0
    std::string_view text;
};

struct GuardedDocument {
    Outline root;
    std::vector<std::uint32_t> lines;    ///< of every start tag, in document order
    std::vector<LongValue> long_values;  ///< in document order
};

/// One pass over the bytes that refuses what the parser would accept without a word (mismatched or
/// unclosed tags, duplicate attributes, two roots, an empty file) or die of (depth, size), before
/// any tree is built. Views into `text`, which must outlive the result. Throws Error.
GuardedDocument guard_xml(std::string_view text, const std::string& file, const Limits& limits);

}  // namespace nuvo::x3d
