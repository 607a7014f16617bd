#include "linker.h"

#include "fields.h"
#include "units.h"

namespace nuvo::x3d {

namespace {

bool has_definition(const Element& root, std::string_view name) {
    std::vector<const Element*> pending{&root};
    while (!pending.empty()) {
        const Element& element = *pending.back();
        pending.pop_back();
        if (element.text("DEF") == name) return true;
        for (const Element& child : element.children) pending.push_back(&child);
    }
    return false;
}

}  // namespace

void Linker::run() {
    scopes_.push_back({{nullptr, nullptr, &document_}, {}, {}, {}, {}});
    enter(*document_.root, false, false);
    while (!path_.empty()) {
        Visit& top = path_.back();
        if (top.next_child != nullptr) {
            Element& child = *top.next_child;
            top.next_child = child.next;
            enter(child, top.is_script, false);
        } else if (top.element->name == "ProtoInstance" && !top.is_expanded && !top.is_script) {
            top.is_expanded = true;
            expand(top);
        } else {
            leave();
        }
    }
    resolve_late(scope());
    scopes_.pop_back();
}

void Linker::enter(Element& element, bool is_script, bool begins_scope) {
    if (element.target != nullptr || is_declaration(element)) return;
    const std::string_view use = element.text("USE");
    if (!use.empty()) return resolve(element, is_script);
    const Limits& limits = made_.limits;
    if (path_.size() >= limits.depth)
        messages_.refuse(element, "",
                         "prototypes make the scene exceed the limit of " +
                             std::to_string(limits.depth) + " nested levels");
    const std::string_view def = element.text("DEF");
    if (!def.empty()) define(def, element);
    const Document& document = *scope().prototype.document;
    if (document.units.angle != 1) convert_angles(element, document.units.angle, document_.arena);
    is_script = is_script || element.name == "Script";
    if (!is_script) documents_.note(element, document);
    path_.push_back({&element, element.children.first, is_script, begins_scope});
}

void Linker::leave() {
    if (path_.back().ends_scope) {
        resolve_late(scope());
        scopes_.pop_back();
    }
    path_.pop_back();
}

void Linker::define(std::string_view name, const Element& element) {
    const auto [entry, is_new] = scope().definitions.try_emplace(name, &element);
    if (is_new) return;
    const Element* before = std::exchange(entry->second, &element);
    if (before->name != element.name) scope().other_kinds[{name, before->name}] = before;
}

const Element* Linker::find_definition(const Scope& scope, const Element& use) {
    const std::string_view name = use.text("USE");
    const auto latest = scope.definitions.find(name);
    if (latest == scope.definitions.end()) return nullptr;
    const std::string_view kind = latest->second->name;
    if (kind == use.name || kind == "ProtoInstance") return latest->second;
    const auto other = scope.other_kinds.find({name, use.name});
    return other != scope.other_kinds.end() ? other->second : latest->second;
}

void Linker::resolve(Element& element, bool is_script) {
    const std::string_view name = element.text("USE");
    const Element* found = find_definition(scope(), element);
    const std::string shown = "USE=\"" + excerpt(name) + "\"";
    if (messages_.is_strict()) {
        if (found == nullptr)
            messages_.refuse(
                element, "",
                shown + (has_definition(*document_.root, name) ? " comes before its DEF"
                                                               : " names no DEF"));
        if (found->name != element.name)
            messages_.refuse(
                element, "",
                shown + " is a " + excerpt(found->name) + ", not a " + excerpt(element.name));
    }
    if (found == nullptr) {
        element.target = &kNothing;
        if (!is_script) scope().unresolved.push_back(&element);
        return;
    }
    element.target = found;
    if (found->name != element.name && !is_script && found->name != "ProtoInstance")
        messages_.warn(excerpt(element.name) + "@USE",
                       "naming a node of another kind, which is drawn in its place", element);
}

void Linker::resolve_late(Scope& scope) {
    for (Element* element : scope.unresolved) {
        if (const Element* found = find_definition(scope, *element); found != nullptr) {
            element->target = found;
            messages_.warn(excerpt(element->name) + "@USE", "coming before its DEF", *element);
        } else {
            messages_.warn_left_out(
                element->name,
                {element, "", "USE=\"" + excerpt(element->text("USE")) + "\" names no DEF"});
        }
    }
}

void Linker::expand(Visit& visit) {
    Element& instance = *visit.element;
    instance.target = &kNothing;  // until it is made
    const std::string_view name = instance.text("name");
    const Prototype prototype = find_prototype(name, instance);
    const std::string shown = "\"" + excerpt(name) + "\"";
    if (prototype.declaration == nullptr)
        return messages_.warn_left_out(
            instance.name, {&instance, "", "no prototype of the name " + shown + " can be read"});
    check_cycle(*prototype.declaration, instance);
    Element* made = instantiate(*prototype.declaration, instance, made_, document_.arena);
    if (made == nullptr)
        return messages_.warn_left_out(instance.name,
                                       {&instance, "", "the prototype " + shown + " has no node"});
    // Below the instance it has a place in messages.
    Element** end = &instance.children.first;
    while (*end != nullptr) end = &(*end)->next;
    *end = made;
    instance.target = made;
    Scope& inner = scopes_.emplace_back(Scope{prototype, {}, {}, {}, {}});
    declare_nested(*prototype.declaration, instance, inner);
    enter(*made, false, true);
}

void Linker::declare_nested(const Element& declaration, const Element& instance, Scope& scope) {
    for (const Element& node : body_of(declaration)->children) {
        made_.take(1, 0, instance);
        if (is_declaration(node)) scope.declarations[node.text("name")] = &node;
    }
}

void Linker::check_cycle(const Element& declaration, const Element& instance) const {
    for (const Scope& open : scopes_)
        if (open.prototype.declaration == &declaration)
            messages_.refuse(instance, "",
                             "the prototype \"" + excerpt(instance.text("name")) +
                                 "\" is inside its own declaration");
}

Prototype Linker::find_prototype(std::string_view name, const Element& instance) {
    for (const Scope* scope = &scopes_.back(); scope != nullptr; scope = scope->prototype.around) {
        made_.take(1, 0, instance);
        const auto found = scope->declarations.find(name);
        const Document& document = *scope->prototype.document;
        if (found != scope->declarations.end())
            return documents_.declared({found->second, scope, &document});
        if (scope->prototype.around == nullptr) {
            const auto at_top = document.declarations.find(name);
            if (at_top == document.declarations.end()) return {};
            return documents_.declared({at_top->second, nullptr, &document});
        }
    }
    return {};
}

}  // namespace nuvo::x3d
