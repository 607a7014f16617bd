#include "xml_guard.h"

#include <algorithm>

#include "messages.h"

namespace nuvo::x3d {

namespace {

/// Siblings are gathered into runs of up to this many bytes; the parser needs up to 100 times that.
constexpr std::size_t kRunBytes = 32 * 1024;

/// From so many bytes on it pays to keep a value from the parser, which copies it twice.
constexpr std::size_t kLongValue = 1024;

/// A run nests up to this many levels: the parser recurses, and it is not ours to give it the
/// stack.
constexpr std::size_t kRunLevels = 128;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool starts_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
           static_cast<unsigned char>(c) >= 0x80;
}

bool continues_name(char c) {
    return starts_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

struct OpenElement {
    std::string_view name;
    std::size_t begin;
    std::size_t tag_end;
    std::uint32_t line;
    std::vector<Outline> parts;
    std::size_t levels = 1;  // its own and those inside it
    std::size_t children = 0;
};

class Guard {
  public:
    Guard(std::string_view text, const std::string& file, const Limits& limits)
        : text_(text), file_(file), limits_(limits) {}

    GuardedDocument run() {
        check_encoding();
        while (position_ < text_.size()) {
            if (text_[position_] == '<')
                markup();
            else
                character_data();
        }
        if (!open_.empty())
            fail(open_.back().line, "<" + excerpt(open_.back().name) + "> is never closed");
        if (top_.empty()) throw Error(file_ + ": empty file: no root element");
        return {std::move(top_.front()), std::move(lines_), std::move(long_values_)};
    }

  private:
    [[noreturn]] void fail(std::uint32_t line, const std::string& reason) const {
        throw Error(file_ + ": line " + std::to_string(line) + ": " + reason);
    }
    [[noreturn]] void fail(const std::string& reason) const { fail(line_, reason); }

    std::string_view rest() const { return text_.substr(position_); }

    void advance_to(std::size_t position) {
        const auto begin = text_.begin();
        line_ += static_cast<std::uint32_t>(
            std::count(begin + static_cast<std::ptrdiff_t>(position_),
                       begin + static_cast<std::ptrdiff_t>(position), '\n'));
        position_ = position;
    }

    /// Moves behind the next `end`, which closes `what`.
    void skip_past(std::string_view end, const char* what) {
        const std::size_t found = text_.find(end, position_);
        if (found == std::string_view::npos) fail(std::string(what) + " without an end");
        advance_to(found + end.size());
    }

    void skip_blanks() {
        std::size_t p = position_;
        while (p < text_.size() && is_blank(text_[p])) ++p;
        advance_to(p);
    }

    void check_encoding() {
        if (rest().starts_with("\xfe\xff") || rest().starts_with("\xff\xfe"))
            throw Error(file_ + ": UTF-16 text is not read: save it as UTF-8");
        if (rest().starts_with("\xef\xbb\xbf")) position_ += 3;
        const std::size_t nul = text_.find('\0');
        if (nul != std::string_view::npos) {
            advance_to(nul);
            fail("not XML: a byte of value zero");
        }
    }

    void character_data() {
        const std::size_t end = std::min(text_.find('<', position_), text_.size());
        if (open_.empty()) {
            skip_blanks();
            if (position_ < end)
                fail(top_.empty() ? "not XML: text before the root element"
                                  : "text after the root element");
        }
        advance_to(end);
    }

    void markup() {
        if (rest().starts_with("<!--"))
            skip_past("-->", "comment");
        else if (rest().starts_with("<?"))
            skip_past("?>", "processing instruction");
        else if (rest().starts_with("<![CDATA[") && !open_.empty())
            skip_past("]]>", "CDATA section");
        else if (rest().starts_with("<!DOCTYPE") && open_.empty() && top_.empty())
            document_type();
        else if (rest().starts_with("</"))
            end_tag();
        else
            start_tag();
    }

    /// Skips a document type with its internal subset; nothing in it is opened or expanded.
    void document_type() {
        const std::uint32_t line = line_;
        bool in_subset = false;
        while (position_ < text_.size()) {
            const char c = text_[position_];
            if (c == '"' || c == '\'') {
                advance_to(position_ + 1);
                skip_past(std::string_view(&c, 1), "DOCTYPE literal");
                continue;
            }
            if (rest().starts_with("<!--")) {
                skip_past("-->", "comment");
                continue;
            }
            if (c == '[') in_subset = true;
            if (c == ']') in_subset = false;
            advance_to(position_ + 1);
            if (c == '>' && !in_subset) return;
        }
        fail(line, "DOCTYPE without an end");
    }

    std::string_view name(const char* what) {
        std::size_t p = position_;
        if (p >= text_.size() || !starts_name(text_[p]))
            fail(std::string("not XML: ") + what + " expected");
        while (p < text_.size() && continues_name(text_[p])) ++p;
        const std::string_view found = text_.substr(position_, p - position_);
        position_ = p;
        return found;
    }

    void start_tag() {
        const std::size_t begin = position_;
        const std::uint32_t line = line_;
        ++position_;
        const std::string_view element = name("an element's name");
        if (open_.empty() && !top_.empty())
            fail(line, "a second root element <" + excerpt(element) + ">");
        if (open_.size() >= limits_.depth)
            fail(line, "elements nested too deeply (limit " + std::to_string(limits_.depth) + ")");
        if (lines_.size() >= limits_.elements)
            fail(line, "too many elements (limit " + std::to_string(limits_.elements) + ")");
        lines_.push_back(line);
        const bool closed = attributes(element, line);
        open_.push_back({element, begin, position_, line, {}, 1, 0});
        if (closed) close();
    }

    /// Reads up to and including `>`; true where the tag closes itself.
    bool attributes(std::string_view element, std::uint32_t line) {
        names_.clear();
        for (;;) {
            const std::size_t before = position_;
            skip_blanks();
            if (position_ >= text_.size())
                fail(line, "the tag <" + excerpt(element) + " has no end");
            if (text_[position_] == '>' || rest().starts_with("/>")) break;
            if (before == position_)
                fail("not XML: a blank expected in the tag <" + excerpt(element));
            if (++attributes_ > limits_.attributes)
                fail("too many attributes (limit " + std::to_string(limits_.attributes) + ")");
            names_.push_back(name("an attribute's name"));
            attribute_value(names_.back());
        }
        std::sort(names_.begin(), names_.end());
        const auto twice = std::adjacent_find(names_.begin(), names_.end());
        if (twice != names_.end())
            fail(line,
                 "<" + excerpt(element) + "> has the attribute " + excerpt(*twice) + " twice");
        const bool closed = text_[position_] == '/';
        position_ += closed ? 2 : 1;
        return closed;
    }

    void attribute_value(std::string_view attribute) {
        skip_blanks();
        if (!rest().starts_with("=")) fail("the attribute " + excerpt(attribute) + " has no value");
        ++position_;
        skip_blanks();
        const char quote = position_ < text_.size() ? text_[position_] : '\0';
        if (quote != '"' && quote != '\'')
            fail("the value of the attribute " + excerpt(attribute) + " is not in quotes");
        const std::size_t end = text_.find(quote, position_ + 1);
        const std::string_view value = text_.substr(position_ + 1, end - position_ - 1);
        if (end == std::string_view::npos || value.find('<') != std::string_view::npos)
            fail("the value of the attribute " + excerpt(attribute) + " has no closing quote");
        if (value.size() >= kLongValue && value.find('&') == std::string_view::npos)
            long_values_.push_back({attributes_ - 1, value});
        advance_to(end + 1);
    }

    void end_tag() {
        position_ += 2;
        const std::string_view element = name("an element's name");
        skip_blanks();
        if (!rest().starts_with(">")) fail("the tag </" + excerpt(element) + " has no end");
        ++position_;
        if (open_.empty()) fail("</" + excerpt(element) + "> closes nothing");
        if (open_.back().name != element)
            fail("</" + excerpt(element) + "> closes <" + excerpt(open_.back().name) +
                 "> of line " + std::to_string(open_.back().line));
        close();
    }

    void close() {
        OpenElement element = std::move(open_.back());
        open_.pop_back();
        std::vector<Outline>& siblings = open_.empty() ? top_ : open_.back().parts;
        if (!open_.empty()) {
            open_.back().levels = std::max(open_.back().levels, element.levels + 1);
            ++open_.back().children;
        }
        const std::string_view whole = text_.substr(element.begin, position_ - element.begin);
        if ((whole.size() > kRunBytes || element.levels > kRunLevels) && !element.parts.empty()) {
            const std::string_view tag =
                text_.substr(element.begin, element.tag_end - element.begin);
            siblings.push_back({{}, tag, element.line, element.children, std::move(element.parts)});
            return;
        }
        if (!siblings.empty() && !siblings.back().run.empty()) {
            // Lengthen the run before: its bytes and ours stand side by side.
            std::string_view& run = siblings.back().run;
            const auto run_begin = static_cast<std::size_t>(run.data() - text_.data());
            if (position_ - run_begin <= kRunBytes) {
                run = text_.substr(run_begin, position_ - run_begin);
                return;
            }
        }
        siblings.push_back({whole, {}, element.line, 0, {}});
    }

    std::string_view text_;
    const std::string& file_;
    const Limits& limits_;
    std::size_t position_ = 0;
    std::uint32_t line_ = 1;
    std::vector<OpenElement> open_;
    std::vector<Outline> top_;
    std::vector<std::uint32_t> lines_;
    std::vector<LongValue> long_values_;
    std::size_t attributes_ = 0;
    std::vector<std::string_view> names_;  // of one element's attributes
};

}  // namespace

GuardedDocument guard_xml(std::string_view text, const std::string& file, const Limits& limits) {
    return Guard(text, file, limits).run();
}

}  // namespace nuvo::x3d
