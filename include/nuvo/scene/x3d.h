#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "nuvo/math/progress.h"
#include "nuvo/scene/defaults.h"
#include "nuvo/scene/scene.h"

namespace nuvo::x3d {

/// A file that cannot be drawn: what() is one line, "FILE: PLACE: reason (limit)".
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What a file may ask for, counted before memory is taken.
struct Limits {
    std::size_t depth = 4096;            ///< nested elements, in the file and after USE is expanded
    std::size_t elements = 10'000'000;   ///< elements, in the file and after USE is expanded
    std::size_t attributes = 5'000'000;  ///< attributes of a file
    std::size_t shapes = 2'000'000;      ///< Shapes after USE and Inline are expanded
    std::size_t vertices = 20'000'000;   ///< points, indices, normals and colors of all meshes
    std::size_t file_bytes = 1'000'000'000;  ///< the file, unpacked, and all that it Inlines
};

/// How deep Inlines nest.
inline constexpr std::size_t kMaxInlineDepth = 16;

/// NavigationInfo's headlight: `kAuto` follows the file and, where it is silent, lights only a
/// scene that has no light of its own.
enum class Headlight { kAuto, kOn, kOff };

/// What `viewpoint` may say besides, where no Viewpoint has such a name: none of the file's.
inline constexpr const char* kStandardView = "standard";  ///< the camera of a file without one
inline constexpr const char* kFittedView = "fit";  ///< the same, for the caller to put elsewhere

/// How a file is read.
struct ReadOptions {
    Limits limits{};
    Headlight headlight = Headlight::kAuto;
    /// Chooses the camera: a Viewpoint's DEF or description, or its number from 1 in document
    /// order; empty: the first.
    std::string viewpoint{};
    /// False: a field, node or Shape that cannot be read is left out with a warning. True: it
    /// throws Error.
    bool strict = false;
    Defaults defaults = {};
    Progress* progress = nullptr;  ///< in bytes of each file, then in shapes
    /// Takes for each Shape of the document, in its order, its DEF, or where it has none that of
    /// the nearest node around it that has one; empty: none has.
    std::vector<std::string>* shape_names = nullptr;
    int threads = 1;  ///< that read the numbers of large meshes; at least 1
};

/// Reads an X3D file (XML encoding, perhaps packed by gzip; root X3D or a bare Scene) into world
/// space. Throws Error, and std::bad_alloc.
Scene read_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from the text of a file, which can Inline no other; `name` stands for it in messages.
Scene read_text(const std::string& text, const std::string& name, const ReadOptions& options = {});

}  // namespace nuvo::x3d
