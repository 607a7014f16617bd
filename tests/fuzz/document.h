#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nuvo/scene/camera.h"
#include "nuvo/scene/scene.h"

/// X3D documents as trees that can be grown and cut.
namespace nuvo::fuzz {

struct Attribute {
    std::string name;
    std::string value;
};

struct Element {
    std::string name;
    std::vector<Attribute> attributes;
    /// Of an Inline: what stands in the Scene of the file that it names.
    std::vector<Element> children;

    Element& set(std::string attribute, std::string value) {
        attributes.push_back({std::move(attribute), std::move(value)});
        return *this;
    }
    Element& add(Element child) {
        children.push_back(std::move(child));
        return *this;
    }
};

/// A scene and how it is looked at and asked.
struct Document {
    Element root;
    Resolution resolution{16, 9};
    /// Six numbers a ray, as in a file for --rays.
    std::vector<std::string> rays;
    bool fast = true;  ///< false: the fast tracer is left out
};

/// True where the document has an Inline, whose file must stand beside it.
bool has_inlines(const Element& element);
/// The number of elements.
std::size_t count_elements(const Element& element);

/// The text of the file; resolution and rays stand in a comment before the root. Files of Inlines
/// are named STEM-1.x3d, STEM-2.x3d, ... in document order.
std::string text_of(const Document& document, const std::string& stem);
/// Writes it, and the files of its Inlines beside it.
void write(const Document& document, const std::filesystem::path& path);
/// Reads it by way of the loader; `folder` is for the files of Inlines. Throws x3d::Error.
Scene load(const Document& document, const std::filesystem::path& folder);

/// Resolution and rays of a file that write() wrote; the scene itself is read by the loader.
Document settings_of(const std::string& text);

}  // namespace nuvo::fuzz
