#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "messages.h"
#include "nuvo/scene/x3d.h"
#include "uses.h"
#include "version.h"

namespace nuvo::x3d {

/// One file with its USEs resolved.
struct Document {
    std::string name;  ///< in messages
    Names names;
    Element root;
    const Element* scene = nullptr;  ///< root itself, or the Scene in it
    Version version;
    Extent extent;
};

/// A scene's files: the one that was asked for and what it Inlines, each read once.
class Documents {
  public:
    Documents(const Limits& limits, Messages& messages) : limits_(limits), messages_(messages) {}

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

  private:
    std::string read_bytes(const std::filesystem::path& path);
    Document& parse(std::string_view text, const std::string& name);
    void load_inlines(Document& document, const std::filesystem::path& folder);
    const Document* load_inline(const Element& node, const std::filesystem::path& folder);
    std::optional<std::filesystem::path> find_inline(const std::string& url,
                                                     const std::filesystem::path& folder,
                                                     std::string& reason) const;

    const Limits& limits_;
    Messages& messages_;
    std::filesystem::path home_;      // the scene's folder, canonical; empty: nothing is Inlined
    std::size_t bytes_ = 0;           // read so far
    std::deque<Document> documents_;  // at fixed addresses
    std::unordered_map<std::string, const Document*> by_path_;  // canonical
    std::unordered_map<const Element*, const Document*> inlined_;
    std::vector<std::string> open_;  // canonical paths of the files being read
    bool has_levels_ = false;
};

}  // namespace nuvo::x3d
