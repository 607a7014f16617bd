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

class Reader {
  public:
    Reader(const std::string& file, const std::vector<std::uint32_t>& lines, Names& names)
        : file_(file), lines_(lines), names_(names) {}

    /// Appends what `root` holds to `roots`, in document order. No recursion: the document may be
    /// as deep as the limits allow.
    void read(const Outline& root, std::vector<Element>& roots) {
        struct Open {
            const std::vector<Outline>* parts;
            std::size_t next;
            std::vector<Element>* siblings;  // stays in place until all parts are read
        };
        std::vector<Open> open;
        const auto enter = [&](const Outline& part, std::vector<Element>& siblings) {
            if (!part.run.empty()) return read_run(part, siblings);
            // A large or deep element: its start tag alone, then its content part by part.
            read_tag(part, siblings);
            std::vector<Element>& children = siblings.back().children;
            children.reserve(part.children);
            open.push_back({&part.parts, 0, &children});
        };
        enter(root, roots);
        while (!open.empty()) {
            Open& top = open.back();
            if (top.next == top.parts->size())
                open.pop_back();
            else
                enter((*top.parts)[top.next++], *top.siblings);
        }
    }

  private:
    void read_run(const Outline& part, std::vector<Element>& siblings) {
        ptree tree = parse({"<run>", part.run, "</run>"}, part.line);
        append(tree.front().second, siblings);
    }

    void read_tag(const Outline& part, std::vector<Element>& siblings) {
        const std::size_t name_end = part.tag.find_first_of(" \t\r\n/>");
        const std::string end_tag = "</" + std::string(part.tag.substr(1, name_end - 1)) + ">";
        ptree tree = parse({part.tag, end_tag, ""}, part.line);
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

    /// Moves the child elements of `parent` to the end of `siblings`.
    void append(ptree& parent, std::vector<Element>& siblings) {
        if (siblings.capacity() == 0) siblings.reserve(parent.size() - parent.count("<xmlattr>"));
        for (auto& [name, tree] : parent) {
            if (name == "<xmlattr>") continue;
            Element& element = siblings.emplace_back();
            element.name = names_.keep(name);
            element.line = lines_[next_line_++];
            const auto attributes = tree.find("<xmlattr>");
            if (attributes != tree.not_found()) move_attributes(attributes->second, element);
            append(tree, element.children);
        }
    }

    void move_attributes(ptree& from, Element& element) {
        element.attributes.reserve(from.size());
        for (auto& [name, value] : from)
            element.attributes.push_back({names_.keep(name), std::move(value.data())});
    }

    const std::string& file_;
    const std::vector<std::uint32_t>& lines_;
    Names& names_;
    std::size_t next_line_ = 0;
};

}  // namespace

Element parse_xml(std::string_view text, const std::string& file, const Limits& limits,
                  Names& names) {
    const GuardedDocument document = guard_xml(text, file, limits);
    std::vector<Element> roots;
    Reader(file, document.lines, names).read(document.root, roots);
    return std::move(roots.front());
}

}  // namespace nuvo::x3d
