#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "documents.h"
#include "prototypes.h"

namespace nuvo::x3d {

/// The names that nodes of one file, or of the body of one prototype's instance, can refer to.
struct Scope {
    Prototype prototype;  ///< that the body belongs to; `document` alone for a file
    std::unordered_map<std::string_view, const Element*> definitions;  ///< the latest of a DEF
    /// Of names that nodes of several kinds have, the latest of each kind before the latest.
    std::map<std::pair<std::string_view, std::string_view>, const Element*> other_kinds;
    std::unordered_map<std::string_view, const Element*> declarations;  ///< of prototypes
    std::vector<Element*> unresolved;  ///< USEs whose DEF has not come yet
};

/// Gives every USE of a document its target, expands its ProtoInstances, loads its Inlines, and
/// turns its angles into radians: one walk in document order, without recursion.
class Linker {
  public:
    Linker(Documents& documents, Document& document, MadeElements& made, Messages& messages)
        : documents_(documents), document_(document), made_(made), messages_(messages) {}

    void run();

  private:
    struct Visit {
        Element* element;
        Element* next_child;
        bool is_script;   // it or something around it is a Script, of which nothing is drawn
        bool ends_scope;  // it is a prototype's body
        bool is_expanded = false;
    };

    void enter(Element& element, bool is_script, bool begins_scope);
    void leave();
    void resolve(Element& element, bool is_script);
    void expand(Visit& instance);
    Prototype find_prototype(std::string_view name, const Element& instance);
    void declare_nested(const Element& declaration, const Element& instance, Scope& scope);
    void check_cycle(const Element& declaration, const Element& instance) const;
    void resolve_late(Scope& scope);
    void define(std::string_view name, const Element& element);
    /// The latest node of that name and of the USE's kind, else of that name; null: none so far.
    static const Element* find_definition(const Scope& scope, const Element& use);
    Scope& scope() { return scopes_.back(); }

    Documents& documents_;
    Document& document_;
    MadeElements& made_;
    Messages& messages_;
    std::vector<Visit> path_;
    std::deque<Scope> scopes_;  // the innermost last
};

}  // namespace nuvo::x3d
