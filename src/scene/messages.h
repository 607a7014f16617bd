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

/// Where the reading of one document says what is wrong: errors are thrown, warnings gathered by
/// kind and counted.
class Messages {
  public:
    /// `root` must outlive this.
    Messages(std::string file, const Element& root) : file_(std::move(file)), root_(root) {}

    /// Throws Error "FILE: PLACE@attribute: reason (line N)"; no `@` when `attribute` is empty.
    [[noreturn]] void fail(const Element& element, std::string_view attribute,
                           const std::string& reason) const;

    /// Notes that something about `element` was not taken as the file says. Warnings of one
    /// `subject` (a node's kind, or Kind@field) and one `what` become one line,
    /// "subject: COUNT what (first at PLACE)".
    void warn(const std::string& subject, const std::string& what, const Element& element);

    /// One line per kind in the order of their first places; after a hundred, how many more.
    std::vector<std::string> warnings() const;

  private:
    struct Warning {
        std::string subject;
        std::string what;
        const Element* first;
        std::size_t count;
    };

    std::string file_;
    const Element& root_;
    std::vector<Warning> warnings_;
    std::unordered_map<std::string, std::size_t> index_;  // of subject and what
};

}  // namespace nuvo::x3d
