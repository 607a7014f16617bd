#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "element.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

/// Text of a file made fit for a message: short, and without control characters.
std::string excerpt(std::string_view text);

/// Where the reading of a scene says what is wrong: errors are thrown, warnings gathered by kind
/// and counted.
class Messages {
  public:
    /// Tells where elements are looked for; the first document is the scene itself, others are what
    /// it Inlines. `root` must outlive this.
    void add_document(const std::string& file, const Element& root) {
        documents_.push_back({file, &root});
    }

    /// Throws Error "FILE: PLACE@attribute: reason (line N)"; no `@` when `attribute` is empty.
    [[noreturn]] void fail(const Element& element, std::string_view attribute,
                           const std::string& reason) const;

    /// Notes that something about `element` was not taken as the file says. Warnings of one
    /// `subject` (a node's kind, or Kind@field) and one `what` become one line,
    /// "subject: COUNT what (first at PLACE)"; in an Inlined file "(first in FILE at PLACE)".
    /// True when it is the first of its kind.
    bool warn(std::string_view subject, std::string_view what, const Element& element);

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
        std::size_t count;
    };
    struct Location {
        std::size_t document;
        std::string place;
    };
    Location locate(const Element& element) const;

    std::vector<Document> documents_;
    std::vector<Warning> warnings_;
    std::unordered_map<std::string, std::size_t> index_;  // of subject and what
    std::size_t latest_ = 0;  // the kind that was warned of last; it mostly is so again
    bool muted_ = false;
};

}  // namespace nuvo::x3d
