#pragma once

#include <cstddef>
#include <string_view>
#include <unordered_map>

#include "element.h"
#include "messages.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

struct Document;
struct Scope;

/// A prototype: where it is declared, and the names that its body sees besides its own.
struct Prototype {
    const Element* declaration = nullptr;  ///< a ProtoDeclare; null: none
    const Scope* around = nullptr;         ///< the body it is declared in; null: no body
    const Document* document = nullptr;    ///< the file it is declared in
};

/// The ProtoBody of a ProtoDeclare; null where it has none.
const Element* body_of(const Element& declaration);

/// Counts what prototypes make against the limits, before it is made.
struct MadeElements {
    const Limits& limits;
    Messages& messages;
    std::size_t elements = 0;  ///< of the files so far, and what has been made beside them
    std::size_t attributes = 0;
    std::size_t suggestions = 0;  ///< fields looked for by similar names, which takes time

    /// True where one more may be looked for.
    bool may_suggest() { return suggestions++ < 1000; }
    /// Throws Error at `instance` where a limit is reached.
    void take(std::size_t more_elements, std::size_t more_attributes, const Element& instance);
};

/// Warns of the `connect` statements in a declaration that name a field which their node nearly
/// has.
void check_connections(const Element& declaration, MadeElements& made);

/// A copy of the first node of the prototype's body with its IS connections replaced by the values
/// of the instance's fields or else the declaration's defaults; null where the body has no node.
/// Warns of fields that the prototype does not have.
Element* instantiate(const Element& declaration, const Element& instance, MadeElements& made,
                     ElementArena& arena);

}  // namespace nuvo::x3d
