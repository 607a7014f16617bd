#include "document.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "nuvo/scene/x3d.h"

namespace nuvo::fuzz {
namespace {

constexpr const char* kResolution = "resolution ";
constexpr const char* kRay = "ray ";

// Writes elements; those of Inlines into files of their own.
class Writer {
  public:
    explicit Writer(std::string stem) : stem_(std::move(stem)) {}

    void element(const Element& element, int depth, std::string& out) {
        const std::string indent(static_cast<std::size_t>(depth), ' ');
        out += indent + "<" + element.name;
        for (const Attribute& a : element.attributes) out += " " + a.name + "='" + a.value + "'";
        if (element.name == "Inline") {
            const std::string name = stem_ + "-" + std::to_string(files.size() + 1) + ".x3d";
            out += " url='\"" + name + "\"'/>\n";
            files.emplace_back(name, "");
            const std::size_t place = files.size() - 1;
            std::string inner = "<X3D version='3.3'><Scene>\n";
            for (const Element& child : element.children) this->element(child, 1, inner);
            files[place].second = inner + "</Scene></X3D>\n";
        } else if (element.children.empty()) {
            out += "/>\n";
        } else {
            out += ">\n";
            for (const Element& child : element.children) this->element(child, depth + 1, out);
            out += indent + "</" + element.name + ">\n";
        }
    }

    std::vector<std::pair<std::string, std::string>> files;

  private:
    std::string stem_;
};

void put(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string main_text(const Document& document, Writer& writer) {
    std::ostringstream head;
    head << "<!--\n"
         << kResolution << document.resolution.width << " " << document.resolution.height << "\n";
    for (const std::string& ray : document.rays) head << kRay << ray << "\n";
    head << "-->\n";
    std::string text = head.str();
    writer.element(document.root, 0, text);
    return text;
}

}  // namespace

bool has_inlines(const Element& element) {
    return element.name == "Inline" || std::any_of(element.children.begin(), element.children.end(),
                                                   [](const Element& e) { return has_inlines(e); });
}

std::size_t count_elements(const Element& element) {
    std::size_t count = 1;
    for (const Element& child : element.children) count += count_elements(child);
    return count;
}

std::string text_of(const Document& document, const std::string& stem) {
    Writer writer(stem);
    return main_text(document, writer);
}

void write(const Document& document, const std::filesystem::path& path) {
    Writer writer(path.stem().string());
    put(path, main_text(document, writer));
    for (const auto& [name, text] : writer.files) put(path.parent_path() / name, text);
}

Scene load(const Document& document, const std::filesystem::path& folder) {
    if (!has_inlines(document.root)) return x3d::read_text(text_of(document, "fuzz"), "fuzz");
    const std::filesystem::path path = folder / "fuzz.x3d";
    write(document, path);
    return x3d::read_file(path);
}

Document settings_of(const std::string& text) {
    Document document;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && line != "-->";) {
        if (line.rfind(kResolution, 0) == 0) {
            std::istringstream size(line.substr(std::string(kResolution).size()));
            size >> document.resolution.width >> document.resolution.height;
        } else if (line.rfind(kRay, 0) == 0) {
            document.rays.push_back(line.substr(std::string(kRay).size()));
        }
    }
    return document;
}

}  // namespace nuvo::fuzz
