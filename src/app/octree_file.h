#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "nuvo/octree/octree.h"

namespace nuvo::app {

/// Takes the next bytes of a file.
using Sink = std::function<void(std::string_view)>;

/// An octree's voxels (its leaves) as a file for other programs; docs/looking.md describes each.
struct OctreeFormat {
    std::string_view ending;  ///< ".x3d"
    /// `title` names the scene.
    void (*write)(const Octree& octree, const std::string& title, const Sink& sink);
};

/// The format for a file of that name: by its ending, .x3d, .json or .bin in any letter case. Null:
/// none has it.
const OctreeFormat* octree_format(const std::filesystem::path& path);

/// Writes the file whole or not at all. Throws image::WriteError.
void write_octree(const std::filesystem::path& path, const OctreeFormat& format,
                  const Octree& octree, const std::string& title);

}  // namespace nuvo::app
