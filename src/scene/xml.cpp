#include "xml.h"

#include <array>
#include <boost/property_tree/xml_parser.hpp>
#include <istream>
#include <span>
#include <streambuf>

#include "xml_guard.h"
#include "xml_tree.h"

namespace nuvo::x3d {

namespace {

using boost::property_tree::xml_parser_error;

/// A stream over pieces of text that stand elsewhere, one after the other, without a copy.
class Pieces : public std::streambuf {
  public:
    explicit Pieces(std::span<const std::string_view> pieces) : pieces_(pieces) {}

  protected:
    int_type underflow() override {
        while (!pieces_.empty()) {
            const std::string_view piece = pieces_.front();
            pieces_ = pieces_.subspan(1);
            if (piece.empty()) continue;
            char* begin = const_cast<char*>(piece.data());  // never written to
            setg(begin, begin, begin + piece.size());
            return traits_type::to_int_type(piece.front());
        }
        return traits_type::eof();
    }

  private:
    std::span<const std::string_view> pieces_;
};

/// The children of one element while they are appended.
struct Siblings {
    Element* parent;
    Element* last = nullptr;
};

class Reader {
  public:
    Reader(const std::string& file, const GuardedDocument& document, Names& names,
           ElementArena& arena, Progress* progress)
        : file_(file), document_(document), names_(names), arena_(arena), progress_(progress) {}

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
        parse({"<run>", part.run, "</run>"}, part.line,
              [&](const XmlTree& tree) { append(*tree.first_child(), siblings); });
        add(progress_, part.run.size());
    }

    void read_tag(const Outline& part, Siblings& siblings) {
        const std::size_t name_end = part.tag.find_first_of(" \t\r\n/>");
        const std::string end_tag = "</" + std::string(part.tag.substr(1, name_end - 1)) + ">";
        parse({"", part.tag, end_tag}, part.line,
              [&](const XmlTree& tree) { append(tree, siblings); });
    }

    /// A part of the document between what makes it well-formed.
    struct Framed {
        std::string_view before, text, after;
    };

    /// Parses the text without its long values.
    void parse(const Framed& framed, std::uint32_t line, const XmlTree::Reader& read) {
        std::vector<std::string_view> pieces{framed.before};
        std::string_view rest = framed.text;
        for (; next_cut_ < document_.long_values.size(); ++next_cut_) {
            const std::string_view value = document_.long_values[next_cut_].text;
            if (value.data() >= rest.data() + rest.size()) break;
            const auto length = static_cast<std::size_t>(value.data() - rest.data());
            pieces.push_back(rest.substr(0, length));
            rest.remove_prefix(length + value.size());
        }
        pieces.insert(pieces.end(), {rest, framed.after});
        try {
            parse(pieces, read);
        } catch (const xml_parser_error&) {
            refuse(framed, line);
        }
    }

    static void parse(std::span<const std::string_view> text, const XmlTree::Reader& read) {
        Pieces pieces(text);
        std::istream stream(&pieces);
        XmlTree tree(read);
        boost::property_tree::read_xml(stream, tree, boost::property_tree::xml_parser::no_comments);
    }

    /// Parses the text with its long values, as their lines count, to tell what is wrong with it.
    [[noreturn]] void refuse(const Framed& framed, std::uint32_t line) const {
        try {
            parse(std::array{framed.before, framed.text, framed.after}, [](const XmlTree&) {});
        } catch (const xml_parser_error& error) {
            throw Error(file_ + ": line " + std::to_string(line + error.line() - 1) +
                        ": not XML: " + error.message());
        }
        throw Error(file_ + ": line " + std::to_string(line) + ": not XML");
    }

    /// Copies the child elements of `tree` to the end of `siblings`.
    void append(const XmlTree& tree, Siblings& siblings) {
        for (const XmlTree* child = tree.first_child(); child != nullptr; child = child->next()) {
            Element& element = *arena_.make_element();
            Element*& place =
                siblings.last != nullptr ? siblings.last->next : siblings.parent->children.first;
            place = siblings.last = &element;
            names_.name_element(child->name(), element);
            element.line = document_.lines[next_line_++];
            copy_attributes(*child, element);
            Siblings children{&element};
            append(*child, children);
        }
    }

    void copy_attributes(const XmlTree& from, Element& element) {
        const std::span<Attribute> attributes = arena_.make_attributes(from.attribute_count());
        const XmlTree* next = from.first_attribute();
        for (Attribute& attribute : attributes) {
            attribute = {names_.attribute_name(next->name(), element), value_of(*next)};
            next = next->next();
        }
        element.attributes = attributes;
    }

    /// The value of the document's next attribute.
    std::string_view value_of(const XmlTree& attribute) {
        const std::size_t number = next_attribute_++;
        const std::vector<LongValue>& values = document_.long_values;
        if (next_value_ < values.size() && values[next_value_].attribute == number)
            return values[next_value_++].text;
        return arena_.copy(attribute.value());
    }

    const std::string& file_;
    const GuardedDocument& document_;
    Names& names_;
    ElementArena& arena_;
    Progress* progress_;
    std::size_t next_line_ = 0;
    std::size_t next_attribute_ = 0;
    std::size_t next_cut_ = 0;    // among the long values, to be kept from the parser
    std::size_t next_value_ = 0;  // and to be given its attribute
};

}  // namespace

ParsedXml parse_xml(std::string_view text, const std::string& file, const Limits& limits,
                    Names& names, ElementArena& arena, Progress* progress) {
    const GuardedDocument document = guard_xml(text, file, limits);
    begin(progress, "bytes", text.size());
    Element above;
    Reader(file, document, names, arena, progress).read(document.root, above);
    return {above.children.first, !document.long_values.empty()};
}

}  // namespace nuvo::x3d
