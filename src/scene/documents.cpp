#include "documents.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <new>
#include <string_view>
#include <system_error>

#include "fields.h"
#include "gunzip.h"
#include "linker.h"
#include "node_names.h"
#include "other_formats.h"
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
    const std::string_view* text = root.find("version");
    if (text == nullptr) return {};
    const char* end = text->data() + text->size();
    Version version;
    const auto major = std::from_chars(text->data(), end, version.major);
    if (major.ec == std::errc{} && major.ptr != end && *major.ptr == '.') {
        const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
        if (minor.ec == std::errc{} && minor.ptr == end) return version;
    }
    messages.warn_field_left_out(root, "version", "\"" + excerpt(*text) + "\" is no version");
    return {};
}

/// Finds the declarations of prototypes, but for those inside others; of a name the first.
void find_declarations(Document& document, MadeElements& made) {
    std::vector<const Element*> pending{document.scene};
    while (!pending.empty()) {
        const Element& element = *pending.back();
        pending.pop_back();
        if (element.next != nullptr) pending.push_back(element.next);
        if (is_declaration(element)) {
            check_connections(element, made);
            document.declarations.try_emplace(element.text("name"), &element);
            if (document.first_declaration == nullptr) document.first_declaration = &element;
        } else if (!element.children.empty()) {
            pending.push_back(element.children.first);
        }
    }
}

/// The Scene of the thesis' bare form (the root itself) or of an X3D root.
const Element& find_scene(const Element& root, Messages& messages) {
    if (root.name == "Scene") return root;
    if (root.name != "X3D") {
        refuse_misspelt(root, messages);
        messages.refuse(root, "", "the root element is neither X3D nor Scene");
    }
    const Element* scene = nullptr;
    for (const Element& child : root.children) {
        if (child.name != "Scene") {
            if (!is_silent(child.name)) warn_not_drawn(child, messages);
            continue;
        }
        if (scene != nullptr) messages.refuse(child, "", "a second Scene");
        scene = &child;
    }
    if (scene == nullptr) messages.refuse(root, "", "has no Scene");
    return *scene;
}

[[noreturn]] void fail_to_read(const fs::path& path, const std::string& reason) {
    throw Error(path.string() + ": " + reason);
}

/// For a fault of the system. Memory that is out is no fault of the file's.
[[noreturn]] void fail_to_read(const fs::path& path, const std::string& what,
                               const std::error_code& error) {
    if (error == std::errc::not_enough_memory) throw std::bad_alloc();
    fail_to_read(path, what + ": " + (error ? error.message() : "unknown reason"));
}

/// The bytes that %20 and the like stand for (RFC 3986); other percent signs stay.
std::string percent_decoded(std::string_view url) {
    std::string text;
    for (std::size_t i = 0; i < url.size(); ++i) {
        unsigned char byte = 0;
        const char* const digits = url.data() + i + 1;
        const bool is_escape = url[i] == '%' && i + 2 < url.size() &&
                               std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        text += is_escape ? static_cast<char>(byte) : url[i];
        if (is_escape) i += 2;
    }
    return text;
}

/// True for a name that stays within a folder: relative, without "..", and no address of the net.
bool stays_inside(const std::string& url) {
    const fs::path path = url;
    return !url.empty() && url.find_first_of(std::string_view(":\0", 2)) == std::string::npos &&
           !path.has_root_path() && std::find(path.begin(), path.end(), "..") == path.end();
}

/// True where the system tells that there is no such file for the reader: what the scene says. All
/// else (too many open files, a broken disk) is a fault, and another picture for it would be a lie.
bool is_absence(const std::error_code& error) {
    return error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory ||
           error == std::errc::permission_denied ||
           error == std::errc::too_many_symbolic_link_levels ||
           error == std::errc::filename_too_long;
}

std::string in_quotes(const std::string& url) { return "\"" + excerpt(url) + "\""; }

/// Of no url of a node anything could be loaded; each url is told of in a line of its own.
void warn_of_url(const Fields& fields, const std::string& reason) {
    if (reason.empty()) return fields.reject("url", "names nothing");
    if (fields.is_strict()) fields.refuse("url", reason);
    fields.warn("url", "left out: " + reason);
}

bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
           folder.end();
}

}  // namespace

const Document& Documents::read_file(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (error && !is_absence(error)) fail_to_read(path, "cannot be found", error);
    Document& document = parse_file(path);
    if (!error) {
        home_ = canonical.parent_path();
        open_.push_back(canonical.string());
    }
    link(document);
    return document;
}

const Document& Documents::read_text(std::string_view text, const std::string& name) {
    Document& document =
        is_gzip(text) ? parse(gunzip(text, name, kUnpackedBytes), name, {}) : parse(text, name, {});
    link(document);
    return document;
}

Text Documents::read_bytes(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) fail_to_read(path, "is a folder, not a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) fail_to_read(path, "cannot be opened", {errno, std::generic_category()});
    const std::size_t left = limits_.file_bytes - bytes_;
    const auto check_size = [&](std::uintmax_t size) {
        if (size > left)
            fail_to_read(path, (bytes_ > 0 ? "with the files before it is" : "is") +
                                   std::string(" too large: ") + std::to_string(bytes_ + size) +
                                   " bytes (limit " + std::to_string(limits_.file_bytes) + ")");
    };
    constexpr std::size_t kBlock = 1 << 18;
    Text text;
    const std::uintmax_t size = fs::file_size(path, ignored);
    if (!ignored) {
        check_size(size);
        text.reserve(size + kBlock);
        text.resize(size);
    }
    // There is always room for more than was announced, so that the end is met and not guessed.
    std::size_t length = 0;
    do {
        text.resize(std::max(text.size(), length + kBlock));
        file.read(text.data() + length, static_cast<std::streamsize>(text.size() - length));
        length += static_cast<std::size_t>(file.gcount());
        check_size(length);
    } while (file.gcount() > 0);
    text.resize(length);
    if (file.bad()) fail_to_read(path, "cannot be read");
    if (!ignored && text.size() < size)
        fail_to_read(path, "ends after " + std::to_string(text.size()) + " of its " +
                               std::to_string(size) + " bytes");
    if (is_gzip(view(text))) {
        const std::size_t most = std::max(kUnpackedBytes, kUnpackedRatio * text.size());
        text = gunzip(view(text), path.string(), std::min(left, most));
    }
    bytes_ += text.size();
    return text;
}

Document& Documents::parse_file(const fs::path& path) {
    return parse(read_bytes(path), path.string(), path.parent_path());
}

Document& Documents::parse(Text text, const std::string& name, const fs::path& folder) {
    Document& document = parse(view(text), name, folder);
    if (document.views_text) document.text = std::move(text);
    return document;
}

Document& Documents::parse(std::string_view text, const std::string& name, const fs::path& folder) {
    refuse_other_formats(text, name);
    Document& document = documents_.emplace_back(name, folder, messages_.is_strict());
    const ParsedXml parsed =
        parse_xml(text, name, limits_, document.names, document.arena, progress_);
    document.root = parsed.root;
    document.views_text = parsed.views_text;
    messages_.add_document(name, *document.root);
    document.names.warn(messages_);
    document.scene = &find_scene(*document.root, messages_);
    if (document.root->name == "X3D") {
        document.version = read_version(*document.root, messages_);
        document.units = read_units(*document.root, messages_);
    }
    find_declarations(document, made_);
    return document;
}

void Documents::link(Document& document) {
    Linker(*this, document, made_, messages_).run();
    const InlineExtent extent = [this](const Element& node) {
        const Document* loaded = inlined(node);
        return loaded != nullptr ? &loaded->extent : nullptr;
    };
    document.extent = measure(*document.scene, extent, limits_, messages_);
}

void Documents::note(const Element& node, const Document& document) {
    if (node.name == "LOD") has_levels_ = true;
    if (node.name != "Inline") return;
    const Document* loaded = load_inline(node, document.folder);
    if (loaded != nullptr) inlined_[&node] = loaded;
}

