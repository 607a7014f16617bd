#include "nuvo/scene/x3d.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scene_reader.h"
#include "uses.h"
#include "xml.h"

namespace nuvo::x3d {

namespace {

/// "3.0" and the like; anything else counts as no version, with a warning.
Version read_version(const Element& root, Messages& messages) {
    const std::string* text = root.find("version");
    if (text == nullptr) return {};
    const char* end = text->data() + text->size();
    Version version;
    const auto major = std::from_chars(text->data(), end, version.major);
    if (major.ec == std::errc{} && major.ptr != end && *major.ptr == '.') {
        const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
        if (minor.ec == std::errc{} && minor.ptr == end) return version;
    }
    messages.warn("X3D@version", "not understood and left out", root);
    return {};
}

/// The Scene of the thesis' bare form (the root itself) or of an X3D root.
const Element& find_scene(const Element& root, const Messages& messages) {
    if (root.name == "Scene") return root;
    if (root.name != "X3D") messages.fail(root, "", "the root element is neither X3D nor Scene");
    const Element* scene = nullptr;
    for (const Element& child : root.children) {
        if (child.name != "Scene") continue;
        if (scene != nullptr) messages.fail(child, "", "a second Scene");
        scene = &child;
    }
    if (scene == nullptr) messages.fail(root, "", "has no Scene");
    return *scene;
}

Scene read_document(Element root, const std::string& name, Headlight headlight,
                    const Limits& limits) {
    Messages messages(name, root);
    const Element& scene = find_scene(root, messages);
    const Version version = root.name == "X3D" ? read_version(root, messages) : Version{};
    resolve_uses(root, limits, messages);
    return SceneReader(version, limits, messages).read(scene, headlight);
}

[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& reason) {
    throw Error(path.string() + ": " + reason);
}

std::string read_bytes(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail_to_read(path, "is a folder, not a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        fail_to_read(path, std::string("cannot be opened: ") +
                               (errno != 0 ? std::strerror(errno) : "unknown reason"));
    std::string text;
    const std::uintmax_t size = std::filesystem::file_size(path, ignored);
    if (!ignored) text.reserve(size);
    std::vector<char> block(1 << 20);
    while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
        text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (file.bad()) fail_to_read(path, "cannot be read");
    return text;
}

Element parse_file(const std::filesystem::path& path, const Limits& limits) {
    const std::string text = read_bytes(path);
    return parse_xml(text, path.string(), limits);
}

}  // namespace

Scene read_file(const std::filesystem::path& path, Headlight headlight, const Limits& limits) {
    // The bytes are gone before the scene is built.
    return read_document(parse_file(path, limits), path.string(), headlight, limits);
}

Scene read_text(const std::string& text, const std::string& name, Headlight headlight,
                const Limits& limits) {
    return read_document(parse_xml(text, name, limits), name, headlight, limits);
}

}  // namespace nuvo::x3d
