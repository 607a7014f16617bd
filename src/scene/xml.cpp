#include "xml.h"

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <istream>
#include <streambuf>

#include "xml_guard.h"

namespace nuvo::x3d {

namespace {

using boost::property_tree::ptree;

/// A stream over pieces of text that stand elsewhere, one after the other, without a copy.
class Pieces : public std::streambuf {
  public:
    explicit Pieces(std::array<std::string_view, 3> pieces) : pieces_(pieces) {}

  protected:
    int_type underflow() override {
        while (next_ < pieces_.size()) {
            const std::string_view piece = pieces_[next_++];
            if (piece.empty()) continue;
            char* begin = const_cast<char*>(piece.data());  // never written to
            setg(begin, begin, begin + piece.size());
            return traits_type::to_int_type(piece.front());
        }
        return traits_type::eof();
    }

  private:
    std::array<std::string_view, 3> pieces_;
    std::size_t next_ = 0;
};

/// The children of one element while they are appended.
struct Siblings {
    Element* parent;
    Element* last = nullptr;
};

class Reader {
  public:
    Reader(const std::string& file, const std::vector<std::uint32_t>& lines, Names& names,
           ElementArena& arena, Progress* progress)
        : file_(file), lines_(lines), names_(names), arena_(arena), progress_(progress) {}

    /// Appends what `root` holds to the children of `parent`. No recursion: the document may be as
    /// deep as the limits allow.
    void read(const Outline& root, Element& parent) {
        struct Open {
            const std::vector<Outline>* parts;
            std::size_t next;
            Siblings siblings;
        };
        const std::vector<Outline>* no_parts = nullptr;
        std::vector<Open> open{{no_parts, 0, {&parent}}};
        const auto enter = [&](const Outline& part) {
            Siblings& siblings = open.back().siblings;
            if (!part.run.empty()) return read_run(part, siblings);
            // A large or deep element: its start tag alone, then its content part by part.
            read_tag(part, siblings);
            open.push_back({&part.parts, 0, {siblings.last}});
        };
        enter(root);
        while (open.size() > 1) {
            Open& top = open.back();
            if (top.next == top.parts->size())
                open.pop_back();
            else
                enter((*top.parts)[top.next++]);
        }
    }

  private:
    void read_run(const Outline& part, Siblings& siblings) {
        const ptree tree = parse({"<run>", part.run, "</run>"}, part.line);
        append(tree.front().second, siblings);
        add(progress_, part.run.size());
    }

    void read_tag(const Outline& part, Siblings& siblings) {
        const std::size_t name_end = part.tag.find_first_of(" \t\r\n/>");
        const std::string end_tag = "</" + std::string(part.tag.substr(1, name_end - 1)) + ">";
        const ptree tree = parse({part.tag, end_tag, ""}, part.line);
        append(tree, siblings);
    }

    ptree parse(const std::array<std::string_view, 3>& text, std::uint32_t line) const {
        Pieces pieces(text);
        std::istream stream(&pieces);
        ptree tree;
        try {
            boost::property_tree::read_xml(stream, tree,
                                           boost::property_tree::xml_parser::no_comments);
        } catch (const boost::property_tree::xml_parser_error& error) {
            throw Error(file_ + ": line " + std::to_string(line + error.line() - 1) +
                        ": not XML: " + error.message());
        }
        return tree;
    }

    /// Copies the child elements of `tree` to the end of `siblings`.
    void append(const ptree& tree, Siblings& siblings) {
        for (const auto& [name, child] : tree) {
            if (name == "<xmlattr>") continue;
            Element& element = *arena_.make_element();
            Element*& place =
                siblings.last != nullptr ? siblings.last->next : siblings.parent->children.first;
            place = siblings.last = &element;
            names_.name_element(name, element);
            element.line = lines_[next_line_++];
            // Attributes, if any, come first.
            if (!child.empty() && child.front().first == "<xmlattr>")
                copy_attributes(child.front().second, element);
            Siblings children{&element};
            append(child, children);
        }
    }

    void copy_attributes(const ptree& from, Element& element) {
        const std::span<Attribute> attributes = arena_.make_attributes(from.size());
        std::size_t i = 0;
        for (const auto& [name, value] : from)
            attributes[i++] = {names_.attribute_name(name, element), arena_.copy(value.data())};
        element.attributes = attributes;
    }

    const std::string& file_;
    const std::vector<std::uint32_t>& lines_;
    Names& names_;
    ElementArena& arena_;
    Progress* progress_;
    std::size_t next_line_ = 0;
};

}  // namespace

Element& parse_xml(std::string_view text, const std::string& file, const Limits& limits,
                   Names& names, ElementArena& arena, Progress* progress) {
    const GuardedDocument document = guard_xml(text, file, limits);
    begin(progress, "bytes", text.size());
    Element above;
    Reader(file, document.lines, names, arena, progress).read(document.root, above);
    return *above.children.first;
}

}  // namespace nuvo::x3d