const Document* Documents::load_inline(const Element& node, const fs::path& folder) {
    const Fields fields(node, messages_);
    if (!fields.boolean("load", true)) return nullptr;
    std::string reason;
    for (const std::string& url : fields.strings("url")) {
        const std::optional<fs::path> path = find_inline(url, folder, reason);
        if (!path) continue;
        const std::string canonical = fs::canonical(*path).string();
        if (std::find(open_.begin(), open_.end(), canonical) != open_.end())
            fields.refuse("url", excerpt(url) + " is the file itself or one that Inlines it");
        const auto known = by_path_.find(canonical);
        if (known != by_path_.end()) return known->second;
        if (open_.size() > kMaxInlineDepth)
            fields.refuse(
                "url", "Inlines nested too deeply (limit " + std::to_string(kMaxInlineDepth) + ")");
        Document& document = parse_file(*path);
        open_.push_back(canonical);
        link(document);
        open_.pop_back();
        return by_path_[canonical] = &document;
    }
    warn_of_url(fields, reason);
    return nullptr;
}

Prototype Documents::declared(Prototype prototype) {
    for (std::size_t files = 0; prototype.declaration != nullptr; ++files) {
        const Element& node = *prototype.declaration;
        if (node.name == "ProtoDeclare") break;
        if (files == kMaxInlineDepth)
            messages_.refuse(node, "url",
                             "prototypes referred to through too many files (limit " +
                                 std::to_string(kMaxInlineDepth) + ")");
        const auto [known, is_new] = declared_.try_emplace(&node);
        if (is_new) {
            const Prototype loaded = load_prototype(node, prototype.document->folder);
            declared_[&node] = prototype = loaded;
        } else {
            prototype = known->second;
        }
    }
    return prototype;
}

Prototype Documents::load_prototype(const Element& node, const fs::path& folder) {
    const Fields fields(node, messages_);
    std::string reason;
    for (const std::string& url : fields.strings("url")) {
        const std::optional<fs::path> path = find_inline(url, folder, reason);
        if (!path) continue;
        const std::string canonical = fs::canonical(*path).string();
        const Document*& document = declaring_[canonical];
        if (document == nullptr) document = &parse_file(*path);
        // Without a name behind a # the file's first prototype is meant.
        const std::size_t mark = url.find('#');
        const Element* found = document->first_declaration;
        if (mark != std::string::npos) {
            const auto named = document->declarations.find(
                percent_decoded(std::string_view(url).substr(mark + 1)));
            found = named != document->declarations.end() ? named->second : nullptr;
        }
        if (found != nullptr) return {found, nullptr, document};
        if (reason.empty()) reason = in_quotes(url) + " names no prototype of its file";
    }
    warn_of_url(fields, reason);
    return {};
}

std::optional<fs::path> Documents::find_inline(const std::string& url, const fs::path& folder,
                                               std::string& reason) const {
    const std::string name = percent_decoded(std::string_view(url).substr(0, url.find('#')));
    const auto tell = [&](const char* what) {  // of the first url, which others stand in for
        if (reason.empty()) reason = in_quotes(url) + what;
        return std::nullopt;
    };
    if (home_.empty()) return tell(" is not looked for: only a scene in a file has a folder");
    constexpr const char* kOut = " leads out of the scene's folder";
    if (!stays_inside(name)) return tell(kOut);
    const fs::path path = folder / name;
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (error && !is_absence(error)) fail_to_read(path, "cannot be found", error);
    if (!error && !is_below(canonical, home_)) return tell(kOut);  // by a link
    constexpr const char* kNoFile = " names no X3D file that can be read";
    const bool named_x3d = path.extension() == ".x3d" || path.extension() == ".x3dz";
    if (error || !named_x3d || !fs::is_regular_file(canonical, error)) return tell(kNoFile);
    errno = 0;
    if (!std::ifstream(canonical, std::ios::binary)) {
        error = {errno, std::generic_category()};
        if (errno != 0 && is_absence(error)) return tell(kNoFile);
        fail_to_read(path, "cannot be opened", error);
    }
    return path;
}

}  // namespace nuvo::x3d
