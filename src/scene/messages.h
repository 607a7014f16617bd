#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "element.h"
#include "nuvo/math/one_line.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// A node that cannot be drawn as the file says: thrown where that is found, caught where it can be
/// left out.
struct LeftOut {
    const Element* element;
    std::string attribute;  ///< empty: the element itself
    std::string reason;
};

/// Where the reading of a scene says what is wrong: what ends it is thrown, warnings are gathered
/// by kind and counted.
class Messages {
  public:
    /// `strict`: what could be left out ends the reading, too.
    explicit Messages(bool strict) : strict_(strict) {}

    bool is_strict() const { return strict_; }

    /// Tells where elements are looked for; the first document is the scene itself, others are what
    /// it Inlines. `root` must outlive this.
    void add_document(const std::string& file, const Element& root) {
        documents_.push_back({file, &root});
    }

    /// Throws Error "FILE: PLACE@attribute: reason (line N)"; no `@` when `attribute` is empty.
    [[noreturn]] void refuse(const Element& element, std::string_view attribute,
                             const std::string& reason) const;

    /// The node, or the one it belongs to, cannot be drawn: throws LeftOut, or where strict as
    /// refuse() does.
    [[noreturn]] void leave_out(const Element& element, std::string_view attribute,
                                const std::string& reason) const;

    /// Notes that something about `element` was not taken as the file says. Warnings of one
    /// `subject` (a node's kind, or Kind@field) and one `what` become one line,
    /// "subject: COUNT what (first at PLACE, line N)"; in an Inlined file "(first in FILE at ...)".
    /// True when it is the first of its kind.
    bool warn(std::string_view subject, std::string_view what, const Element& element,
              std::size_t count = 1);

    /// Warns that a field was read as if it were not given, or where strict refuses:
    /// "Kind@field: COUNT left out (first at PLACE, line N: reason)".
    void warn_field_left_out(const Element& element, std::string_view field,
                             const std::string& reason);
    /// Warns that a node of kind `subject` was left out, or where strict refuses:
    /// "subject: COUNT left out (first at PLACE@attribute, line N: reason)".
    void warn_left_out(std::string_view subject, const LeftOut& left_out);

    /// While muted, warnings are forgotten: the scene is walked a second time.
    void set_muted(bool muted) { muted_ = muted; }

    /// One line per kind in the order of their first places; after a hundred, how many more.
    std::vector<std::string> warnings() const;

  private:
    struct Document {
        std::string file;
        const Element* root;
    };
    struct Warning {
        std::string subject;
        std::string what;
        const Element* first;
        std::string attribute;  // of the first, and why
        std::string reason;
        std::size_t count;
    };
    struct Location {
        std::size_t document;
        std::string place;
    };
    /// The warning of this kind; a new one has count 0.
    Warning& find(std::string_view subject, std::string_view what, const Element& element);
    Location locate(const Element& element, std::string_view attribute) const;
    std::string line_of(const Warning& warning) const;

    bool strict_;
    std::vector<Document> documents_;
    std::vector<Warning> warnings_;
    std::unordered_map<std::string, std::size_t> index_;  // of subject and what
    std::size_t latest_ = 0;  // the kind that was warned of last; it mostly is so again
    bool muted_ = false;
};

}  // namespace nuvo::x3d
