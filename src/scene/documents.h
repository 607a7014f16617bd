#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "extents.h"
#include "gunzip.h"
#include "messages.h"
#include "names.h"
#include "nuvo/scene/x3d.h"
#include "prototypes.h"
#include "units.h"
#include "version.h"

namespace nuvo::x3d {

/// One file; once it is linked, its USEs and ProtoInstances have their targets.
struct Document {
    Document(std::string file, std::filesystem::path home, bool strict)
        : name(std::move(file)), folder(std::move(home)), names(strict) {}

    std::string name;              ///< in messages
    std::filesystem::path folder;  ///< what its urls are relative to
    Names names;
    ElementArena arena;
    bool views_text = false;  ///< long values of attributes stand in the file's text
    Text text;                ///< which is kept here then, unless it is the caller's
    Element* root = nullptr;
    const Element* scene = nullptr;  ///< root itself, or the Scene in it
    Version version;
    Units units;
    std::unordered_map<std::string_view, const Element*> declarations;  ///< of prototypes, by name
    const Element* first_declaration = nullptr;
    Extent extent;
};

/// A scene's files: the one that was asked for and what it Inlines, each read once.
class Documents {
  public:
    Documents(const Limits& limits, Messages& messages, Progress* progress)
        : limits_(limits), messages_(messages), progress_(progress), made_{limits, messages} {}

    /// Reads the scene and, unless it is given as text, the files that it Inlines from its own
    /// folder. Throws Error.
    const Document& read_file(const std::filesystem::path& path);
    const Document& read_text(std::string_view text, const std::string& name);

    /// What an Inline node stands for; null where nothing could be loaded.
    const Document* inlined(const Element& node) const {
        const auto found = inlined_.find(&node);
        return found == inlined_.end() ? nullptr : found->second;
    }
    /// True when some file has an LOD: who draws must know the camera first.
    bool has_levels() const { return has_levels_; }

    // For the Linker.
    /// Takes note of a node of `document` that can be drawn: loads what an Inline names.
    void note(const Element& node, const Document& document);
    /// The prototype itself where it is declared in another file; without a declaration where that
    /// cannot be read.
    Prototype declared(Prototype prototype);

  private:
    Text read_bytes(const std::filesystem::path& path);
    Document& parse_file(const std::filesystem::path& path);
    /// Without a copy of `text`, which must outlive the document.
    Document& parse(std::string_view text, const std::string& name,
                    const std::filesystem::path& folder);
    /// Takes the text into the document, if that has need of it.
    Document& parse(Text text, const std::string& name, const std::filesystem::path& folder);
    void link(Document& document);
    const Document* load_inline(const Element& node, const std::filesystem::path& folder);
    Prototype load_prototype(const Element& node, const std::filesystem::path& folder);
    /// The file that a url names. Nothing where it must not or cannot be read; why that is so of
    /// the first url goes into `reason`.
    std::optional<std::filesystem::path> find_inline(const std::string& url,
                                                     const std::filesystem::path& folder,
                                                     std::string& reason) const;

    const Limits& limits_;
    Messages& messages_;
    Progress* progress_;
    MadeElements made_;
    std::filesystem::path home_;      // the scene's folder, canonical; empty: nothing is Inlined
    std::size_t bytes_ = 0;           // read so far
    std::deque<Document> documents_;  // at fixed addresses
    std::unordered_map<std::string, const Document*> by_path_;    // canonical
    std::unordered_map<std::string, const Document*> declaring_;  // read for their prototypes
    std::unordered_map<const Element*, const Document*> inlined_;
    std::unordered_map<const Element*, Prototype> declared_;  // by ExternProtoDeclare
    std::vector<std::string> open_;  // canonical paths of the files being read
    bool has_levels_ = false;
};

}  // namespace nuvo::x3d
