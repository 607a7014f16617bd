#include "documents.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>

#include "fields.h"
#include "gunzip.h"
#include "node_names.h"
#include "xml.h"

namespace nuvo::x3d {

namespace {

namespace fs = std::filesystem;

/// A packed file may unpack to so many bytes, or to so many times its own size if that is more:
/// real scenes shrink to a tenth, bombs to a thousandth.
constexpr std::size_t kUnpackedBytes = 128'000'000;
constexpr std::size_t kUnpackedRatio = 16;

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
const Element& find_scene(const Element& root, Messages& messages) {
    if (root.name == "Scene") return root;
    if (root.name != "X3D") {
        refuse_misspelt(root, messages);
        messages.fail(root, "", "the root element is neither X3D nor Scene");
    }
    const Element* scene = nullptr;
    for (const Element& child : root.children) {
        if (child.name != "Scene") {
            if (!is_silent(child.name)) warn_not_drawn(child, messages);
            continue;
        }
        if (scene != nullptr) messages.fail(child, "", "a second Scene");
        scene = &child;
    }
    if (scene == nullptr) messages.fail(root, "", "has no Scene");
    return *scene;
}

[[noreturn]] void fail_to_read(const fs::path& path, const std::string& reason) {
    throw Error(path.string() + ": " + reason);
}

/// True for a name that stays within a folder: relative, without "..", and no address of the net.
bool stays_inside(const std::string& url) {
    const fs::path path = url;
    return !url.empty() && url.find(':') == std::string::npos && !path.has_root_path() &&
           std::find(path.begin(), path.end(), "..") == path.end();
}

bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
           folder.end();
}

}  // namespace

const Document& Documents::read_file(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    const fs::path folder = path.parent_path();
    Document* document = nullptr;
    {
        const std::string text = read_bytes(path);  // gone before the scene is built
        document = &parse(text, path.string());
    }
    if (!error) {
        home_ = canonical.parent_path();
        open_.push_back(canonical.string());
        load_inlines(*document, folder);
        open_.pop_back();
    } else {
        load_inlines(*document, {});
    }
    return *document;
}

const Document& Documents::read_text(std::string_view text, const std::string& name) {
    Document& document =
        is_gzip(text) ? parse(gunzip(text, name, kUnpackedBytes), name) : parse(text, name);
    load_inlines(document, {});
    return document;
}

std::string Documents::read_bytes(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) fail_to_read(path, "is a folder, not a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        fail_to_read(path, std::string("cannot be opened: ") +
                               (errno != 0 ? std::strerror(errno) : "unknown reason"));
    const std::size_t left = limits_.file_bytes - bytes_;
    const auto check_size = [&](std::uintmax_t size) {
        if (size > left)
            fail_to_read(path, (bytes_ > 0 ? "with the files before it is" : "is") +
                                   std::string(" too large: ") + std::to_string(bytes_ + size) +
                                   " bytes (limit " + std::to_string(limits_.file_bytes) + ")");
    };
    std::string text;
    const std::uintmax_t size = fs::file_size(path, ignored);
    if (!ignored) {
        check_size(size);
        text.reserve(size);
    }
    std::vector<char> block(1 << 18);
    while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0) {
        text.append(block.data(), static_cast<std::size_t>(file.gcount()));
        check_size(text.size());
    }
    if (file.bad()) fail_to_read(path, "cannot be read");
    if (is_gzip(text)) {
        const std::size_t most = std::max(kUnpackedBytes, kUnpackedRatio * text.size());
        text = gunzip(text, path.string(), std::min(left, most));
    }
    bytes_ += text.size();
    return text;
}

Document& Documents::parse(std::string_view text, const std::string& name) {
    Document& document = documents_.emplace_back();
    document.name = name;
    document.root = parse_xml(text, name, limits_, document.names);
    messages_.add_document(name, document.root);
    document.scene = &find_scene(document.root, messages_);
    if (document.root.name == "X3D") document.version = read_version(document.root, messages_);
    return document;
}

void Documents::load_inlines(Document& document, const fs::path& folder) {
    InlineExtents extents;
    std::vector<const Element*> pending{&document.root};
    while (!pending.empty()) {
        const Element& element = *pending.back();
        pending.pop_back();
        if (element.name == "LOD") has_levels_ = true;
        if (element.name == "Inline" && element.find("USE") == nullptr) {
            const Document* loaded = load_inline(element, folder);
            if (loaded != nullptr) {
                inlined_[&element] = loaded;
                extents[&element] = loaded->extent;
            }
        }
        // From the first to the last, so that the warnings keep the document's order.
        for (auto child = element.children.rbegin(); child != element.children.rend(); ++child)
            if (!is_declaration(*child)) pending.push_back(&*child);
    }
    document.extent = resolve_uses(document.root, extents, limits_, messages_);
}

const Document* Documents::load_inline(const Element& node, const fs::path& folder) {
    const Fields fields(node, messages_);
    if (!fields.boolean("load", true)) return nullptr;
    std::string reason = "without a url left out";
    for (const std::string& url : fields.strings("url")) {
        const std::optional<fs::path> path = find_inline(url, folder, reason);
        if (!path) continue;
        const std::string canonical = fs::canonical(*path).string();
        if (std::find(open_.begin(), open_.end(), canonical) != open_.end())
            fields.fail("url", excerpt(url) + " is the file itself or one that Inlines it");
        const auto known = by_path_.find(canonical);
        if (known != by_path_.end()) return known->second;
        if (open_.size() > kMaxInlineDepth)
            fields.fail(
                "url", "Inlines nested too deeply (limit " + std::to_string(kMaxInlineDepth) + ")");
        Document& document = parse(read_bytes(*path), path->string());
        open_.push_back(canonical);
        load_inlines(document, path->parent_path());
        open_.pop_back();
        return by_path_[canonical] = &document;
    }
    fields.warn("url", reason);
    return nullptr;
}

std::optional<fs::path> Documents::find_inline(const std::string& url, const fs::path& folder,
                                               std::string& reason) const {
    const std::string name = url.substr(0, url.find('#'));
    reason = "leading out of the scene's folder left out";
    if (home_.empty() || !stays_inside(name)) return std::nullopt;
    const fs::path path = folder / name;
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (!error && !is_below(canonical, home_)) return std::nullopt;  // by a link
    reason = "naming no X3D file that can be read left out";
    const bool named_x3d = path.extension() == ".x3d" || path.extension() == ".x3dz";
    if (error || !named_x3d || !fs::is_regular_file(canonical, error)) return std::nullopt;
    if (!std::ifstream(canonical, std::ios::binary)) return std::nullopt;
    return path;
}

}  // namespace nuvo::x3d
