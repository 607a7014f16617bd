#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "nuvo/scene/scene.h"

namespace nuvo::x3d {

/// A file that cannot be drawn: what() is one line, "FILE: PLACE: reason (limit)".
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What a file may ask for, counted before memory is taken.
struct Limits {
    std::size_t depth = 4096;           ///< nested elements, in the file and after USE is expanded
    std::size_t elements = 10'000'000;  ///< elements, in the file and after USE is expanded
    std::size_t shapes = 2'000'000;     ///< Shapes after USE is expanded
    std::size_t vertices = 20'000'000;  ///< points, normals and indices of all meshes, USE expanded
};

/// NavigationInfo's headlight: `kAuto` follows the file and, where it is silent, lights only a
/// scene that has no light of its own.
enum class Headlight { kAuto, kOn, kOff };

/// Reads an X3D file (XML encoding, root X3D or a bare Scene) into world space.
/// Throws Error, and std::bad_alloc.
Scene read_file(const std::filesystem::path& path, Headlight headlight = Headlight::kAuto,
                const Limits& limits = {});

/// The same from the text of a file; `name` stands for it in messages.
Scene read_text(const std::string& text, const std::string& name,
                Headlight headlight = Headlight::kAuto, const Limits& limits = {});

}  // namespace nuvo::x3d
